// How the localizer stands harm: real logs on drawings that are wrong, from starts that are wrong, with
// wheels and scans made worse. One configuration for all of them. Needs the data folder
// (docs/reference/benchmarks.md).
//   bench_robustness [DATA/lidar2d [parts of cases' names, comma between [folder for a file of every scan's
//   errors]]]
// Columns: longest run of scans off by more than 2 m; position median and p95, metres; heading mean, degrees;
// share within 0.5 m and 10 degrees; shares of the time in each state; scans LOCALIZED while over 1.5 m off;
// mean of the relations, metres. Drawings of fr079 and aces are lines seen in the log itself, then made
// wrong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "app/health_log.hpp"
#include "app/log_player.hpp"
#include "app/trajectory_score.hpp"
#include "core/result.hpp"
#include "localization/localizer/localizer.hpp"
#include "tests/bench/robustness/drawn_buildings.hpp"
#include "tests/bench/robustness/log_harm.hpp"

namespace madori::bench {
namespace {

using app::StampedPose;
using Truth = std::vector<StampedPose>;

/// A log with its reference in the drawing's frame and its drawing, nothing harmed yet.
struct Building {
  std::string name;
  Records log;
  Truth truth;
  mapping::Walls walls;
  std::filesystem::path relations;
};

struct Case {
  std::string name;
  LogHarm log{};
  Lies lies{};
  PictureHarm picture{};
  double start_x_m = 0.35, start_y_m = 0.35, start_deg = 10.0;
  bool has_drawing = true;
  unsigned seed = 1;
  localization::LocalizerOptions options{};
  int laps = 1;  ///< the log again and again, each time on the memory of the drives before
};

/// A log that vanishes record by record.
class Replay final : public sensors::LogReader {
 public:
  explicit Replay(Records records) : records_(std::move(records)) {}
  std::optional<sensors::LogRecord> next() override {
    if (at_ == records_.size()) return std::nullopt;
    return records_[at_++];
  }

 private:
  Records records_;
  std::size_t at_ = 0;
};

const StampedPose& nearest(const Truth& truth, Stamp stamp) {
  return *std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
    return std::abs((a.stamp - stamp).count()) < std::abs((b.stamp - stamp).count());
  });
}

Truth truth_of(const Building& building, const Case& c) {
  Truth truth = building.truth;
  const Stamp first = sensors::stamp_of(building.log.front());
  const Stamp last = sensors::stamp_of(building.log.back());
  for (StampedPose& pose : truth) {
    if (c.log.reversed) pose.stamp = first + (last - pose.stamp);
    const Point2<Map> p = scaled_about_middle(building.walls, pose.map_from_base.translation(), c.lies.scale);
    pose.map_from_base = {p.x_m, p.y_m, pose.map_from_base.yaw_rad()};
  }
  return truth;
}

struct Outcome {
  Truth trajectory;
  app::HealthLog health;
  int longest_lost = 0;
  int wrongly_sure = 0;
  double worst_sure_m = 0.0;
  double p50_ms = 0.0, p99_ms = 0.0;
  std::string scans =
      "time_s,x_m,y_m,error_x_m,error_y_m,error_deg,on_walls,on_memory,sigma_m,nats_a_wall,drawing_sigma_m,"
      "elsewhere_nats,state,reason\n";
};

/// The pose at a scan, and what it was judged by.
struct AtScan {
  PoseEstimate estimate;
  localization::HealthEvidence evidence;
};

