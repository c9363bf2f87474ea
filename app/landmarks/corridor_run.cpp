#include "app/landmarks/corridor_run.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "localization/landmarks/landmark_agent.hpp"

namespace madori::app {
namespace {

namespace lm = localization::landmarks;

constexpr double kStep_m = 0.05;
constexpr double kStep_rad = 0.1;

using Pose = Transform2<Map, Base>;

/// The walls: an outer and an inner square around the middle line, whose first corner is (0, 0) and whose
/// sides lie right of the start's heading before its turn, so that the ring is driven clockwise.
std::vector<Segment2<Map>> corridor_walls(const CorridorScenario& s) {
  const double half = 0.5 * s.width_m;
  const double side = s.outside_m - s.width_m;
  std::vector<Segment2<Map>> walls;
  for (const double grown : {half, -half}) {
    const Point2<Map> c[4] = {
        {-grown, grown}, {side + grown, grown}, {side + grown, -side - grown}, {-grown, -side - grown}};
    for (int i = 0; i < 4; ++i) walls.push_back({c[i], c[(i + 1) % 4]});
  }
  return walls;
}

/// Drives in small steps, wheels and truth side by side.
class Drive {
 public:
  Drive(const CorridorScenario& scenario, unsigned seed)
      : scenario_(scenario),
        walls_(corridor_walls(scenario)),
        random_(seed),
        agent_(hub_),
        truth_(0.0, 0.0, 0.5 * kPi) {
    odometry_ = truth_;
  }

  CorridorRun run() {
    look();
    int corner = 0;
    const int legs = 4 * scenario_.laps + 1;
    for (int leg = 0; leg < legs; ++leg) {
      lap_ = 1 + leg / 4;
      corner = (corner + 1) % 4;
      drive_to(corner);
      if (scenario_.return_at_sigma_m > 0.0) return_if_unsure(corner);
    }
    turn_by(-0.5 * kPi);  // the last corner is a turning point too
    return std::move(result_);
  }

 private:
  [[nodiscard]] Point2<Map> corner_at(int i) const {
    const double side = scenario_.outside_m - scenario_.width_m;
    const Point2<Map> corners[4] = {{0.0, 0.0}, {side, 0.0}, {side, -side}, {0.0, -side}};
    return corners[i];
  }

  void drive_to(int corner) {
    std::normal_distribution<double> off(0.0, scenario_.corner_sigma_m);
    const Point2<Map> nominal = corner_at(corner);
    const Point2<Map> to{nominal.x_m + off(random_), nominal.y_m + off(random_)};
    turn_by(wrap_angle(std::atan2(to.y_m - truth_.y_m(), to.x_m - truth_.x_m()) - truth_.yaw_rad()));
    while (distance_m(truth_.translation(), to) > 1e-9)
      step(std::min(kStep_m, distance_m(truth_.translation(), to)), 0.0);
  }

  void turn_by(double angle_rad) {
    while (std::abs(angle_rad) > 1e-9) {
      const double part = std::clamp(angle_rad, -kStep_rad, kStep_rad);
      step(0.0, part);
      angle_rad -= part;
    }
  }

  /// "Returns to landmarks with little to no uncertainty": back along the ring, then on from there.
  void return_if_unsure(int corner) {
    const double sigma_m = lm::position_sigma_m(agent_.pose().uncertainty);
    if (sigma_m < scenario_.return_at_sigma_m || agent_.sightings().empty()) return;
    const auto goal = lm::surer_landmark(hub_, agent_.sightings().back().landmark, sigma_m * sigma_m);
    if (!goal) return;
    ++result_.returns;
    const int back = corner_of_[static_cast<std::size_t>(*goal)];
    for (int at = corner; at != back; drive_to(at)) at = (at + 3) % 4;
    for (int at = back; at != corner; drive_to(at)) at = (at + 1) % 4;
  }

