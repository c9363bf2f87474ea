#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/import_report.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "app/revision/drawing_revision.hpp"
#include "app/runner/site_lock.hpp"
#include "core/angle.hpp"

namespace madori::app {
namespace {

struct DiffArguments {
  mapping::ImportOptions options;
  bool apply = false;
  std::string json_file;
};

void print_pieces(const char* what, const std::vector<Segment2<Map>>& pieces) {
  for (const auto& p : pieces)
    std::printf("  %s: (%.2f, %.2f) to (%.2f, %.2f), %.2f m\n", what, p.a.x_m, p.a.y_m, p.b.x_m, p.b.y_m,
                p.length_m());
}

void print(const DrawingRevision& revision, bool applied) {
  const auto& [scale, yaw_rad, offset] = revision.laid.old_from_new;
  std::printf(
      "the new drawing lies on the old one: scale %.5f, turned by %.3f deg, moved by (%.3f, %.3f); "
      "%.0f %% of its walls lie on old ones\n",
      scale, to_deg(yaw_rad), offset.x(), offset.y(), 100.0 * revision.laid.covered);
  std::printf("%zu pieces of wall gone, %zu new\n", revision.gone.size(), revision.added.size());
  print_pieces("gone", revision.gone);
  print_pieces("new", revision.added);
  for (const auto& finding : revision.findings) std::printf("  routes: %s\n", finding.text().c_str());
  for (const auto& station : revision.stations_lost) std::printf("  station lost: %s\n", station.c_str());
  std::printf("%s\n", applied ? "the new drawing is the site's now; routes are where they were"
                              : "nothing was changed; take it over with --apply");
}

}  // namespace

void add_diff(CLI::App& app) {
  auto arguments = std::make_shared<DiffArguments>();
  auto& o = arguments->options;
  CLI::App* command =
      app.add_subcommand("diff", "lay a new revision of the drawing on a site's, and compare");
  command->add_option("site", o.site, "the site folder")->required();
  command->add_option("drawing", o.drawing, "the new drawing: PNG, JPEG, TIFF, BMP, PDF, SVG or DXF")
      ->required();
  command->add_flag("--apply", arguments->apply,
                    "the new drawing becomes the site's, its routes stay in place");
  command->add_option("--dpi", o.plan.dpi, "resolution a PDF or SVG is rendered at")
      ->check(within(1.0, 10000.0));
  command->add_option("--page", o.plan.page, "page of a PDF, from 1")->check(within(1, 1'000'000));
  command->add_option("--layers", o.plan.layers, "layers of a DXF that hold walls")->delimiter(',');
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->callback([arguments] {
    expect_json(arguments->json_file);
    arguments->options.date = iso_time_utc();
    const mapping::Progress progress = terminal_progress();
    const bool apply = arguments->apply;
    std::optional<SiteLock> lock;
    if (apply) lock.emplace(arguments->options.site, SiteUse::Change);
    const RevisedDrawing revised(arguments->options, progress);
    if (apply) revised.apply();
    if (progress) progress("done", 1.0);
    if (arguments->json_file != "-") print(revised.found(), apply);
    write_json(arguments->json_file, revision_json(revised.found(), apply));
  });
}

}  // namespace madori::app
