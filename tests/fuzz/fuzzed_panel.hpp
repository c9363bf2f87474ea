#pragma once

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "core/result.hpp"
#include "hmi/server/api.hpp"
#include "hmi/server/gate.hpp"
#include "hmi/server/server.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "tests/support/panel_client.hpp"
#include "tests/support/scripted_vehicle.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::fuzz {

/// The panel's server on a real socket with a small site, which one process of a fuzzer keeps.
class FuzzedPanel {
 public:
  static FuzzedPanel& the() {
    static FuzzedPanel panel;
    return panel;
  }

  /// A request past the sockets, through gate and handler. Aborts on an answer that the server has no words
  /// for.
  void call(const std::string& target, hmi::Request request) {
    const auto passage = gate_->pass(target, request);
    if (passage.way != hmi::Gate::Passage::Way::Api || leaves_the_machine(request)) return;
    if (const std::size_t at = request.body.find("REVISION"); at != std::string::npos)
      request.body.replace(at, 8, newest_of(request.path));  // which no fuzzer guesses
    try {
      require((*passage.match.handler)(request).status < 500);
    } catch (const Error&) {
    }
    require_sane();
  }
  /// Bytes as they come on the port.
  void send(const std::string& bytes) {
    require(test::raw_call(server_->port(), bytes).find("HTTP/1.1 500") == std::string::npos);
    require_sane();
  }
  /// Bytes on a live socket that was opened properly.
  void send_frames(const std::string& bytes) {
    const std::string host = "127.0.0.1:" + std::to_string(server_->port());
    send("GET /api/live HTTP/1.1\r\nHost: " + host + "\r\nOrigin: http://" + host +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n" +
         bytes);
  }

 private:
  FuzzedPanel() {
    mapping::Site site;
    site.name = "small";
    site.drawing = {"drawing.png", 400, 300};
    site.scale = mapping::ScaleRecord{0.05, "option", 0.0, 0.0, "2026-01-01T00:00:00Z", {"0.05"}};
    std::filesystem::create_directories(editor_.folder());
    mapping::save_site(editor_.folder(), site);
    mapping::write_file_atomically(editor_.folder() / "walls.csv",
                                   "id,x1,y1,x2,y2\n1,1,1,19,1\n2,19,1,19,14\n");
    folder_.write("index.html", "<!doctype html>");
    files_.emplace(folder_.path());
    hmi::ServerOptions options;
    options.port = 0;
    options.header_timeout_s = 1.0;
    server_.emplace(options, context_, *files_);
    router_ = hmi::make_router(context_);
    gate_.emplace(router_, true);
  }

  static void require(bool good) {
    if (!good) std::abort();
  }
  /// Fetching photographs, and importing drawings, which has a fuzzer of its own (fuzz_image, fuzz_dxf).
  static bool leaves_the_machine(const hmi::Request& request) {
    return request.method == "POST" && (request.path.find("/tiles") != std::string::npos ||
                                        request.path.find("/drawing") != std::string::npos);
  }
  [[nodiscard]] std::string newest_of(const std::string& path) const {
    const auto revisions = editor_.revisions();
    for (const char* part : {"walls", "routes", "vehicle"})
      if (path.find(part) != std::string::npos) return revisions.at(part).get<std::string>();
    return revisions.at("drawing").get<std::string>();
  }
  /// Nothing may reach the vehicle that it could not be meant to do.
  void require_sane() const {
    for (const auto& jog : vehicle_.jogs())
      require(std::abs(jog.linear_mps) <= 5.0 && std::abs(jog.angular_radps) <= 5.0);
    for (const auto& pose : vehicle_.poses())
      require(std::isfinite(pose.x_m() + pose.y_m() + pose.yaw_rad()));
    vehicle_.forget();
  }

  test::TemporaryFolder folder_;
  hmi::Access access_{folder_.path() / "pins", false, [] { return std::chrono::steady_clock::now(); }};
  mutable test::ScriptedVehicle vehicle_;
  hmi::Job job_;
  hmi::Replay replay_;
  hmi::SiteEditor editor_{folder_.path() / "site"};
  hmi::ApiContext context_{
      access_, editor_, vehicle_, job_, replay_, [] { return std::string("2026-01-01T00:00:00Z"); }, {}, {}};
  std::optional<hmi::StaticFiles> files_;
  hmi::Router router_;
  std::optional<hmi::Gate> gate_;
  std::optional<hmi::Server> server_;
};

}  // namespace madori::fuzz
