// What a browser may send: the request's head through the gate, bodies through their handlers, and the live
// socket's commands. The first byte chooses; a vehicle that is told to move by nonsense would be found here.
#include <cmath>
#include <cstdlib>
#include <string>

#include "core/result.hpp"
#include "hmi/server/gate.hpp"
#include "hmi/server/json_text.hpp"
#include "hmi/server/live_command.hpp"
#include "hmi/server/route_wire.hpp"

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 3) {
    case 0:
      fuzz_command(text);
      break;
    case 1:
      fuzz_gate(text);
      break;
    default:
      fuzz_routes(text);
  }
  return 0;
}