void judge_scans(const std::vector<AtScan>& at_scans, const Truth& truth, Outcome& out) {
  int run = 0;
  for (const auto& [e, evidence] : at_scans) {
    const StampedPose& t = nearest(truth, e.stamp);
    if (std::abs(to_seconds(t.stamp - e.stamp)) > 0.05) continue;
    const Transform2<Base, Base> off = t.map_from_base.inverse() * e.map_from_base;
    out.scans += fmt::format(
        "{:.3f},{:.3f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.3f},{:.3f},{:.2f},{:.3f},{:.0f},{},\"{}\"\n",
        to_seconds(t.stamp.time_since_epoch()), t.map_from_base.x_m(), t.map_from_base.y_m(),
        e.map_from_base.x_m() - t.map_from_base.x_m(), e.map_from_base.y_m() - t.map_from_base.y_m(),
        to_deg(off.yaw_rad()), evidence.on_walls, evidence.on_memory,
        std::sqrt(e.covariance.topLeftCorner<2, 2>().trace()),
        evidence.fit_nats / std::max(1.0, evidence.walls_seen), evidence.sigma_m, evidence.elsewhere_nats,
        to_string(e.health.state), e.health.reason);
    const double d = distance_m(t.map_from_base.translation(), e.map_from_base.translation());
    run = d > 2.0 ? run + 1 : 0;
    out.longest_lost = std::max(out.longest_lost, run);
    const bool sure = e.health.state == LocalizationState::Localized;
    out.wrongly_sure += d > 1.5 && sure ? 1 : 0;
    out.worst_sure_m = std::max(out.worst_sure_m, sure ? d : 0.0);
  }
}

Outcome play(const Building& building, const Case& c, localization::Memory& memory) {
  std::mt19937 engine(c.seed);
  const mapping::Walls walls = c.has_drawing ? lie(building.walls, c.lies, engine) : mapping::Walls{};
  const Records log = harmed(building.log, c.log, engine);
  const Truth truth = truth_of(building, c);
  const auto first_scan = std::find_if(
      log.begin(), log.end(), [&](const auto& r) { return std::holds_alternative<sensors::ScanRecord>(r); });
  const Transform2<Map, Base> begin = nearest(truth, sensors::stamp_of(*first_scan)).map_from_base;
  const Transform2<Map, Base> start(begin.x_m() + c.start_x_m, begin.y_m() + c.start_y_m,
                                    begin.yaw_rad() + to_rad(c.start_deg));
  localization::Localizer localizer(walls, localization::InitialPose{start}, c.options);
  if (!memory.empty()) localizer.recall(std::move(memory));
  Outcome out;
  std::vector<AtScan> at_scans;
  std::vector<Stamp> scan_stamps;
  for (const auto& r : log) {
    if (std::holds_alternative<sensors::ScanRecord>(r)) scan_stamps.push_back(sensors::stamp_of(r));
  }
  Replay reader(log);
  std::size_t scan = 0;
  app::PlayedLog played = app::play_log(reader, localizer, [&](const PoseEstimate& e) {
    out.trajectory.push_back({e.stamp, e.map_from_base});
    out.health.add(e);
    if (scan < scan_stamps.size() && e.stamp == scan_stamps[scan]) {
      at_scans.push_back({e, localizer.evidence()});
      ++scan;
    }
  });
  std::sort(played.scan_ms.begin(), played.scan_ms.end());
  out.p50_ms = played.scan_ms[played.scan_ms.size() / 2];
  out.p99_ms = played.scan_ms[played.scan_ms.size() * 99 / 100];
  judge_scans(at_scans, truth, out);
  memory = localizer.finished_memory();
  return out;
}

void print_case(const Building& building, const Case& c, const std::filesystem::path& scans,
                localization::Memory& memory) {
  const Outcome out = play(building, c, memory);
  if (!scans.empty()) std::ofstream(scans / (building.name + " " + c.name + ".csv")) << out.scans;
  const auto score = app::score_against_truth(out.trajectory, truth_of(building, c));
  double relations = 0.0;
  if (!c.log.reversed && std::filesystem::exists(building.relations)) {
    relations = app::score_against_relations(
        out.trajectory, app::load_relations(building.relations))["translation_m"]["mean"];
  }
  const auto share = [&](LocalizationState s) { return 100.0 * out.health.share(s); };
  std::printf(
      "%-26s %4d %6.3f %6.3f %6.2f %5.1f | %5.1f %5.1f %5.1f %5.1f %4d %5.2f | %6.3f | %5.1f %5.1f | %4zu "
      "%5.2f\n",
      (building.name + "/" + c.name).c_str(), out.longest_lost, score["position_m"]["median"].get<double>(),
      score["position_m"]["p95"].get<double>(), score["heading_deg"]["mean"].get<double>(),
      100.0 * score["within"]["share"].get<double>(), share(LocalizationState::Localized),
      share(LocalizationState::Degraded), share(LocalizationState::Ambiguous), share(LocalizationState::Lost),
      out.wrongly_sure, out.worst_sure_m, relations, out.p50_ms, out.p99_ms, memory.size(),
      1e-6 * static_cast<double>(memory.bytes()));
  std::fflush(stdout);
}

