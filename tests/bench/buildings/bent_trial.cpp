#include "tests/bench/buildings/bent_trial.hpp"

#include <ctime>
#include <nlohmann/json.hpp>

#include "control/diff_drive/odometry.hpp"
#include "core/median.hpp"
#include "localization/wall_extraction/wall_extraction.hpp"
#include "tests/bench/buildings/bent_floor.hpp"
#include "tests/bench/buildings/drive_figures.hpp"
#include "tests/bench/buildings/trial_localizer.hpp"
#include "tests/bench/buildings/wall_scanner.hpp"
#include "tests/support/cloud_in_base.hpp"
#include "tests/support/lidar_models.hpp"

namespace madori::bench {
namespace {

constexpr double kStepS = 0.02;
constexpr int kSampleSteps = 25;
constexpr double kWronglySureM = 1.0;
constexpr double kEndM = 10.0;  ///< of the way, whose errors are the drive's end

WheelGeometry wheels() {
  const mapping::VehicleRecord vehicle;
  return {vehicle.wheel_radius_m, vehicle.wheel_radius_m, vehicle.half_wheel_separation_m};
}

test::BentBuilding building_of(const BentTrialOptions& options) {
  return test::bent_building(test::hard_building(options.seed, options.amplitude_m));
}

class BentTrial {
 public:
  explicit BentTrial(const BentTrialOptions& options)
      : options_(options),
        building_(building_of(options)),
        driver_(building_, options.metres),
        floor_(walls_of(building_), scenario_of(building_), options.seed),
        scanner_(options.seed),
        odometry_(control::OdometryOptions{wheels()}),
        localizer_(make_trial_localizer(options.source, building_.drawn)) {
    floor_.set_pose(driver_.start());
  }

  nlohmann::json drive() {
    const double most_s = 10.0 * options_.metres;
    while (!driver_.arrived() && time_s_ < most_s) step();
    return figures();
  }

 private:
  void step();
  void take_odometry(const test::FloorInput& input);
  void take_scans(const test::FloorInput& input);
  [[nodiscard]] bool looks_with_scanner() const { return options_.sensor == "scan"; }
  [[nodiscard]] std::vector<WallScanner::Scan> scans_of_floor();
  void tap();
  void watch();
  [[nodiscard]] Transform2<Map, Base> on_drawing(const Transform2<Metric, Base>& truth) const;
  [[nodiscard]] Transform2<Map, Base> believed_on_drawing() const;
  [[nodiscard]] nlohmann::json figures();

