#include <sodium.h>
#include <unistd.h>

#include <fstream>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "mapping/drawing/import_drawing.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// A guarded handler of JSON values.
template <class Work>
Handler editing(Work work) {
  return guarded([work](const Request& request) { return answer(work(request)); });
}

Response csv_file(const std::string& content, const std::string& name) {
  Response response{200, "text/csv; charset=utf-8", content, {}};
  response.headers["Content-Disposition"] = "attachment; filename=\"" + name + "\"";
  return response;
}

/// The file name's ending alone counts: it says the format and never becomes a path.
std::string safe_extension(const std::string& name) {
  const std::string extension = fs::path(name).extension().string();
  for (const char c : extension.substr(std::min<std::size_t>(1, extension.size())))
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) return "";
  return extension.size() <= 6 ? extension : "";
}

/// An upload lies in a file of its own until its import has ended.
class UploadedFile {
 public:
  UploadedFile(const std::string& extension, const std::string& content) {
    path_ = fs::temp_directory_path() / ("madori-upload-" + std::to_string(::getpid()) + "-" +
                                         std::to_string(randombytes_random()) + extension);
    std::ofstream stream(path_, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    if (!stream.flush()) throw Error(path_.string(), "cannot be written", "free some disk space");
  }
  ~UploadedFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  UploadedFile(const UploadedFile&) = delete;
  UploadedFile& operator=(const UploadedFile&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

Response start_import(ApiContext& context, const Request& request) {
  const auto name = request.query.find("name");
  const std::string given = name == request.query.end() ? "" : name->second;
  const auto file = std::make_shared<UploadedFile>(safe_extension(given), request.body);
  mapping::ImportOptions options;
  options.drawing = file->path();
  options.site = context.editor.folder();
  options.name = fs::path(given).stem().string();
  options.force = true;  // the panel replaces the drawing of its own site; routes and tiles stay
  options.date = context.iso_time();
  const bool started = context.job.start("import", [options, file, &context](const Job::Progress& progress) {
    const auto report = mapping::import_drawing(options, progress);
    (void)context.vehicle.reload_site();
    return std::to_string(report.walls) + " walls";
  });
  if (!started) return Response::error(409, "busy", "another drawing is being imported");
  return answer(context.job.state());
}

}  // namespace

void add_site_routes(Router& router, ApiContext& context) {
  SiteEditor& editor = context.editor;
  const auto reload = [&context](json saved) {
    (void)context.vehicle.reload_site();
    return saved;
  };
  router.add("GET", "/api/site", Role::Viewer, editing([&](const Request&) { return editor.site(); }));
  router.add("GET", "/api/site/walls", Role::Viewer, editing([&](const Request&) { return editor.walls(); }));
  router.add("PUT", "/api/site/walls", Role::Integrator,
             editing([&editor, reload](const Request& r) { return reload(editor.save_walls(body_of(r))); }),
             true);
  router.add(
      "GET", "/api/site/drawing.png", Role::Viewer,
      [&](const Request&) {
        return Response{200, "image/png", editor.drawing_png(), {}};
      },
      true);
  router.add(
      "POST", "/api/site/drawing", Role::Integrator,
      [&](const Request& request) { return start_import(context, request); }, true);
  router.add("GET", "/api/job", Role::Viewer, [&](const Request&) { return answer(context.job.state()); });

  router.add("GET", "/api/site/routes", Role::Viewer,
             editing([&](const Request&) { return editor.routes(); }));
  router.add("PUT", "/api/site/routes", Role::Integrator,
             editing([&editor, reload](const Request& r) { return reload(editor.save_routes(body_of(r))); }),
             true);
  router.add("POST", "/api/site/routes/check", Role::Integrator,
             editing([&](const Request& r) { return editor.check_routes(body_of(r)); }));
  router.add("POST", "/api/site/routes/csv", Role::Integrator, editing([&editor, reload](const Request& r) {
               return reload(editor.import_routes(body_of(r)));
             }),
             true);
  for (const char* name : {"tree.csv", "path.csv"})
    router.add("GET", std::string("/api/site/routes/") + name, Role::Viewer,
               [&editor, name](const Request&) { return csv_file(editor.routes_file(name), name); });
}

}  // namespace madori::hmi
