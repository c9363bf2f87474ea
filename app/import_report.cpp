#include "app/import_report.hpp"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace madori::app {
namespace {

/// As a shell takes it for one word: the line that names it is copied.
std::string as_typed(const std::string& text) {
  if (text.find_first_of(" \t\"'\\$&|;<>()*?[]#~!`") == std::string::npos) return text;
  std::string typed = "'";
  for (const char c : text) typed += c == '\'' ? "'\\''" : std::string(1, c);
  return typed + "'";
}

}  // namespace

using nlohmann::json;

mapping::Progress terminal_progress() {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [start = std::chrono::steady_clock::now()](const std::string& stage, double share) {
    if (std::chrono::steady_clock::now() - start < std::chrono::seconds(1)) return;
    std::fprintf(stderr, "\r\033[K%3.0f %%  %s", 100.0 * share, stage.c_str());
    if (share >= 1.0) std::fputs("\r\033[K", stderr);
  };
}

json import_json(const mapping::ImportReport& report) {
  json stages = json::array();
  for (const auto& s : report.found.stages)
    stages.push_back({{"name", s.name}, {"ms", s.milliseconds}, {"count", s.count}});
  json out{{"name", report.site.name},
           {"drawing", report.site.drawing.file},
           {"width_px", report.site.drawing.width_px},
           {"height_px", report.site.drawing.height_px},
           {"scaled", report.site.scale.has_value()},
           {"walls", report.walls.size()},
           {"wall_length", report.wall_length()},
           {"length_unit", report.site.scale ? "m" : "px"},
           {"rejected", report.found.rejected.size()},
           {"skew_deg", report.found.skew_deg},
           {"points_sampled", report.points.sampled},
           {"points", report.points.points.size()},
           {"stages", stages},
           {"notes", report.notes}};
  if (report.site.scale) {
    out["m_per_px"] = report.site.scale->m_per_px;
    out["scale_method"] = report.site.scale->method;
  }
  return out;
}

void print_import_summary(const mapping::ImportReport& report, const std::string& site) {
  const auto& drawing = report.site.drawing;
  const char* unit = report.site.scale ? "m" : "px";
  std::printf("%s: %d x %d px", report.site.name.c_str(), drawing.width_px, drawing.height_px);
  if (report.site.scale)
    std::printf(", %.1f x %.1f m, %.6g m/px (%s)", drawing.width_px * report.site.scale->m_per_px,
                drawing.height_px * report.site.scale->m_per_px, report.site.scale->m_per_px,
                report.site.scale->method.c_str());
  std::printf("\nwalls     %zu faces, %.1f %s in all; %zu lines taken for something else\n",
              report.walls.size(), report.wall_length(), unit, report.found.rejected.size());
  std::printf("skew      %.2f deg\n", report.found.skew_deg);
  std::printf("points    %zu sampled, %zu after the voxel grid\n", report.points.sampled,
              report.points.points.size());
  double ms = 0;
  for (const auto& stage : report.found.stages) ms += stage.milliseconds;
  std::printf("time      %.2f s\n", 1e-3 * ms);
  for (const auto& note : report.notes) std::printf("note      %s\n", note.c_str());
  std::printf("look at   %s/import.png\n", site.c_str());
  if (!report.site.scale)
    std::printf("UNSCALED  nothing may drive on it yet: madori scale %s --known u1,v1,u2,v2=METRES --apply\n",
                as_typed(site).c_str());
}

}  // namespace madori::app