  BentTrialOptions options_;
  test::BentBuilding building_;
  LapDriver driver_;
  test::VirtualFloor floor_;
  WallScanner scanner_;
  control::DiffDriveOdometry odometry_;
  localization::OdometryTrack track_;
  std::unique_ptr<TrialLocalizer> localizer_;
  PoseEstimate pose_;
  bool tapped_ = false;
  double time_s_ = 0.0;
  int steps_ = 0;
  std::optional<double> first_place_s_;
  ByState time_by_state_s_;
  double wrongly_sure_s_ = 0.0;
  std::vector<double> errors_m_, end_errors_m_;
  nlohmann::json samples_ = nlohmann::json::array();  ///< [time s, said, error m, error deg, state]
};

void BentTrial::step() {
  const test::FloorInput input = floor_.step(driver_.command(floor_.truth()));
  take_odometry(input);
  if (options_.tap && !tapped_) tap();
  take_scans(input);
  time_s_ += kStepS;
  ++steps_;
  watch();
}

void BentTrial::take_odometry(const test::FloorInput& input) {
  for (const auto& status : input.drive) {
    // The newest frame has just come, the others were measured so much earlier.
    const auto age = std::chrono::microseconds(input.drive.back().time_us - status.time_us);
    odometry_.update(status, input.now - age);
    (void)track_.add(odometry_.reading());
    pose_ = localizer_->on_odometry(odometry_.reading());
  }
}

void BentTrial::take_scans(const test::FloorInput& input) {
  for (const auto& cloud : input.clouds) {
    if (looks_with_scanner()) break;
    const auto& lidar = floor_.lidar();
    const LidarModel model = test::spinning_lidar({lidar.x_m, lidar.y_m, lidar.z_m, to_rad(lidar.yaw_deg)});
    const auto base = test::cloud_in_base(cloud, model, track_);
    localizer_->on_scan(base.stamp, localization::extract_walls(base, model), {lidar.x_m, lidar.y_m});
  }
  for (const auto& [stamp, points] : scans_of_floor()) localizer_->on_scan(stamp, points, scanner_.place());
  pose_ = localizer_->on_odometry(odometry_.reading());
}

std::vector<WallScanner::Scan> BentTrial::scans_of_floor() {
  constexpr int kPoses = 4;  // of a step
  static const std::vector<simulation::Body> nobody;
  if (!looks_with_scanner()) return {};
  for (int i = kPoses - 1; i >= 0; --i) {
    const Stamp at = floor_.now() - i * duration_from_seconds(kStepS) / kPoses;
    scanner_.moved(at, floor_.world().frames().building_pose(floor_.truth_at(at)));
  }
  return scanner_.take(floor_.world(), nobody);
}

void BentTrial::tap() {
  constexpr double kOffM = 0.3, kOffRad = to_rad(6.0);
  simulation::Random random(options_.seed, 0x7A9, 0);
  const auto truth = on_drawing(floor_.truth());
  const double direction = random.uniform(-kPi, kPi);
  const double turn = random.below(2) == 0 ? kOffRad : -kOffRad;
  localizer_->set_pose({truth.x_m() + kOffM * std::cos(direction), truth.y_m() + kOffM * std::sin(direction),
                        truth.yaw_rad() + turn},
                       {});
  tapped_ = true;
}

/// The known warp of a true pose; directions turn with the drawing.
Transform2<Map, Base> BentTrial::on_drawing(const Transform2<Metric, Base>& truth) const {
  constexpr double kAheadM = 0.1;
  const auto map = [&](const Point2<Metric>& p) { return building_.warp->map({p.x_m, p.y_m}); };
  const auto at = map(truth.translation());
  const auto ahead = map(truth * Point2<Base>{kAheadM, 0.0});
  return {at.x_m, at.y_m, std::atan2(ahead.y_m - at.y_m, ahead.x_m - at.x_m)};
}

Transform2<Map, Base> BentTrial::believed_on_drawing() const {
  const auto& pose = pose_.map_from_base;
  const auto bent = localizer_->bent();
  return bent ? bent->on_drawing(pose) : pose;
}

void BentTrial::watch() {
  const LocalizationState state = pose_.health.state;
  if (!first_place_s_ && state != LocalizationState::Localized && state != LocalizationState::Degraded)
    return;
  if (!first_place_s_) first_place_s_ = time_s_;
  const auto truth = on_drawing(floor_.truth_at(pose_.stamp));
  const auto pose = believed_on_drawing();
  const double off_m = distance_m(truth.translation(), pose.translation());
  time_by_state_s_.add(state, kStepS);
  if (state == LocalizationState::Localized && off_m > kWronglySureM) wrongly_sure_s_ += kStepS;
  if (steps_ % kSampleSteps != 0) return;
  const double off_deg = to_deg(std::abs(wrap_angle(pose.yaw_rad() - truth.yaw_rad())));
  errors_m_.push_back(off_m);
  if (floor_.driven_m() > options_.metres - kEndM) end_errors_m_.push_back(off_m);
  samples_.push_back({time_s_, localizer_->said(), off_m, off_deg, to_string(state)});
}

nlohmann::json BentTrial::figures() {
  const auto spread = spread_of(errors_m_);
  nlohmann::json seconds;
  for (const auto state : {LocalizationState::Localized, LocalizationState::Degraded,
                           LocalizationState::Ambiguous, LocalizationState::Lost})
    seconds[to_string(state)] = time_by_state_s_.in[static_cast<std::size_t>(state)];
  const auto json_or_null = [](const auto& value) {
    return value ? nlohmann::json(*value) : nlohmann::json();
  };
  std::optional<double> end_m;
  if (!end_errors_m_.empty()) end_m = median_of(end_errors_m_);
  return {{"amplitude_m", options_.amplitude_m},
          {"sensor", options_.sensor},
          {"source", options_.source},
          {"seed", options_.seed},
          {"straight_drawing", building_.options.straight_drawing},
          {"first_place_s", json_or_null(first_place_s_)},
          {"seconds", seconds},
          {"wrongly_sure_s", wrongly_sure_s_},
          {"mean_m", spread.mean_m},
          {"p95_m", spread.p95_m},
          {"most_m", spread.most_m},
          {"end_m", json_or_null(end_m)},
          {"driven_m", floor_.driven_m()},
          {"simulated_s", time_s_},
          {"samples", samples_}};
}

}  // namespace

nlohmann::json drive_bent_building(const BentTrialOptions& options) {
  timespec before{}, after{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &before);
  nlohmann::json figures = BentTrial(options).drive();
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &after);
  figures["cpu_s"] = static_cast<double>(after.tv_sec - before.tv_sec) +
                     static_cast<double>(after.tv_nsec - before.tv_nsec) * 1e-9;
  return figures;
}

}  // namespace madori::bench
