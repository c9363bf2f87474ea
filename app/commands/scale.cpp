#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "app/learned/calibration_file.hpp"
#include "app/runner/site_lock.hpp"
#include "app/scale_sources.hpp"
#include "app/scaled_routes.hpp"
#include "core/result.hpp"
#include "mapping/georeference/apply_scale.hpp"

namespace madori::app {
namespace {

struct ScaleArguments {
  std::string site;
  ScaleInputs inputs;
  bool self_calibration = false;
  bool apply = false;
  bool force = false;
  std::string json_file;
};

void write_report(const ScaleArguments& arguments, const ScaleFindings& found, bool applied) {
  nlohmann::json sources = nlohmann::json::array();
  for (const auto& source : found.sources) sources.push_back(to_json(source));
  nlohmann::json out = to_json(found.best);
  out["sources"] = sources;
  out["disagreements"] = found.disagreements;
  out["applied"] = applied;
  write_json(arguments.json_file, out);
}

void print(const ScaleFindings& found, std::FILE* stream) {
  for (const auto& source : found.sources) std::fputs(describe(source).c_str(), stream);
  for (const auto& line : found.disagreements) std::fprintf(stream, "warning: %s\n", line.c_str());
  if (found.sources.size() > 1)
    std::fprintf(stream, "chosen: %s, %s: %s\n", found.best.method.c_str(), to_string(found.best.verdict),
                 found.best.reason.c_str());
}

/// What anybody sees who has been in the building: a length that is wrong by ten.
void print_size(const mapping::DrawingRecord& drawing, double m_per_px, std::FILE* stream) {
  std::fprintf(stream, "the whole drawing is then %.1f x %.1f m\n", drawing.width_px * m_per_px,
               drawing.height_px * m_per_px);
}

/// The inputs, with what was measured while driving where that is asked for.
ScaleInputs inputs_of(const ScaleArguments& arguments, const mapping::Site& site, std::FILE* stream) {
  ScaleInputs inputs = arguments.inputs;
  if (!arguments.self_calibration) return inputs;
  if (!site.scale)
    throw Error(arguments.site, "has no scale yet, so nothing was measured while driving",
                "give it one first: --known, --control, --overlay or --paper");
  const auto walls = mapping::load_walls(std::filesystem::path(arguments.site) / "walls.csv");
  const auto measured = load_calibration(arguments.site, walls);
  std::fputs(describe(measured).c_str(), stream);
  inputs.measured = scale_of(measured, *site.scale);
  return inputs;
}

void run(const ScaleArguments& arguments) {
  expect_json(arguments.json_file);
  const mapping::Site site = mapping::load_site(arguments.site);
  std::FILE* stream = arguments.json_file == "-" ? stderr : stdout;
  const ScaleFindings found = find_scale(inputs_of(arguments, site, stream), site);
  const bool refused = found.best.verdict == mapping::Verdict::Refused;
  print(found, stream);
  print_size(site.drawing, found.best.m_per_px, stream);
  if (!arguments.apply) {
    write_report(arguments, found, false);
    std::fprintf(stream, "nothing was changed; %s\n",
                 refused ? "mend the inputs first" : "add --apply to give the site this scale");
    return;
  }
  if (refused && !arguments.force) {
    write_report(arguments, found, false);
    throw Error(arguments.site, "this scale is refused: " + found.best.reason,
                "mend the inputs, or add --force to use it all the same");
  }
  const SiteLock lock(arguments.site, SiteUse::Change);
  const double factor = mapping::apply_scale(
      arguments.site, found.best, iso_time_utc(),
      [&](mapping::SiteTransaction& change, double by) { stage_scaled_routes(arguments.site, change, by); });
  write_report(arguments, found, true);
  std::fprintf(stream, "applied: %.6g m/px; walls, maps and routes were multiplied by %.6g\n",
               found.best.m_per_px, factor);
}

}  // namespace

void add_scale(CLI::App& app) {
  auto arguments = std::make_shared<ScaleArguments>();
  auto& inputs = arguments->inputs;
  CLI::App* command =
      app.add_subcommand("scale", "find the scale of a site's drawing, and its place on Earth");
  command->add_option("site", arguments->site, "the site folder")->required();
  command->add_option("--known", inputs.known, "u1,v1,u2,v2=METRES: a measured length; repeat")
      ->expected(1)
      ->take_all();
  command->add_option("--control", inputs.control, "u,v=LAT,LON: a pixel with a known place; repeat")
      ->expected(1)
      ->take_all();
  command->add_option("--overlay", inputs.overlay,
                      "zoom=Z,lat=..,lon=..,layout=ZM,photo=ZP: laid over a photograph");
  command->add_option("--paper", inputs.paper, "1:200, the scale printed on the drawing");
  command->add_option("--dpi", inputs.dpi, "resolution for --paper (default: the drawing's)")
      ->check(within(1.0, 100000.0));
  command->add_flag("--self-calibration", arguments->self_calibration,
                    "the scale that was measured while driving");
  command->add_flag("--apply", arguments->apply, "give the site this scale, in one atomic step");
  command->add_flag("--force", arguments->force, "apply a scale that is refused");
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->callback([arguments] {
    if (arguments->inputs.empty() && !arguments->self_calibration)
      throw CLI::RequiredError("one of --known, --control, --overlay, --paper, --self-calibration");
    run(*arguments);
  });
}

}  // namespace madori::app
