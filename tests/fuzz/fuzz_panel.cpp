// What a browser may send. The first byte chooses: the live socket's commands, a request's head through the
// gate, routes, bodies through every handler of the API, and raw bytes to the server itself: HTTP requests,
// and frames on a live socket. A vehicle that is told to move by nonsense, and an answer of 500, would be
// found here.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/result.hpp"
#include "hmi/server/gate.hpp"
#include "hmi/server/json_text.hpp"
#include "hmi/server/live_command.hpp"
#include "hmi/server/route_wire.hpp"
#include "tests/fuzz/fuzzed_panel.hpp"

namespace {

using namespace madori::hmi;

void fuzz_command(const std::string& text) {
  const auto command = parse_live_command(text);
  if (command && command->jog && !(std::abs(command->jog->linear_mps) <= 5.0)) std::abort();
}

/// Lines: method, target, then headers. What passes must be what the role may do.
void fuzz_gate(const std::string& text) {
  static const Router router = [] {
    Router r;
    const auto nothing = [](const Request&) { return Response(); };
    r.add("GET", "/api/site/tiles/*/*/*", Role::Viewer, nothing);
    r.add("POST", "/api/orders/*/repeat", Role::Operator, nothing);
    r.add("PUT", "/api/site/walls", Role::Integrator, nothing);
    return r;
  }();
  static const Gate gate(router, true);
  Request request;
  request.role = Role::Operator;
  std::string target;
  std::size_t begin = 0;
  for (int line = 0; begin < text.size(); ++line) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    const std::size_t colon = part.find(':');
    if (line == 0) request.method = part;
    if (line == 1) target = part;
    if (line > 1 && colon != std::string::npos)
      request.headers[part.substr(0, colon)] = part.substr(colon + 1);
  }
  (void)request.cookie("madori_session");
  const auto passage = gate.pass(target, request);
  if (passage.way == Gate::Passage::Way::Refused) return;
  const bool loopback = request.header("host").starts_with("127.") ||
                        request.header("host").starts_with("[::1]") || request.header("host").size() >= 9;
  if (!loopback || request.path.find("..") == 0) std::abort();
  for (const auto& capture : request.captures)
    if (capture == ".." || capture.find('\0') != std::string::npos) std::abort();
  if (request.method == "PUT") std::abort();  // only integrators
}

void fuzz_routes(const std::string& text) {
  try {
    const auto edit = parse_json(text);
    if (edit.is_object()) (void)routes_to_wire(graph_from_wire(edit), {}, "");
  } catch (const madori::Error&) {
  } catch (const nlohmann::json::exception&) {
  }
}

/// "METHOD target", then the body: with an integrator's rights, past the sockets.
void fuzz_handlers(const std::string& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::size_t space = std::min(text.find(' '), end);
  Request request;
  request.method = text.substr(0, space);
  request.headers = {{"host", "127.0.0.1:1"}, {"origin", "http://127.0.0.1:1"}};
  request.role = Role::Integrator;
  request.body = text.substr(std::min(end + 1, text.size()));
  madori::fuzz::FuzzedPanel::the().call(text.substr(std::min(space + 1, end), end - std::min(space + 1, end)),
                                        request);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 6) {
    case 0:
      fuzz_command(text);
      break;
    case 1:
      fuzz_gate(text);
      break;
    case 2:
      fuzz_routes(text);
      break;
    case 3:
      fuzz_handlers(text);
      break;
    case 4:
      madori::fuzz::FuzzedPanel::the().send(text);
      break;
    default:
      madori::fuzz::FuzzedPanel::the().send_frames(text);
  }
  return 0;
}
