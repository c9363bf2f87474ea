#include <algorithm>
#include <fstream>
#include <iterator>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::uintmax_t kMostDownloadBytes = 1U << 30U;

json recordings(const fs::path& folder) {
  std::vector<fs::directory_entry> files;
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing))
    if (entry.is_regular_file()) files.push_back(entry);
  std::ranges::sort(files, std::greater<>(), [](const auto& f) { return f.path().filename().string(); });
  json list = json::array();
  for (const auto& file : files)
    list.push_back({{"name", file.path().filename().string()}, {"bytes", file.file_size()}});
  return list;
}

/// Only a name that the list shows can be fetched: no path of the request reaches the disk.
Response download(const fs::path& folder, const std::string& name) {
  std::error_code missing;
  for (const auto& entry : fs::directory_iterator(folder, missing)) {
    if (!entry.is_regular_file() || entry.path().filename() != name) continue;
    if (entry.file_size() > kMostDownloadBytes)
      return Response::error(413, "too-large",
                             "the recording is too large for the panel: copy it from the vehicle");
    std::ifstream stream(entry.path(), std::ios::binary);
    Response response{200, "application/octet-stream", {std::istreambuf_iterator<char>(stream), {}}, {}};
    response.headers["Content-Disposition"] =
        "attachment; filename=\"recording" + entry.path().extension().string() + "\"";
    return response;
  }
  return Response::error(404, "not-found", "there is no such recording");
}

}  // namespace

void add_history_routes(Router& router, ApiContext& context) {
  const fs::path runs = context.editor.folder() / "runs";
  router.add("GET", "/api/recordings", Role::Viewer,
             [runs](const Request&) { return answer(recordings(runs)); });
  router.add(
      "GET", "/api/recordings/*", Role::Operator,
      [runs](const Request& request) { return download(runs, request.captures.at(0)); }, true);
}

}  // namespace madori::hmi
