#include <algorithm>
#include <chrono>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/tar_stream.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t kNewestEvents = 200;

std::uintmax_t bytes_of(const fs::directory_entry& entry) {
  if (entry.is_regular_file()) return entry.file_size();
  std::uintmax_t sum = 0;
  std::error_code missing;
  for (const auto& file : fs::recursive_directory_iterator(entry.path(), missing))
    if (file.is_regular_file()) sum += file.file_size();
  return sum;
}

double modified_s(const fs::directory_entry& entry) {
  const auto when = std::chrono::file_clock::to_sys(entry.last_write_time());
  return std::chrono::duration<double>(when.time_since_epoch()).count();
}

/// A recording is a folder or a file below runs/.
std::vector<fs::directory_entry> recordings(const fs::path& folder) {
  std::vector<fs::directory_entry> list;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (!entry.is_symlink() && (entry.is_directory() || entry.is_regular_file())) list.push_back(entry);
  std::ranges::sort(list, std::greater<>(), [](const auto& e) { return e.path().filename().string(); });
  return list;
}

json to_wire(const std::vector<fs::directory_entry>& entries) {
  json list = json::array();
  for (const auto& entry : entries)
    list.push_back({{"name", entry.path().filename().string()},
                    {"bytes", bytes_of(entry)},
                    {"modified", modified_s(entry)}});
  return list;
}

/// Only a name that the list shows can be fetched: no path of the request reaches the disk.
Response download(const fs::path& folder, const std::string& name) {
  for (const auto& entry : recordings(folder)) {
    if (entry.path().filename() != name) continue;
    if (entry.is_directory()) return tar_response(tar_entries(entry.path(), name + "/"), "recording.tar");
    return tar_response({{entry.path(), name}}, "recording.tar");
  }
  return Response::error(404, "not-found", "there is no such recording");
}

}  // namespace

void add_history_routes(Router& router, ApiContext& context) {
  const fs::path runs = context.editor.folder() / "runs";
  Vehicle& vehicle = context.vehicle;
  Replay& replay = context.replay;
  router.add(
      "GET", "/api/events", Role::Viewer,
      [&](const Request&) { return answer(list_of(vehicle.events(kNewestEvents))); }, Work::Worker);
  router.add(
      "GET", "/api/statistics", Role::Viewer,
      [&](const Request&) { return answer(to_wire(vehicle.statistics())); }, Work::Worker);
  // No more than how busy the computer is: a scraper has no PIN.
  router.add("GET", "/api/metrics", Role::None, [metrics = context.metrics](const Request&) {
    return Response{200, "text/plain; version=0.0.4", metrics ? metrics() : "", {}, {}};
  });
  router.add(
      "GET", "/api/replay", Role::Viewer,
      [&](const Request&) {
        return Response{200, "application/octet-stream", replay.bytes(), {}, {}};
      },
      Work::Worker);
  router.add(
      "GET", "/api/recordings", Role::Viewer,
      [runs](const Request&) { return answer(to_wire(recordings(runs))); }, Work::Worker);
  router.add(
      "GET", "/api/recordings/*", Role::Operator,
      [runs](const Request& request) { return download(runs, request.captures.at(0)); }, Work::Worker);
}

}  // namespace madori::hmi
