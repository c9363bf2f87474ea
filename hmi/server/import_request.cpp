#include "hmi/server/import_request.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>

#include "core/input_file.hpp"
#include "hmi/server/api_support.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;

/// The file name's ending alone counts: it says the format and never becomes a path.
std::string safe_extension(const std::string& name) {
  const std::string extension = fs::path(name).extension().string();
  for (const char c : extension.substr(std::min<std::size_t>(1, extension.size())))
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) return "";
  return extension.size() <= 6 ? extension : "";
}

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
  options.detection.min_wall_length_px = number_of(request, "min_wall_px", 1.0, 1e5);
  options.detection.strictness = number_of(request, "strictness", 0.0, 1000.0);
  return options;
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
                              Kind{"no wall was found", "no-wall"},
                              Kind{"is no revision of", "no-revision"}};
  if (lower_extension(name) == ".dwg") return "dwg-format";
  for (const auto& [says, kind] : kKinds)
    if (reason.find(says) != std::string::npos) return kind;
  return "job-failed";
}

}  // namespace

UploadedDrawing uploaded_drawing(ApiContext& context, const Request& request) {
  UploadedDrawing drawing{
      options_of(request),
      std::make_shared<UploadedFile>(safe_extension(query_of(request, "name")), request.body),
      fs::path(query_of(request, "name")).filename().string()};
  drawing.options.drawing = drawing.file->path();
  drawing.options.site = context.editor.folder();
  drawing.options.force = true;  // the panel replaces the drawing of its own site; routes and tiles stay
  drawing.options.date = context.iso_time();
  return drawing;
}

Job::Failed UploadedDrawing::failure(const std::string& reason) const {
  const std::string text = file->in_words(reason, shown.empty() ? "the drawing" : shown);
  return {kind_of(shown, text), text};
}

}  // namespace madori::hmi
