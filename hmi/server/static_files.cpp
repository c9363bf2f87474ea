#include "hmi/server/static_files.hpp"

#include <iterator>

#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string> kContentTypes{{".html", "text/html; charset=utf-8"},
                                                       {".js", "text/javascript; charset=utf-8"},
                                                       {".css", "text/css; charset=utf-8"},
                                                       {".svg", "image/svg+xml"},
                                                       {".png", "image/png"},
                                                       {".webmanifest", "application/manifest+json"},
                                                       {".woff2", "font/woff2"},
                                                       {".json", "application/json"}};

}  // namespace

StaticFiles::StaticFiles(const fs::path& root) {
  std::error_code missing;
  for (const auto& entry : fs::recursive_directory_iterator(root, missing)) {
    const auto type = kContentTypes.find(entry.path().extension().string());
    if (!entry.is_regular_file() || type == kContentTypes.end()) continue;
    File file{type->second, mapping::file_content(entry.path()), {}, false};
    const fs::path zipped = entry.path().string() + ".gz";
    if (fs::exists(zipped)) file.gzip = mapping::file_content(zipped);
    const std::string name = "/" + fs::relative(entry.path(), root).generic_string();
    file.immutable = name.starts_with("/assets/");  // their names hold a hash of their content
    files_[name] = std::move(file);
  }
  const auto index = files_.find("/index.html");
  if (index == files_.end())
    throw Error(root.string(), "holds no built panel (no index.html)",
                "build it: cmake --build build/release --target panel");
  files_["/"] = index->second;
}

Response StaticFiles::get(const Request& request) const {
  const auto found = files_.find(request.path);
  if (found == files_.end()) return Response::error(404, "not-found", "there is no such page");
  const File& file = found->second;
  Response response{200, file.content_type, {}, {}};
  const bool zip = !file.gzip.empty() && request.header("accept-encoding").find("gzip") != std::string::npos;
  response.body = zip ? file.gzip : file.plain;
  if (zip) response.headers["Content-Encoding"] = "gzip";
  response.headers["Vary"] = "Accept-Encoding";
  response.headers["Cache-Control"] = file.immutable ? "public, max-age=31536000, immutable" : "no-cache";
  return response;
}

}  // namespace madori::hmi
