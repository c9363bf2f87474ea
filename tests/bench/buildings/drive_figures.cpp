#include "tests/bench/buildings/drive_figures.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tests/support/rigid_fit.hpp"

namespace madori::bench {
namespace {

constexpr double kSampleS = 0.1;
constexpr double kWronglySureM = 1.0;

nlohmann::json shares(const ByState& by) {
  nlohmann::json result;
  for (const auto state : {LocalizationState::Localized, LocalizationState::Degraded,
                           LocalizationState::Ambiguous, LocalizationState::Lost})
    result[to_string(state)] = by.share(state);
  return result;
}

nlohmann::json to_json(const ErrorSpread& s) {
  return {{"count", s.count}, {"mean_m", s.mean_m}, {"p95_m", s.p95_m}, {"most_m", s.most_m}};
}

bool drives(LocalizationState state) {
  return state == LocalizationState::Localized || state == LocalizationState::Degraded;
}

/// The errors of poses that were moved by `truth_from_pose` before.
nlohmann::json errors(const std::vector<PoseSample>& samples, const Transform2<Map, Map>& truth_from_pose) {
  std::vector<double> all, localized;
  for (const PoseSample& s : samples) {
    const double off_m = distance_m(truth_from_pose * s.pose.translation(), s.truth.translation());
    all.push_back(off_m);
    if (s.state == LocalizationState::Localized) localized.push_back(off_m);
  }
  const auto wrong =
      std::count_if(localized.begin(), localized.end(), [](double m) { return m > kWronglySureM; });
  return {{"all", to_json(spread_of(all))},
          {"localized", to_json(spread_of(localized))},
          {"wrongly_sure_s", kSampleS * static_cast<double>(wrong)}};
}

Transform2<Map, Map> alignment(const std::vector<PoseSample>& samples) {
  std::vector<std::pair<Point2<Map>, Point2<Map>>> pairs;
  for (const PoseSample& s : samples)
    if (drives(s.state)) pairs.emplace_back(s.pose.translation(), s.truth.translation());
  return test::fit_rigidly(pairs);
}

nlohmann::json to_json(const StationVisit& v) {
  return {{"station", v.station},       {"lap", v.lap},
          {"after_s", v.after_s},       {"from_drawn_m", v.from_drawn_m},
          {"compared", v.fit.compared}, {"held", v.fit.held},
          {"worst_m", v.fit.worst_m},   {"possible", v.possible},
          {"drawn", v.drawn},           {"in_truth", v.in_truth},
          {"at", {v.at.x_m, v.at.y_m}}};
}

nlohmann::json station_figures(const DriveFigures& f) {
  int good = 0, judged = 0, possible = 0, compared = 0, held = 0;
  nlohmann::json visits = nlohmann::json::array();
  for (const StationVisit& v : f.visits) {
    visits.push_back(to_json(v));
    const bool there = v.from_drawn_m <= kSameStationM;
    compared += v.fit.compared;
    held += there ? v.fit.held : 0;
    if (v.fit.compared == 0) continue;
    ++judged;
    possible += v.possible ? 1 : 0;
    good += there && v.fit.good() ? 1 : 0;
  }
  return {{"judged", judged},     {"good", good}, {"possible", possible},
          {"compared", compared}, {"held", held}, {"visits", visits}};
}

}  // namespace

double ByState::share(LocalizationState state) const {
  const double sum = std::accumulate(in.begin(), in.end(), 0.0);
  return sum > 0.0 ? in[static_cast<std::size_t>(state)] / sum : 0.0;
}

ErrorSpread spread_of(std::vector<double> errors_m) {
  if (errors_m.empty()) return {};
  std::sort(errors_m.begin(), errors_m.end());
  const double sum = std::accumulate(errors_m.begin(), errors_m.end(), 0.0);
  return {errors_m.size(), sum / static_cast<double>(errors_m.size()), errors_m[errors_m.size() * 95 / 100],
          errors_m.back()};
}

int delivered(const DriveFigures& f) {
  return static_cast<int>(std::count_if(f.visits.begin(), f.visits.end(),
                                        [](const auto& v) { return v.from_drawn_m <= kSameStationM; }));
}

nlohmann::json to_json(const DriveFigures& f) {
  nlohmann::json json{
      {"name", f.name},
      {"source", f.source},
      {"error", f.error},
      {"first_place_error_m", f.first_place_error_m},
      {"taps", f.taps},
      {"helps", f.helps},
      {"asked", f.asked},
      {"delivered", delivered(f)},
      {"undelivered", f.undelivered},
      {"collisions_moving", f.collisions_moving},
      {"collisions_standing", f.collisions_standing},
      {"gave_up", f.gave_up},
      {"simulated_s", f.simulated_s},
      {"cpu_s", f.cpu_s},
      {"driven_m", f.driven_m},
      {"time_share", shares(f.time_s)},
      {"after_lap_time_share", shares(f.time_after_lap_s)},
      {"after_lap_way_share", shares(f.way_after_lap_m)},
      {"after_lap_m", std::accumulate(f.way_after_lap_m.in.begin(), f.way_after_lap_m.in.end(), 0.0)},
      {"raw", errors(f.samples, {})},
      {"aligned", errors(f.samples, alignment(f.samples))},
      {"stations", station_figures(f)}};
  json["first_place_s"] = f.first_place_s ? nlohmann::json(*f.first_place_s) : nlohmann::json();
  return json;
}

}  // namespace madori::bench
