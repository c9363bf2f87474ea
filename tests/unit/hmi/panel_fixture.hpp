#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "hmi/server/api.hpp"
#include "hmi/server/server.hpp"
#include "tests/support/panel_client.hpp"
#include "tests/support/scripted_vehicle.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::hmi {

/// The server on a real socket, with a scripted vehicle and a site folder that does not exist yet.
class PanelTest : public testing::Test {
 protected:
  explicit PanelTest(bool network = false)
      : access_(folder_.path() / "pins", network, [] { return std::chrono::steady_clock::time_point(); }) {}

  void SetUp() override {
    folder_.write("index.html", "<!doctype html><title>Madori</title>");
    files_.emplace(folder_.path());
    editor_.emplace(site());
    context_.emplace(ApiContext{access_,
                                *editor_,
                                vehicle_,
                                job_,
                                replay_,
                                [] { return std::string("2026-01-01T00:00:00Z"); },
                                {},
                                {}});
    ServerOptions server;
    server.port = 0;
    server.live_rate_hz = 50.0;
    server.header_timeout_s = 1.0;
    server_.emplace(server, *context_, *files_);
  }
  [[nodiscard]] std::filesystem::path site() const { return folder_.path() / "site"; }
  [[nodiscard]] test::HttpAnswer call(const std::string& method, const std::string& target,
                                      const std::string& body = "", const std::string& cookie = "") const {
    return test::http_call(server_->port(), {method, target, body, "", "same", cookie});
  }
  [[nodiscard]] nlohmann::json get(const std::string& target) const {
    return nlohmann::json::parse(call("GET", target).body);
  }
  /// Waits for the job that runs; its last state.
  [[nodiscard]] nlohmann::json finished_job() const {
    nlohmann::json job;
    do job = get("/api/job");
    while (job["running"] == true);
    return job;
  }

  test::TemporaryFolder folder_;
  test::ScriptedVehicle vehicle_;
  Access access_;
  Job job_;
  Replay replay_;
  std::optional<StaticFiles> files_;
  std::optional<SiteEditor> editor_;
  std::optional<ApiContext> context_;
  std::optional<Server> server_;
};

}  // namespace madori::hmi