  void step(double forward_m, double turn_rad) {
    std::normal_distribution<double> normal;
    truth_ = truth_ * Transform2<Base, Base>(forward_m, 0.0, turn_rad);
    const double root_m = std::sqrt(forward_m);
    const double root_turn = std::sqrt(std::abs(turn_rad) / (2.0 * kPi));
    const WheelNoise& noise = scenario_.random;
    const lm::Displacement wheels{
        forward_m * (1.0 + scenario_.distance_error) + noise.distance_m_per_root_m * root_m * normal(random_),
        0.0,
        turn_rad * (1.0 + scenario_.turn_error) + forward_m * scenario_.heading_error_rad_per_m +
            noise.heading_rad_per_root_m * root_m * normal(random_) +
            noise.turn_rad_per_root_turn * root_turn * normal(random_)};
    odometry_ = odometry_ * Transform2<Base, Base>(wheels.x_m, wheels.y_m, wheels.yaw_rad);
    const WheelNoise& believed = scenario_.believed;
    const double d2 = std::pow(believed.distance_m_per_root_m * root_m, 2);
    const double yaw2 = std::pow(believed.heading_rad_per_root_m * root_m, 2) +
                        std::pow(believed.turn_rad_per_root_turn * root_turn, 2);
    agent_.move({wheels, {lm::Matrix3::diagonal(d2, d2, yaw2)}});
    look();
    result_.truth.push_back(truth_.translation());
    result_.by_odometry.push_back(odometry_.translation());
    result_.by_landmarks.push_back((start_ * transform(agent_.pose().motion)).translation());
  }

  [[nodiscard]] static Transform2<Base, Base> transform(const lm::Displacement& d) {
    return {d.x_m, d.y_m, d.yaw_rad};
  }

  void look() {
    const auto sighting = agent_.look({}, lm::look_around(scan()));
    if (!sighting) return;
    const auto index = static_cast<std::size_t>(sighting->landmark);
    if (!sighting->known) {
      landmark_truth_.push_back(truth_);
      int nearest = 0;
      for (int i = 1; i < 4; ++i)
        if (distance_m(truth_.translation(), corner_at(i)) <
            distance_m(truth_.translation(), corner_at(nearest)))
          nearest = i;
      corner_of_.push_back(nearest);
    }
    if (result_.sightings.empty()) start_ = odometry_ = truth_;
    CornerSighting s;
    s.lap = lap_;
    s.landmark = sighting->landmark;
    s.known = sighting->known;
    s.false_loop = distance_m(truth_.translation(), landmark_truth_[index].translation()) > scenario_.width_m;
    const Transform2<Base, Base> off = truth_.inverse() * (start_ * transform(agent_.pose().motion));
    s.agent_error_m = std::hypot(off.x_m(), off.y_m());
    s.agent_error_rad = std::abs(off.yaw_rad());
    const Transform2<Base, Base> drift = truth_.inverse() * odometry_;
    s.odometry_error_m = std::hypot(drift.x_m(), drift.y_m());
    s.odometry_error_rad = std::abs(drift.yaw_rad());
    const auto published = lm::published_landmarks(hub_);
    for (int i = 0; i < hub_.map().size(); ++i)
      s.landmarks.push_back(state_of(i, published[static_cast<std::size_t>(i)]));
    result_.sightings.push_back(std::move(s));
  }

