#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <fstream>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "mapping/drawing/import_drawing.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

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

std::optional<double> number_of(const Request& request, const std::string& name, double low, double high) {
  const std::string text = query_of(request, name);
  if (text.empty()) return std::nullopt;
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    throw Error(name + " " + text, "is no number that makes sense here", "correct it, or leave it out");
  return value;
}

std::vector<std::string> list_in(const std::string& text) {
  std::vector<std::string> list;
  std::istringstream stream(text);
  for (std::string item; std::getline(stream, item, ',');)
    if (!item.empty()) list.push_back(item);
  return list;
}

/// ImportOptions of hmi/schema.
mapping::ImportOptions options_of(const Request& request) {
  mapping::ImportOptions options;
  options.name = fs::path(query_of(request, "name")).stem().string();
  options.plan.dpi = number_of(request, "dpi", 1.0, 1e5);
  options.plan.page = static_cast<int>(number_of(request, "page", 1.0, 1e4).value_or(1.0));
  options.plan.layers = list_in(query_of(request, "layers"));
  options.plan.unit = query_of(request, "unit");
  options.m_per_px = number_of(request, "m_per_px", 1e-6, 1e3);
  options.detection.threshold = number_of(request, "threshold", 1.0, 254.0);
  options.detection.min_wall_length_px = number_of(request, "min_wall_px", 1.0, 1e5);
  options.detection.strictness = number_of(request, "strictness", 0.0, 1000.0);
  options.detection.keep_furniture = query_of(request, "furniture") == "1";
  options.detection.keep_dashed = query_of(request, "dashed") == "1";
  options.detection.keep_dimensions = query_of(request, "dimensions") == "1";
  options.detection.keep_outer_faces = query_of(request, "outer_faces") == "1";
  return options;
}

json to_wire(const mapping::ImportReport& report) {
  return {{"walls", report.walls},
          {"wall_length", report.wall_length},
          {"rejected", report.rejected},
          {"skew_deg", report.skew_deg},
          {"notes", report.notes}};
}

/// What kind of failure an import's reason is, for the panel's catalogues.
std::string kind_of(const std::string& name, const std::string& reason) {
  struct Kind {
    const char* says;
    const char* kind;
  };
  constexpr std::array kKinds{Kind{"is not an image that Madori reads", "unreadable-format"},
                              Kind{"cut off", "damaged-file"},
                              Kind{"damaged", "damaged-file"},
                              Kind{"is empty", "damaged-file"},
                              Kind{"is no readable PDF", "damaged-file"},
                              Kind{"password", "locked-file"},
                              Kind{"no wall was found", "no-wall"}};
  std::string ending = fs::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  if (ending == ".dwg") return "dwg-format";
  for (const auto& [says, kind] : kKinds)
    if (reason.find(says) != std::string::npos) return kind;
  return "job-failed";
}

/// The operator knows the drawing by the name that it was uploaded with.
mapping::ImportReport import_as(const std::string& name, const mapping::ImportOptions& options,
                                const Job::Progress& progress) {
  try {
    return mapping::import_drawing(options, progress);
  } catch (const Error& e) {
    std::string text = e.what();
    const std::string temporary = options.drawing.string();
    const std::string shown = name.empty() ? "the drawing" : name;
    for (auto at = text.find(temporary); at != std::string::npos;
         at = text.find(temporary, at + shown.size()))
      text.replace(at, temporary.size(), shown);
    throw Job::Failed(kind_of(name, text), text);
  }
}

Response start_import(ApiContext& context, const Request& request) {
  const Reply may = context.vehicle.may_change_site();
  if (!may.accepted) return answer(may);
  auto options = options_of(request);
  const auto file = std::make_shared<UploadedFile>(safe_extension(query_of(request, "name")), request.body);
  options.drawing = file->path();
  options.site = context.editor.folder();
  options.force = true;  // the panel replaces the drawing of its own site; routes and tiles stay
  options.date = context.iso_time();
  const std::string shown = fs::path(query_of(request, "name")).filename().string();
  const bool started =
      context.job.start("import", [options, file, shown, &context](const Job::Progress& progress) {
        const auto report = import_as(shown, options, progress);
        context.vehicle.reload_site();
        return Job::Outcome{std::to_string(report.walls) + " walls", to_wire(report)};
      });
  if (!started) return Response::error(409, "busy", "another drawing is being imported");
  return answer(context.job.state());
}

}  // namespace

void add_import_routes(Router& router, ApiContext& context) {
  router.add("POST", "/api/site/drawing", Role::Integrator,
             guarded([&](const Request& request) { return start_import(context, request); }), Work::Upload);
  router.add("GET", "/api/job", Role::Viewer, [&](const Request&) { return answer(context.job.state()); });
  router.add("DELETE", "/api/job", Role::Integrator, [&](const Request&) {
    context.job.cancel();
    return answer(json::object());
  });
}

}  // namespace madori::hmi
