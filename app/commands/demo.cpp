#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "app/commands.hpp"
#include "app/import_report.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "mapping/site/strict_yaml.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

struct DemoArguments {
  std::string site = "demo";
  std::string data = MADORI_DATA_DIR;
  std::string json_file;
};

/// The scale as an operator finds it: one dimension line of the drawing, both its ends in pixels.
void scale_by_one_dimension(const fs::path& sample, mapping::ImportOptions& options) {
  auto meta = mapping::StrictYaml::load(sample / "meta.yaml");
  auto scan = meta.section("scan");
  auto known = scan.section("known_length");
  const double metres = known.number("metres", 0.1, 1e5);
  const auto px = known.raw("pixels").as<std::vector<double>>();
  if (px.size() != 4) throw known.error("pixels", "is not u1, v1, u2, v2");
  options.m_per_px = metres / std::hypot(px[2] - px[0], px[3] - px[1]);
  options.scale_method = "known";
  std::ostringstream input;
  input << px[0] << ',' << px[1] << ',' << px[2] << ',' << px[3] << '=' << metres;
  options.scale_inputs = {input.str()};
}

/// The sample's routes, unless the folder has some already: they may be the operator's own by now.
void copy_routes(const fs::path& sample, const fs::path& site) {
  if (fs::exists(site / "routes")) return;
  fs::copy(sample / "routes_scan", site / "routes");
}

void run(const DemoArguments& arguments) {
  const fs::path sample = fs::path(arguments.data) / "sample_factory";
  mapping::ImportOptions options;
  options.drawing = sample / "factory_scan.png";
  options.site = arguments.site;
  options.name = "Sample factory";
  options.date = iso_time_utc();
  options.force = fs::exists(options.site / "site.yaml");
  scale_by_one_dimension(sample, options);
  const mapping::Progress progress = terminal_progress();
  const auto report = mapping::import_drawing(options, progress);
  if (progress) progress("done", 1.0);
  copy_routes(sample, options.site);
  if (arguments.json_file != "-") print_import_summary(report, arguments.site);
  write_json(arguments.json_file, import_json(report));
}

}  // namespace

void add_demo(CLI::App& app) {
  auto arguments = std::make_shared<DemoArguments>();
  CLI::App* command = app.add_subcommand("demo", "the whole job on the sample factory");
  command->add_option("--site", arguments->site, "the site folder to make")->capture_default_str();
  command->add_option("--data", arguments->data, "folder that holds sample_factory")->capture_default_str();
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace madori::app
