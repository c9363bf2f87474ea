#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "mapping/drawing/import_drawing.hpp"

namespace madori::app {
namespace {

using nlohmann::json;

struct ImportArguments {
  mapping::ImportOptions options;
  std::string json_file;
};

/// A line that is written over itself, once the work has taken a second; nothing where stderr is no terminal.
mapping::Progress terminal_progress() {
  if (::isatty(STDERR_FILENO) == 0) return {};
  return [start = std::chrono::steady_clock::now()](const std::string& stage, double share) {
    if (std::chrono::steady_clock::now() - start < std::chrono::seconds(1)) return;
    std::fprintf(stderr, "\r\033[K%3.0f %%  %s", 100.0 * share, stage.c_str());
    if (share >= 1.0) std::fputs("\r\033[K", stderr);
  };
}

json to_json(const mapping::ImportReport& report) {
  json stages = json::array();
  for (const auto& s : report.stages)
    stages.push_back({{"name", s.name}, {"ms", s.milliseconds}, {"count", s.count}});
  json out{{"name", report.site.name},
           {"drawing", report.site.drawing.file},
           {"width_px", report.site.drawing.width_px},
           {"height_px", report.site.drawing.height_px},
           {"scaled", report.site.scale.has_value()},
           {"walls", report.walls},
           {"wall_length", report.wall_length},
           {"length_unit", report.site.scale ? "m" : "px"},
           {"rejected", report.rejected},
           {"skew_deg", report.skew_deg},
           {"points_sampled", report.points_sampled},
           {"points", report.points},
           {"stages", stages},
           {"notes", report.notes}};
  if (report.site.scale) {
    out["m_per_px"] = report.site.scale->m_per_px;
    out["scale_method"] = report.site.scale->method;
  }
  return out;
}

void print_summary(const mapping::ImportReport& report, const std::string& site) {
  const auto& drawing = report.site.drawing;
  const char* unit = report.site.scale ? "m" : "px";
  std::printf("%s: %d x %d px", report.site.name.c_str(), drawing.width_px, drawing.height_px);
  if (report.site.scale)
    std::printf(", %.1f x %.1f m, %.6g m/px (%s)", drawing.width_px * report.site.scale->m_per_px,
                drawing.height_px * report.site.scale->m_per_px, report.site.scale->m_per_px,
                report.site.scale->method.c_str());
  std::printf("\nwalls     %zu faces, %.1f %s in all; %zu lines taken for something else\n", report.walls,
              report.wall_length, unit, report.rejected);
  std::printf("skew      %.2f deg\n", report.skew_deg);
  std::printf("points    %zu sampled, %zu after the voxel grid\n", report.points_sampled, report.points);
  for (const auto& note : report.notes) std::printf("note      %s\n", note.c_str());
  std::printf("look at   %s/import.png\n", site.c_str());
  if (!report.site.scale)
    std::printf("UNSCALED  nothing may drive on it yet: madori scale %s --known u1,v1,u2,v2=METRES --apply\n",
                site.c_str());
}

void add_detection_options(CLI::App& command, mapping::DetectionOptions& d) {
  command.add_option("--threshold", d.threshold, "ink is darker than this, 1..254 (default: measured)");
  command.add_option("--min-wall-length", d.min_wall_length_px, "shortest wall, pixels (default: measured)");
  command.add_option("--min-thickness", d.min_thickness_px, "solid walls are at least this thick, pixels");
  command.add_option("--close-gap", d.close_gap_px, "gaps up to this are closed, pixels");
  command.add_flag("--keep-furniture", d.keep_furniture, "furniture, machines and stairs are walls too");
  command.add_flag("--keep-dashed", d.keep_dashed, "dashed lines are walls too");
  command.add_flag("--keep-dimensions", d.keep_dimensions, "dimension lines are walls too");
  command.add_flag("--keep-outer-faces", d.keep_outer_faces, "outside faces of thick outer walls too");
  command.add_flag("!--no-straighten", d.straighten, "leave walls as they are drawn");
}

}  // namespace

void add_import(CLI::App& app) {
  auto arguments = std::make_shared<ImportArguments>();
  auto& o = arguments->options;
  CLI::App* command = app.add_subcommand("import", "turn a layout drawing into a site with a wall map");
  command->add_option("drawing", o.drawing, "PNG, JPEG, TIFF, BMP, PDF, SVG or DXF")->required();
  command->add_option("--site", o.site, "the site folder to make")->required();
  command->add_option("--name", o.name, "name of the site (default: the drawing's)");
  command->add_option("--scale", o.m_per_px, "metres a pixel, where it is known")
      ->check(CLI::Range(1e-9, 1e6));
  command->add_option("--dpi", o.plan.dpi, "resolution a PDF or SVG is rendered at")
      ->check(CLI::Range(1.0, 10000.0));
  command->add_option("--page", o.plan.page, "page of a PDF, from 1");
  command->add_option("--layers", o.plan.layers, "layers of a DXF that hold walls")->delimiter(',');
  command->add_option("--point-spacing", o.point_spacing_m, "step of the wall points, metres")
      ->check(CLI::Range(1e-4, 100.0));
  command->add_option("--voxel", o.voxel_m, "voxel of the wall points, metres")
      ->check(CLI::Range(1e-4, 100.0));
  command->add_option("--cell", o.cell_m, "cell of map.pgm, metres")->check(CLI::Range(1e-3, 100.0));
  command->add_flag("--force", o.force, "replace the drawing of an existing site; routes and tiles stay");
  command->add_flag("--debug-images", o.debug_images, "one picture a stage in DIR/debug");
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  add_detection_options(*command, o.detection);
  command->callback([arguments] {
    arguments->options.date = iso_time_utc();
    const mapping::Progress progress = terminal_progress();
    const auto report = mapping::import_drawing(arguments->options, progress);
    if (progress) progress("done", 1.0);
    if (arguments->json_file != "-") print_summary(report, arguments->options.site.string());
    write_json(arguments->json_file, to_json(report));
  });
}

}  // namespace madori::app
