#pragma once

#include <cmath>
#include <filesystem>

#include "control/diff_drive/odometry.hpp"
#include "core/pose_estimate.hpp"
#include "localization/drawing_learner/drawing_learner.hpp"
#include "localization/localizer/localizer.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "mapping/wall_map/wall.hpp"
#include "tests/support/virtual_floor.hpp"

namespace madori::test {

/// The sample factory for localization: what it is, and what stands about.
struct TrialSetup {
  simulation::Scenario scenario;
  mapping::Walls drawing;  ///< what localization is given
  mapping::Walls walls;    ///< as built; used where the scenario names none
  planning::RouteGraph routes;
  double drawing_scale = 1.0;  ///< metres on the drawing a true metre
};

/// `data` is the project's data folder. `hidden_percent` of the walls' length stand behind pallets and crates
/// up to `clutter_m` high; twelve people walk about besides the scenario's own. With 0 % nobody is there.
[[nodiscard]] TrialSetup sample_factory_trial(const std::filesystem::path& data, double hidden_percent,
                                              int day, double clutter_m = 1.8);
/// The drawing says `scale` metres for every true metre.
void scale_drawing(TrialSetup& setup, double scale);
/// The building is not as drawn: the wall between the bays, one of the battery room and a column stand 0.2 m
/// to 0.36 m beside their place, a column is gone, a screen is new.
void change_building(TrialSetup& setup);

/// How good a pose was over a time.
struct TrialFigures {
  double driven_m = 0.0, simulated_s = 0.0;
  double localized_s = 0.0, degraded_s = 0.0, ambiguous_s = 0.0, lost_s = 0.0;  ///< after the first fix
  int losses = 0;                                                               ///< times that LOST began
  double square_m2 = 0.0, square_rad2 = 0.0, worst_m = 0.0, worst_rad = 0.0;
  double samples = 0.0;  ///< of LOCALIZED and DEGRADED
  double first_fix_s = -1.0;

  [[nodiscard]] double rmse_m() const { return std::sqrt(square_m2 / std::max(1.0, samples)); }
  [[nodiscard]] double rmse_rad() const { return std::sqrt(square_rad2 / std::max(1.0, samples)); }
  [[nodiscard]] double degraded_share() const {
    return degraded_s / std::max(1e-9, localized_s + degraded_s + ambiguous_s + lost_s);
  }
};

/// One vehicle on one day: the driver drives by the truth, the localizer is watched. Drive statuses and
/// packets take the way they take in the cycle.
class LocalizationTrial {
 public:
  static constexpr double kStep_s = 0.02;

  LocalizationTrial(const TrialSetup& setup, std::uint64_t seed,
                    const localization::LocalizerOptions& options = localization::driving_options());
  LocalizationTrial(const LocalizationTrial&) = delete;
  LocalizationTrial& operator=(const LocalizationTrial&) = delete;

  /// 20 ms of driving, or of standing.
  void step(bool drives = true);
  /// False where it takes longer than `most_s`.
  bool drive(double metres, double most_s);
  void kidnap(const Transform2<Map, Base>& to);

  [[nodiscard]] const PoseEstimate& pose() const { return pose_; }
  [[nodiscard]] const VirtualFloor& floor() const { return floor_; }
  [[nodiscard]] const planning::RouteGraph& routes() const { return routes_; }
  [[nodiscard]] const TrialFigures& figures() const { return figures_; }
  [[nodiscard]] localization::Localizer& localizer() { return localizer_; }
  [[nodiscard]] double error_m() const;
  [[nodiscard]] double error_rad() const;

  localization::DrawingLearner* learner = nullptr;  ///< looks on, where there is one

 private:
  void watch();

  planning::RouteGraph routes_;
  VirtualFloor floor_;
  TrueDriver driver_;
  control::DiffDriveOdometry odometry_;
  localization::OdometryTrack track_;
  localization::Localizer localizer_;
  PoseEstimate pose_;
  double drawing_scale_;
  TrialFigures figures_;
  LocalizationState before_ = LocalizationState::Localized;
};

}  // namespace madori::test