Case coarse_laps(int keyframes_a_place, double place_m, double place_rad) {
  Case c{.name = "laps " + std::to_string(place_m).substr(0, 3), .laps = 4};
  c.options.memory.keyframes_a_place = keyframes_a_place;
  c.options.memory.place_m = place_m;
  c.options.memory.place_rad = place_rad;
  return c;
}

std::vector<Case> log_harms() {
  return {{.name = "start ++", .start_x_m = 0.35, .start_y_m = 0.35, .start_deg = 10.0},
          {.name = "start --", .start_x_m = -0.35, .start_y_m = -0.35, .start_deg = 10.0},
          {.name = "start +-", .start_x_m = 0.35, .start_y_m = -0.35, .start_deg = -10.0},
          {.name = "start -+", .start_x_m = -0.35, .start_y_m = 0.35, .start_deg = -10.0},
          {.name = "from 25 %", .log = {.begin = 0.25}},
          {.name = "from 50 %", .log = {.begin = 0.5}},
          {.name = "from 75 %", .log = {.begin = 0.75}},
          {.name = "backwards", .log = {.reversed = true}},
          {.name = "every 2nd scan", .log = {.every = 2}},
          {.name = "every 4th scan", .log = {.every = 4}},
          {.name = "wheels 5 % long", .log = {.distance_scale = 1.05}},
          {.name = "wheels 5 % short", .log = {.distance_scale = 0.95}},
          {.name = "turns 10 % more", .log = {.turn_scale = 1.1}},
          {.name = "bias 3 deg/m", .log = {.bias_rad_per_m = 0.052}},
          {.name = "noisy wheels", .log = {.noise = 0.15}},
          {.name = "laps", .laps = 4},
          coarse_laps(1, 0.6, 0.35),
          coarse_laps(1, 1.0, 0.6)};
}

/// Half a metre in ten directions and ten degrees to either side.
std::vector<Case> ten_starts() {
  std::vector<Case> cases;
  for (int k = 0; k < 10; ++k) {
    const double a = 2.0 * kPi * k / 10.0;
    cases.push_back({.name = "ten " + std::to_string(k),
                     .start_x_m = 0.5 * std::cos(a),
                     .start_y_m = 0.5 * std::sin(a),
                     .start_deg = k % 2 == 0 ? -10.0 : 10.0});
  }
  return cases;
}

std::vector<Case> drawing_harms() {
  std::vector<Case> cases;
  for (const double s : {0.98, 0.99, 0.995, 1.005, 1.01, 1.02}) {
    cases.push_back({.name = "scale " + std::to_string(s).substr(0, 5), .lies = {.scale = s}});
  }
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::string n = " " + std::to_string(seed);
    cases.push_back({.name = "20 % missing" + n, .lies = {.missing = 0.2}, .seed = seed});
    cases.push_back({.name = "shift 0.15" + n, .lies = {.shift_m = 0.15}, .seed = seed});
    cases.push_back({.name = "bend 0.4" + n, .lies = {.bend_m = 0.4}, .seed = seed});
  }
  return cases;
}

/// A layout as one finds them: long walls only, some missing, each somewhat off, all of it bent.
std::vector<Case> rough_drawings() {
  std::vector<Case> cases;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    cases.push_back({.name = "rough " + std::to_string(seed),
                     .lies = {.bend_m = 0.3, .shift_m = 0.12, .missing = 0.15, .shortest_m = 1.2},
                     .seed = seed});
    cases.push_back({.name = "poor " + std::to_string(seed),
                     .lies = {.bend_m = 0.5, .shift_m = 0.2, .missing = 0.3, .shortest_m = 2.0},
                     .seed = seed});
  }
  return cases;
}

