#include "app/runner/self_test.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "app/lidars.hpp"
#include "app/orders/order_store.hpp"
#include "core/failure_words.hpp"
#include "core/result.hpp"
#include "planning/route_graph/route_check.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kRoomForRecordings = 5'000'000'000;

std::string look_at_routes(const fs::path& site, const SiteForDriving& loaded) {
  planning::RouteCheckOptions options;
  options.vehicle = loaded.config.check.vehicle;
  options.tree_file = (site / "routes/tree.csv").string();
  options.path_file = (site / "routes/path.csv").string();
  const auto findings = planning::check_routes(loaded.config.routes, loaded.config.walls->walls(), options);
  for (const auto& finding : findings)
    if (finding.severity == planning::Severity::Error) throw Error(finding.text());
  const std::string good =
      std::to_string(loaded.config.routes.nodes().size()) + " nodes, every station can be reached";
  if (findings.empty()) return good;  // legs too narrow for the vehicle come from a wrong scale, too
  return good + "; " + std::to_string(findings.size()) +
         " warning(s) of madori route --check, the first: " + findings.front().text();
}

/// What a scanner surely sees against what the vehicle needs to stand.
std::string look_at_sight(const CycleConfig& config) {
  const double speed_mps = config.limits.max_speed_mps;
  const double needs_m = config.check.braking.horizon_m(speed_mps);
  char text[160];
  std::snprintf(text, sizeof text, "a leg of %.0f mm is sure to %.1f m; at %.1f m/s the vehicle needs %.1f m",
                kLegM * 1000.0, config.sure_range_m, speed_mps, needs_m);
  if (needs_m <= config.sure_range_m) return text;
  char mend[120];
  std::snprintf(mend, sizeof mend,
                "set max_speed_mps to %.2f (no faster is driven), or mount a lidar with a finer step",
                std::floor(100.0 * config.check.braking.speed_within(config.sure_range_m)) / 100.0);
  throw Error("site.yaml", text, mend);
}

/// How far before the vehicle's front nobody sees who stands there: all lidars look over him. 0 where one
/// sees him up to the bumper.
double looked_over_m(const CycleConfig& config) {
  constexpr double kPersonM = 1.5;  // the smallest of twenty grown-ups (ISO 7250-1)
  if (config.lidars.empty()) return 0.0;
  double best_m = std::numeric_limits<double>::infinity();
  for (const LidarModel& lidar : config.lidars) {
    const double over_m = lidar.mounting.z_m - kPersonM;
    const double below = std::tan(-lidar.min_elevation_rad);
    if (over_m <= 0.0) return 0.0;
    if (below > 0.0) best_m = std::min(best_m, lidar.mounting.x_m + over_m / below);
  }
  return std::max(0.0, best_m - config.check.vehicle.front_m);
}

/// Who lies on the floor must be seen or guarded by something else, or the vehicle be so slow that its bumper
/// may find him (ISO 3691-4: 0.3 m/s without personnel detection). The cycle keeps to that.
std::string look_at_low_bodies(const CycleConfig& config) {
  const double lowest_m = lowest_ahead_m(config.lidars), speed_mps = config.limits.max_speed_mps;
  char text[200];
  if (config.sure_low_m > 0.0) {
    std::snprintf(text, sizeof text, "a body of %.1f m that lies ahead is sure to %.1f m", kLyingM,
                  config.sure_low_m);
    const double over_m = looked_over_m(config);
    if (!(over_m > 0.0)) return text;
    char over[120];
    std::snprintf(over, sizeof over,
                  "; a person who stands within %.1f m of the front is looked over: mount a lower lidar, too",
                  over_m);
    return std::string(text) + over;
  }
  std::snprintf(text, sizeof text,
                "a body of %.1f m that lies ahead is not seen: the lowest lidar looks over it, at %.2f m",
                kLyingM, lowest_m);
  if (!config.low_bodies_guarded_by.empty())
    return std::string(text) + "; the site says what guards it: " + config.low_bodies_guarded_by;
  if (speed_mps <= planning::kUnseenPersonMps)
    return std::string(text) + "; at this speed the bumper may find it";
  throw Error("site.yaml",
              std::string(text) + "; no faster than 0.3 m/s is driven, at which a bumper may find it",
              "mount a lidar at 0.2 m or lower, set max_speed_mps to 0.3, or enter what else guards it: "
              "low_bodies_guarded_by");
}

/// The field of a safety scanner is known to its own configuration alone: routes keep free what site.yaml
/// says.
std::string look_at_fields(const SiteForDriving& loaded) {
  std::string text;
  for (const auto& sensor : loaded.site.sensors) {
    if (!sensors::lidar_of(sensor.type, sensor.name).has_field) continue;
    if (!(sensor.protective_m > 0.0))
      throw Error("site.yaml",
                  "sensor " + sensor.name +
                      " has a protective field, and nothing says how far it reaches: "
                      "routes lead so near to things that it stops the vehicle",
                  "enter protective_m (and protective_side_m) as the scanner is configured");
    char line[160];
    std::snprintf(line, sizeof line, "%s%s: %.2f m ahead, %.2f m beside", text.empty() ? "" : "; ",
                  sensor.name.c_str(), sensor.protective_m, sensor.protective_side_m);
    text += line;
  }
  return text.empty() ? "no safety scanner" : "routes keep the protective field free, " + text;
}

std::string look_at_disk(const fs::path& site) {
  const auto free = fs::space(site).available;
  if (free < kRoomForRecordings)
    throw Error(site.string(), "has only " + std::to_string(free / 1'000'000) + " MB left for recordings",
                "free some disk space");
  return std::to_string(free / 1'000'000'000) + " GB left";
}

std::string look_at_orders(const fs::path& site) {
  const OrderStore store(site / "madori.db");
  if (const auto verdict = store.integrity(); verdict != "ok")
    throw Error((site / "madori.db").string(), verdict, "restore a backup, or move the file away");
  return std::to_string(store.list(true).size()) + " open";
}

}  // namespace

Finding look(const char* what, const std::function<std::string()>& at) {
  try {
    return {what, at(), false};
  } catch (const std::exception& e) {
    return {what, failure_words(e), true};
  }
}

SelfTest look_at_site(const fs::path& site) {
  SelfTest test;
  auto& found = test.findings;
  found.push_back(look("site", [&] {
    test.site = std::make_unique<SiteForDriving>(load_for_driving(site));
    return test.site->site.name + ", " + std::to_string(test.site->walls.size()) + " walls";
  }));
  if (test.site) found.push_back(look("routes", [&] { return look_at_routes(site, *test.site); }));
  if (test.site) found.push_back(look("sight", [&] { return look_at_sight(test.site->config); }));
  if (test.site) found.push_back(look("floor", [&] { return look_at_low_bodies(test.site->config); }));
  if (test.site) found.push_back(look("field", [&] { return look_at_fields(*test.site); }));
  found.push_back(look("orders", [&] { return look_at_orders(site); }));
  found.push_back(look("disk", [&] { return look_at_disk(site); }));
  return test;
}

}  // namespace madori::app
