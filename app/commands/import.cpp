#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/import_report.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "app/runner/site_lock.hpp"
#include "core/input_file.hpp"
#include "core/result.hpp"
#include "hmi/server/site_backup.hpp"
#include "mapping/drawing/import_drawing.hpp"

namespace madori::app {
namespace {

struct ImportArguments {
  mapping::ImportOptions options;
  std::vector<std::string> like, unlike;
  std::string json_file;
};

/// "u,v", pixels of the drawing.
mapping::LineTouch touch_at(const std::string& text, bool wall) {
  std::istringstream stream(text);
  mapping::LineTouch touch{.wall = wall};
  char comma = 0;
  if (!(stream >> touch.u >> comma >> touch.v) || comma != ',' || !(stream >> std::ws).eof())
    throw Error(text, "is no place of the drawing", "write u,v in its pixels, e.g. --like 812,340");
  return touch;
}

void add_touches(CLI::App& command, ImportArguments& arguments) {
  command.add_option("--like", arguments.like,
                     "u,v of a line that is a wall: lines like it are walls (repeat)");
  command.add_option("--unlike", arguments.unlike,
                     "u,v of a line that is no wall: lines like it are none (repeat)");
}

void add_detection_options(CLI::App& command, mapping::DetectionOptions& d) {
  command.add_option("--min-wall-length", d.min_wall_length_px, "shortest wall, pixels");
  command.add_option("--close-gap", d.close_gap_px, "gaps up to this are closed, pixels");
  command.add_option("--model", d.model, "judge the lines by this wall model instead of the built-in one")
      ->check(CLI::ExistingFile);
  command
      .add_option(
          "--strictness", d.strictness,
          "what a wrong wall weighs against a missed one: 0 keeps all lines, 3 the sure ones (default 0.8)")
      ->check(within(0.0, 1000.0));
  command.add_flag("!--no-straighten", d.straighten, "leave walls as they are drawn");
}

/// Choices of the rules that the wall model has replaced: scripts that name them still run, and are told.
void add_retired_options(CLI::App& command) {
  const auto say = [](const std::string& name) {
    std::fprintf(stderr,
                 "note: %s has no effect any more: --strictness, --like and --unlike say what is a wall\n",
                 name.c_str());
  };
  for (const std::string name : {"--threshold", "--min-thickness"})
    command
        .add_option_function<double>(
            name, [say, name](double) { say(name); }, "no effect any more")
        ->group("");
  for (const std::string name :
       {"--keep-furniture", "--keep-dashed", "--keep-dimensions", "--keep-outer-faces"})
    command
        .add_flag_callback(
            name, [say, name] { say(name); }, "no effect any more")
        ->group("");
}

/// An option that does nothing with this file would be taken for done.
void refuse_unused(const CLI::App& command, const std::filesystem::path& file, bool backup) {
  const auto refuse = [&](const std::string& option, const std::string& why) {
    if (command.count(option) > 0)
      throw Error(option, "does nothing with " + file.string() + ": " + why, "leave it out");
  };
  const std::string ending = lower_extension(file);
  if (ending != ".pdf") refuse("--page", "only a PDF has pages");
  if (ending != ".dxf") refuse("--layers", "only a DXF has layers");
  if (ending != ".dxf") refuse("--unit", "only a DXF is drawn in a unit");
  if (!backup) return;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();  // empty: retired, which is said already
    if (!name.empty() && name != "drawing" && name != "--site" && name != "--force" && name != "--json")
      refuse(name, "a backup comes back as it was");
  }
}

/// `madori import BACKUP`
void restore(const ImportArguments& arguments) {
  const auto& [drawing, given] = std::tie(arguments.options.drawing, arguments.options.site);
  const std::filesystem::path site = given.empty() ? drawing.stem() : given;
  expect_json(arguments.json_file, site);
  const SiteLock lock(site, SiteUse::Change);
  const std::size_t files = hmi::read_backup(drawing, site, arguments.options.force);
  if (arguments.json_file != "-")
    std::printf("%s: %zu files of a backup, as they were\n", site.c_str(), files);
  write_json(arguments.json_file, {{"site", site.string()}, {"files", files}});
}

}  // namespace

void add_import(CLI::App& app) {
  auto arguments = std::make_shared<ImportArguments>();
  auto& o = arguments->options;
  CLI::App* command = app.add_subcommand("import", "turn a layout drawing into a site with a wall map");
  command->add_option("drawing", o.drawing, "PNG, JPEG, TIFF, BMP, PDF, SVG or DXF; or a backup of a site")
      ->required();
  command->add_option("--site", o.site,
                      "the site folder to make (of a backup, default: its file's name without ending)");
  command->add_option("--name", o.name, "name of the site (default: the drawing's)");
  command->add_option("--scale", o.m_per_px, "metres a pixel, where it is known")->check(within(1e-9, 1e6));
  command
      ->add_option("--paper-scale", o.paper_scale,
                   "N where the drawing is printed 1:N (needs its resolution)")
      ->check(within(1.0, 1e5));
  command
      ->add_option("--dpi", o.plan.dpi,
                   "resolution a PDF or SVG is rendered at, or of a scan that does not state it")
      ->check(within(1.0, 10000.0));
  command->add_option("--page", o.plan.page, "page of a PDF, from 1")->check(within(1, 1'000'000));
  command->add_option("--layers", o.plan.layers, "layers of a DXF that hold walls")->delimiter(',');
  command->add_option("--unit", o.plan.unit, "unit of a DXF (default: by the file's evidence)")
      ->check(CLI::IsMember({"mm", "cm", "dm", "m", "in", "ft", "yd"}));
  command->add_option("--point-spacing", o.point_spacing_m, "step of the wall points, metres")
      ->check(within(1e-4, 100.0));
  command->add_option("--voxel", o.voxel_m, "voxel of the wall points, metres")->check(within(1e-4, 100.0));
  command->add_option("--cell", o.cell_m, "cell of map.pgm, metres")->check(within(1e-3, 100.0));
  command->add_flag("--force", o.force, "replace the drawing of an existing site; routes and tiles stay");
  command->add_flag("--debug-images", o.debug_images, "one picture a stage in DIR/debug");
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  add_detection_options(*command, o.detection);
  add_touches(*command, *arguments);
  add_retired_options(*command);
  command->callback([arguments, command] {
    const bool backup = hmi::is_backup(arguments->options.drawing);
    refuse_unused(*command, arguments->options.drawing, backup);
    if (backup) return restore(*arguments);
    if (arguments->options.site.empty()) throw CLI::RequiredError("--site");
    expect_json(arguments->json_file, arguments->options.site);
    arguments->options.date = iso_time_utc();
    auto& touches = arguments->options.detection.touches;
    for (const std::string& place : arguments->like) touches.push_back(touch_at(place, true));
    for (const std::string& place : arguments->unlike) touches.push_back(touch_at(place, false));
    const SiteLock lock(arguments->options.site, SiteUse::Change);
    const mapping::Progress progress = terminal_progress();
    const auto report = mapping::import_drawing(arguments->options, progress);
    if (progress) progress("done", 1.0);
    if (arguments->json_file != "-") print_import_summary(report, arguments->options.site.string());
    write_json(arguments->json_file, import_json(report));
  });
}

}  // namespace madori::app
