#include "hmi/server/http.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <utility>

namespace madori::hmi {
namespace {

std::vector<std::string> elements_of(std::string_view path) {
  std::vector<std::string> elements;
  while (!path.empty()) {
    const std::size_t slash = path.find('/');
    if (slash != 0) elements.emplace_back(path.substr(0, slash));
    if (slash == std::string_view::npos) break;
    path.remove_prefix(slash + 1);
  }
  return elements;
}

/// Percent-decoding (RFC 3986, section 2.1); false on a broken escape or a NUL byte.
bool decode(std::string_view text, std::string& out, bool plus_is_space) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '%') {
      if (i + 2 >= text.size()) return false;
      unsigned value = 0;
      const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + i + 3, value, 16);
      if (error != std::errc() || end != text.data() + i + 3) return false;
      c = static_cast<char>(value);
      i += 2;
    } else if (c == '+' && plus_is_space) {
      c = ' ';
    }
    if (c == '\0') return false;
    out.push_back(c);
  }
  return true;
}

bool parse_query(std::string_view text, std::map<std::string, std::string>& query) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('&'), text.size());
    const std::string_view pair = text.substr(0, end);
    const std::size_t equals = std::min(pair.find('='), pair.size());
    std::string key;
    std::string value;
    if (!decode(pair.substr(0, equals), key, true)) return false;
    if (equals < pair.size() && !decode(pair.substr(equals + 1), value, true)) return false;
    if (!key.empty()) query[key] = value;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return true;
}

}  // namespace

std::string Request::header(const std::string& lower_case_name) const {
  const auto found = headers.find(lower_case_name);
  return found == headers.end() ? std::string() : found->second;
}

std::string Request::cookie(std::string_view name) const {
  const std::string all = header("cookie");
  std::string_view rest = all;
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    std::string_view pair = rest.substr(0, end);
    while (!pair.empty() && pair.front() == ' ') pair.remove_prefix(1);
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return std::string(pair.substr(name.size() + 1));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

Response Response::json(std::string body, int status) {
  return {status, "application/json", std::move(body), {}, {}};
}

Response Response::error(int status, const std::string& code, const std::string& text) {
  const nlohmann::json body{{"error", {{"code", code}, {"text", text}}}};
  return json(body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), status);
}

void Router::add(std::string method, const std::string& pattern, Role needs, Handler handler, Work work) {
  routes_.push_back({std::move(method), elements_of(pattern), needs, std::move(handler), work});
}

Router::Match Router::match(Request& request) const {
  const std::vector<std::string> elements = elements_of(request.path);
  bool path_known = false;
  for (const Route& route : routes_) {
    if (route.elements.size() != elements.size()) continue;
    std::vector<std::string> captures;
    bool same = true;
    for (std::size_t i = 0; i < elements.size() && same; ++i) {
      if (route.elements[i] == "*")
        captures.push_back(elements[i]);
      else
        same = route.elements[i] == elements[i];
    }
    if (!same) continue;
    path_known = true;
    if (route.method != request.method) continue;
    if (request.role < route.needs) return {nullptr, Work::Quick, request.role == Role::None ? 401 : 403};
    request.captures = std::move(captures);
    return {&route.handler, route.work, 0};
  }
  return {nullptr, Work::Quick, path_known ? 405 : 404};
}

bool parse_target(std::string_view target, Request& request) {
  if (target.empty() || target.front() != '/') return false;
  const std::size_t question = std::min(target.find('?'), target.size());
  if (!decode(target.substr(0, question), request.path, false)) return false;
  const auto elements = elements_of(request.path);
  const auto climbs = [](const std::string& e) { return e == ".." || e.find('\\') != std::string::npos; };
  if (std::ranges::any_of(elements, climbs)) return false;
  return question == target.size() || parse_query(target.substr(question + 1), request.query);
}

}  // namespace madori::hmi