Building with_own_drawing(const std::filesystem::path& folder, const std::string& name) {
  Building b{name,
             load_records(folder / name / (name + ".log")),
             app::load_tum(folder / name / "reference.tum"),
             {},
             folder / name / (name + ".relations")};
  b.walls = walls_from_log(b.log, b.truth);
  return b;
}

Building intel(const std::filesystem::path& folder, const std::string& picture = "layout.png",
               const PictureHarm& harm = {}) {
  const auto at = folder / "intel";
  Building b{"intel", load_records(at / "intel.log"), app::load_tum(at / "reference.tum"),
             picture_walls(at / picture, 0.04259, harm), at / "intel.relations"};
  const Transform2<Map, Map> moved = app::load_map_from_reference(at / "layout.yaml");
  for (StampedPose& pose : b.truth) pose.map_from_base = moved * pose.map_from_base;
  return b;
}

class Table {
 public:
  Table(std::filesystem::path folder, std::string filter, std::filesystem::path scans)
      : folder_(std::move(folder)), filter_(std::move(filter)), scans_(std::move(scans)) {
    std::printf("%-26s %4s %6s %6s %6s %5s | %5s %5s %5s %5s %4s %5s | %6s | %5s %5s | %4s %5s\n", "case",
                "lost", "median", "p95", "head", "in %", "LOC", "DEG", "AMB", "LOST", "sure", "worst",
                "relat.", "p50ms", "p99ms", "keyf", "MB");
  }

  void run(const std::string& name, const std::function<Building()>& make, const std::vector<Case>& cases) {
    std::optional<Building> building;
    for (const Case& c : cases) {
      if (!wanted(name + "/" + c.name)) continue;
      if (!building) building = make();
      building->name = name;
      localization::Memory memory;
      for (int lap = 0; lap < c.laps; ++lap) print_case(*building, c, scans_, memory);
    }
  }

  void all() {
    const auto real = [this] { return intel(folder_); };
    run("intel", real,
        {{.name = "mapping", .start_x_m = 0.0, .start_y_m = 0.0, .start_deg = 0.0, .has_drawing = false}});
    run("intel", real, ten_starts());
    run("intel", real, log_harms());
    run("intel", real, drawing_harms());
    for (const int px : {2, 4}) {
      run("intel", [&] { return intel(folder_, "layout.png", {.blur_px = px}); },
          {{.name = "blur " + std::to_string(px)}});
    }
    for (const int px : {-3, -2, 1}) {
      run("intel", [&] { return intel(folder_, "layout.png", {.thinner_px = px}); },
          {{.name = "thinner " + std::to_string(px)}});
    }
    run("mirrored", [this] { return intel(folder_, "layout_mirrored.png"); }, {{.name = "start"}});
    for (const std::string name : {"fr079", "aces"}) {
      const auto own = [this, name] { return with_own_drawing(folder_, name); };
      run(name, own,
          {{.name = "mapping", .start_x_m = 0.0, .start_y_m = 0.0, .start_deg = 0.0, .has_drawing = false}});
      run(name, own, rough_drawings());
      run(name, own, log_harms());
      run(name, own, drawing_harms());
    }
  }

 private:
  /// Any of the parts of names, which are separated by commas.
  [[nodiscard]] bool wanted(const std::string& name) const {
    std::istringstream parts(filter_);
    for (std::string part; std::getline(parts, part, ',');) {
      if (name.find(part) != std::string::npos) return true;
    }
    return filter_.empty();
  }

  std::filesystem::path folder_;
  std::string filter_;
  std::filesystem::path scans_;
};

}  // namespace
}  // namespace madori::bench

int main(int argc, char** argv) {
  const std::filesystem::path folder = argc > 1 ? argv[1] : std::string(MADORI_SHARED_DATA) + "/lidar2d";
  try {
    madori::bench::Table(folder, argc > 2 ? argv[2] : "", argc > 3 ? argv[3] : "").all();
  } catch (const madori::Error& e) {
    std::fprintf(stderr, "bench_robustness: %s\n", e.what());
    return 1;
  }
}
