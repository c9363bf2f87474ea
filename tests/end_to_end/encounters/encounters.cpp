// Test bodies on the way and persons across it, in the virtual factory: real VLP-16 bytes, real localization,
// the whole cycle, lock-step. The vehicle may stand when touched, never drive or turn. Exit 1 where it moved,
// or where a body did not stop it. Who lies where no lidar of the vehicle sees him may be touched no faster
// than a vehicle drives that does not see him (0.3 m/s): that counts as refused by speed.
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/json_output.hpp"
#include "tests/end_to_end/encounters/meetings.hpp"

namespace madori::encounters {
namespace {

using simulation::MoverKind;

const std::map<std::string, MoverKind> kKinds{
    {"upright", MoverKind::UprightBody}, {"lying", MoverKind::LyingBody}, {"person", MoverKind::Person}};

struct Arguments {
  MeetingOptions meeting;
  int placements = 200;
  int carts = 0;
  std::vector<double> speeds{0.4, 0.7, 1.0};
  std::vector<std::string> kinds{"upright", "lying", "person"};
  std::string json_file;
};

/// All kinds at all speeds; the placements of a kind shared out to the speeds.
std::map<std::string, Tally> meet_all(const Arguments& arguments) {
  std::map<std::string, Tally> tallies;
  const int parts = static_cast<int>(arguments.speeds.size());
  for (int part = 0; part < parts; ++part) {
    MeetingOptions options = arguments.meeting;
    options.speed_mps = arguments.speeds[static_cast<std::size_t>(part)];
    Meetings meetings(options);
    const int count = arguments.placements * (part + 1) / parts - arguments.placements * part / parts;
    for (const auto& name : arguments.kinds) meetings.meet(kKinds.at(name), count, tallies[name]);
  }
  return tallies;
}

bool report(const std::map<std::string, Tally>& tallies, nlohmann::json& figures) {
  bool good = true;
  for (const auto& [name, t] : tallies) {
    std::printf(
        "%s: %d met at up to %.2f m/s, %d stopped the vehicle, %d touched it moving (%d refused by speed, "
        "fastest %.2f m/s), %d standing, nearest %.3f m\n",
        name.c_str(), t.met, t.fastest_mps, t.stopped, t.contacts, t.refused, t.touch_mps, t.others_touched,
        t.nearest_m);
    figures[name] = {{"met", t.met},
                     {"stopped", t.stopped},
                     {"contacts", t.contacts},
                     {"refused_by_speed", t.refused},
                     {"touch_mps", t.touch_mps},
                     {"others_touched", t.others_touched},
                     {"nearest_m", t.nearest_m},
                     {"fastest_mps", t.fastest_mps}};
    good = good && t.contacts == t.refused &&
           (kKinds.at(name) == MoverKind::Person || t.stopped + t.refused >= t.met);
  }
  return good;
}

bool pass_carts(const Arguments& arguments, nlohmann::json& figures) {
  CartTally t;
  MeetingOptions options = arguments.meeting;
  options.speed_mps = arguments.speeds.back();
  options.detours = true;
  Meetings(options).pass_carts(arguments.carts, t);
  std::printf(
      "carts on the way: %d met, %d driven around, %d past by themselves, %d waited for, %d touched\n", t.met,
      t.around, t.other_route, t.waited, t.contacts);
  figures["cart"] = {{"met", t.met}, {"around", t.around}, {"waited", t.waited}, {"contacts", t.contacts}};
  return t.contacts == 0;
}

int run(const Arguments& arguments) {
  nlohmann::json figures;
  bool good = report(meet_all(arguments), figures);
  if (arguments.carts > 0) good = pass_carts(arguments, figures) && good;
  app::write_json(arguments.json_file, figures);
  return good ? 0 : 1;
}

}  // namespace
}  // namespace madori::encounters

int main(int argc, char** argv) {
  CLI::App app("Test bodies on the way and persons across it, in the virtual factory, lock-step");
  madori::encounters::Arguments arguments;
  app.add_option("SITE", arguments.meeting.site, "site folder with routes")->required();
  app.add_option("SCENARIO", arguments.meeting.scenario, "scenario file; its movers stay at home")
      ->required();
  app.add_option("--placements", arguments.placements, "of each kind")->capture_default_str();
  app.add_option("--kinds", arguments.kinds, "upright, lying, person")
      ->delimiter(',')
      ->check(CLI::IsMember({"upright", "lying", "person"}));
  app.add_option("--carts", arguments.carts, "left standing on the way, at the last of the speeds");
  app.add_option("--speeds", arguments.speeds, "m/s: the vehicle's limit, in equal parts of the placements")
      ->delimiter(',');
  app.add_option("--seed", arguments.meeting.seed, "of everything left to chance");
  app.add_option("--json", arguments.json_file, "the figures; - for stdout");
  app.add_flag("--verbose", arguments.meeting.verbose, "print every encounter");
  CLI11_PARSE(app, argc, argv);
  spdlog::set_level(spdlog::level::warn);
  try {
    return madori::encounters::run(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "encounters: %s\n", e.what());
    return 1;
  }
}