  [[nodiscard]] LandmarkState state_of(int i, const lm::ScalarPose& published) const {
    const lm::FullPose landmark = hub_.landmark(i);
    const Transform2<Base, Base> truth = start_.inverse() * landmark_truth_[static_cast<std::size_t>(i)];
    const double off[3] = {landmark.motion.x_m - truth.x_m(), landmark.motion.y_m - truth.y_m(),
                           wrap_angle(landmark.motion.yaw_rad - truth.yaw_rad())};
    const lm::Matrix3& covariance = landmark.uncertainty.covariance;
    LandmarkState state;
    state.error_m = std::hypot(off[0], off[1]);
    state.error_rad = std::abs(off[2]);
    state.sigma_m = lm::position_sigma_m(landmark.uncertainty);
    state.sigma_rad = std::sqrt(covariance(2, 2));
    state.published_error_m =
        std::hypot(published.motion.x_m - truth.x_m(), published.motion.y_m - truth.y_m());
    state.published_sigma_m = std::sqrt(published.uncertainty.position_m2);
    for (int k = 0; k < 3; ++k)
      state.within_two_sigma =
          state.within_two_sigma && std::abs(off[k]) <= 2.0 * std::sqrt(covariance(k, k)) + 1e-12;
    return state;
  }

  [[nodiscard]] localization::ScanPoints scan() {
    std::normal_distribution<double> noise(0.0, scenario_.range_sigma_m);
    localization::ScanPoints points;
    for (int beam = 0; beam < scenario_.beams; ++beam) {
      const double bearing = 2.0 * kPi * beam / scenario_.beams;
      const double dx = std::cos(truth_.yaw_rad() + bearing), dy = std::sin(truth_.yaw_rad() + bearing);
      double nearest = 1e9, incidence = 0.0;
      for (const Segment2<Map>& w : walls_) {
        const double ex = w.b.x_m - w.a.x_m, ey = w.b.y_m - w.a.y_m;
        const double wx = w.a.x_m - truth_.x_m(), wy = w.a.y_m - truth_.y_m();
        const double cross = dx * ey - dy * ex;
        const double range = (wx * ey - wy * ex) / cross, along = (wx * dy - wy * dx) / cross;
        if (!(range > 0.0 && along >= 0.0 && along <= 1.0 && range < nearest)) continue;
        nearest = range;
        incidence = std::asin(std::min(1.0, std::abs(cross) / std::hypot(ex, ey)));
      }
      if (incidence < scenario_.least_incidence_rad || nearest > 1e8) continue;
      nearest += noise(random_);
      points.add(nearest * std::cos(bearing), nearest * std::sin(bearing));
    }
    return points;
  }

  CorridorScenario scenario_;
  std::vector<Segment2<Map>> walls_;
  std::mt19937 random_;
  lm::LandmarkHub hub_;
  lm::LandmarkAgent agent_;
  Pose truth_, odometry_, start_;
  int lap_ = 1;
  std::vector<Pose> landmark_truth_;
  std::vector<int> corner_of_;
  CorridorRun result_;
};

}  // namespace

CorridorRun run_corridor(const CorridorScenario& scenario, unsigned seed) {
  return Drive(scenario, seed).run();
}

CorridorSummary summarise(const std::vector<CorridorRun>& runs) {
  CorridorSummary all;
  for (const CorridorRun& run : runs) {
    ++all.runs;
    bool closed = false, within = true;
    for (const CornerSighting& s : run.sightings) {
      ++all.sightings;
      all.matches += s.known ? 1 : 0;
      all.false_loops += s.false_loop ? 1 : 0;
      closed = closed || s.known;
      for (const LandmarkState& l : s.landmarks) within = within && (!closed || l.within_two_sigma);
      if (s.lap >= 3) {
        all.worst_lap3_m = std::max(all.worst_lap3_m, s.agent_error_m);
        all.worst_lap3_rad = std::max(all.worst_lap3_rad, s.agent_error_rad);
      }
    }
    all.runs_within_two_sigma += within ? 1 : 0;
    const CornerSighting& last = run.sightings.back();
    for (const LandmarkState& l : last.landmarks)
      all.worst_landmark_m = std::max(all.worst_landmark_m, l.error_m);
    all.mean_odometry_end_m += last.odometry_error_m / static_cast<double>(runs.size());
    all.mean_odometry_end_rad += last.odometry_error_rad / static_cast<double>(runs.size());
  }
  return all;
}

}  // namespace madori::app
