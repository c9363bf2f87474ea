#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/pose_estimate.hpp"
#include "tests/bench/buildings/clearances.hpp"

namespace madori::bench {

/// Seconds, or metres, in each LocalizationState.
struct ByState {
  std::array<double, 4> in{};

  void add(LocalizationState state, double amount) { in[static_cast<std::size_t>(state)] += amount; }
  [[nodiscard]] double share(LocalizationState state) const;
};

/// Errors of a pose, metres.
struct ErrorSpread {
  std::size_t count = 0;
  double mean_m = 0.0, p95_m = 0.0, most_m = 0.0;
};
[[nodiscard]] ErrorSpread spread_of(std::vector<double> errors_m);

/// The pose held to be true beside the true one; both metric, the Map frame laid on the building.
struct PoseSample {
  double time_s = 0.0;
  Transform2<Map, Base> truth;
  Transform2<Map, Base> pose;
  LocalizationState state = LocalizationState::Lost;
};

/// A delivery that was reported done.
struct StationVisit {
  int station = 0;
  int lap = 0;
  double after_s = 0.0;
  double from_drawn_m = 0.0;  ///< of the vehicle from where the station is drawn
  StationFit fit{};
  bool possible = false;  ///< some place near by holds every clearance
  Clearances drawn{}, in_truth{};
  Point2<simulation::Building> at{};  ///< where the vehicle stood
};

/// What one start in one building came to.
struct DriveFigures {
  std::string name, source;
  std::string error;  ///< why the drive could not be made at all
  std::optional<double> first_place_s;
  double first_place_error_m = 0.0;
  int taps = 0;
  std::vector<std::string> helps;  ///< beyond Resume at the start and the tap
  int asked = 0;
  std::vector<StationVisit> visits;
  std::vector<std::string> undelivered;
  std::vector<std::string> collisions_moving, collisions_standing;
  bool gave_up = false;
  double simulated_s = 0.0, cpu_s = 0.0, driven_m = 0.0;
  ByState time_s, time_after_lap_s, way_after_lap_m;
  std::vector<PoseSample> samples;  ///< from the first place on, ten a second
};

/// Nearer than this to where its station is drawn a delivery may be at the right one: buildings lie up to
/// 1.5 m beside their drawings.
inline constexpr double kSameStationM = 2.0;
[[nodiscard]] int delivered(const DriveFigures& f);

/// All figures; those of the poses raw, and after the best rigid alignment of the whole way.
[[nodiscard]] nlohmann::json to_json(const DriveFigures& f);

}  // namespace madori::bench
