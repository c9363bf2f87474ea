#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/commands/within.hpp"
#include "app/iso_time.hpp"
#include "app/json_output.hpp"
#include "app/runner/site_lock.hpp"
#include "hmi/server/site_compare.hpp"
#include "mapping/site/site_versions.hpp"

namespace madori::app {
namespace {

struct VersionsArguments {
  std::string site;
  std::vector<int> compare;
  int restore = 0;
  std::string json_file;
};

void list(const VersionsArguments& arguments) {
  const auto versions = hmi::versions_json(arguments.site);
  if (arguments.json_file != "-")
    for (const auto& v : versions)
      std::printf("%d\t%s\t%s\t%s\n", v["number"].get<int>(), iso_time_of(v["stamp"].get<double>()).c_str(),
                  v["author"].get<std::string>().c_str(), v["sentence"].get<std::string>().c_str());
  write_json(arguments.json_file, versions);
}

void compare(const VersionsArguments& arguments) {
  const auto diff = hmi::compare_versions(arguments.site, arguments.compare.at(0), arguments.compare.at(1));
  if (arguments.json_file != "-")
    std::printf("drawing %s, %zu pieces of wall gone, %zu new, %zu points of the routes changed\n",
                diff["drawing_changed"].get<bool>() ? "changed" : "the same", diff["gone"].size(),
                diff["added"].size(), diff["points_changed"].size());
  write_json(arguments.json_file, diff);
}

}  // namespace

void add_versions(CLI::App& app) {
  auto arguments = std::make_shared<VersionsArguments>();
  CLI::App* command = app.add_subcommand("versions", "the saves of a site: list, compare, restore");
  command->add_option("site", arguments->site, "the site folder")->required();
  CLI::Option* compared =
      command->add_option("--compare", arguments->compare, "what differs between two saves")->expected(2);
  command->add_option("--restore", arguments->restore, "make the site what it was; that is a save too")
      ->excludes(compared)
      ->check(within(1, 1'000'000));
  command->add_option("--json", arguments->json_file, "write the figures to a file; - for stdout");
  command->callback([arguments] {
    expect_json(arguments->json_file);
    if (arguments->restore > 0) {
      const SiteLock lock(arguments->site, SiteUse::Change);
      mapping::restore_version(arguments->site, arguments->restore);
    }
    if (arguments->compare.empty())
      list(*arguments);
    else
      compare(*arguments);
  });
}

}  // namespace madori::app
