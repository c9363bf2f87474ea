#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/runner/service_unit.hpp"
#include "core/result.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kUnit = "madori.service";
constexpr const char* kUnitFile = "/etc/systemd/system/madori.service";

struct ServiceArguments {
  std::string site;
  std::string user;
  std::vector<std::string> run_options;
  bool print = false;
};

/// Who owns the site can write it.
std::string owner_of(const fs::path& site) {
  struct stat about {};
  if (stat(site.c_str(), &about) != 0) throw Error(site.string(), "is no site folder", "name one");
  const passwd* owner = getpwuid(about.st_uid);
  if (owner == nullptr)
    throw Error(site.string(), "belongs to no user of this computer", "name one by --user");
  return owner->pw_name;
}

void systemctl(const std::string& words) {
  if (std::system(("systemctl " + words).c_str()) != 0)  // NOLINT: fixed words
    throw Error("systemctl " + words, "failed", "is this computer run by systemd, and are you root?");
}

/// The service would fail at every start, unseen.
void expect_run_takes(const ServiceArguments& arguments) {
  CLI::App probe;
  add_run(probe);
  probe.get_subcommand("run")->callback([] {});
  std::vector<std::string> words{"run", arguments.site};
  words.insert(words.end(), arguments.run_options.begin(), arguments.run_options.end());
  std::ranges::reverse(words);
  try {
    probe.parse(words);
  } catch (const CLI::ParseError& e) {
    throw Error("what stands after --", e.what(), "madori run --help lists its options");
  }
}

void install(const ServiceArguments& arguments) {
  expect_run_takes(arguments);
  const fs::path site = fs::canonical(arguments.site);
  const std::string unit =
      service_unit({site, fs::canonical("/proc/self/exe"),
                    arguments.user.empty() ? owner_of(site) : arguments.user, arguments.run_options});
  if (arguments.print) {
    std::fputs(unit.c_str(), stdout);
    return;
  }
  mapping::write_file_atomically(kUnitFile, unit);
  systemctl("daemon-reload");
  systemctl(std::string("enable --now ") + kUnit);
  std::printf("%s drives the vehicle of %s from now on; what it says: journalctl -u madori\n", kUnit,
              site.c_str());
}

void remove() {
  if (!fs::exists(kUnitFile))
    throw Error(kUnitFile, "is not installed", "madori service install SITE makes it");
  systemctl(std::string("disable --now ") + kUnit);
  fs::remove(kUnitFile);
  systemctl("daemon-reload");
}

}  // namespace

void add_service(CLI::App& app) {
  auto arguments = std::make_shared<ServiceArguments>();
  CLI::App* service = app.add_subcommand("service", "drive from power-up on, as a service of the computer");
  service->require_subcommand(1);
  CLI::App* in = service->add_subcommand("install", "write the unit of systemd and start it");
  in->add_option("DIR", arguments->site, "site folder")->required()->check(CLI::ExistingDirectory);
  in->add_option("--user", arguments->user, "runs it (default: who owns the site folder)");
  in->add_flag("--print", arguments->print, "the unit to standard output, and nothing else");
  in->add_option("RUN", arguments->run_options, "options of madori run, after --: -- --hmi 0.0.0.0:8080");
  in->callback([arguments] { install(*arguments); });
  CLI::App* out = service->add_subcommand("remove", "stop it and take the unit away");
  out->callback([] { remove(); });
}

}  // namespace madori::app
