#include "hmi/server/http_message.hpp"

#include <boost/beast/http.hpp>
#include <cctype>
#include <utility>

namespace madori::hmi {
namespace {

namespace http = boost::beast::http;

constexpr const char* kPolicy =
    "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

Request to_request(const HttpRequest& message) {
  Request request;
  request.method = std::string(message.method_string());
  for (const auto& field : message) {
    std::string name(field.name_string());
    for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    request.headers[name] = std::string(field.value());
  }
  return request;
}

HttpResponse to_message(Response response, unsigned version, bool keep_alive, bool head) {
  HttpResponse message{static_cast<http::status>(response.status), version};
  message.set(http::field::content_type, response.content_type);
  message.set("Content-Security-Policy", kPolicy);
  message.set("X-Content-Type-Options", "nosniff");
  message.set("Referrer-Policy", "no-referrer");
  message.set("Cross-Origin-Opener-Policy", "same-origin");
  message.set("Cross-Origin-Resource-Policy", "same-origin");
  message.set(http::field::cache_control, "no-store");
  for (const auto& [name, value] : response.headers) message.set(name, value);
  message.keep_alive(keep_alive);
  if (response.next_part) {
    message.chunked(true);
    return message;
  }
  message.body() = std::move(response.body);
  message.prepare_payload();
  if (head) message.body().clear();
  return message;
}

}  // namespace madori::hmi
