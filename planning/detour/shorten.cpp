#include "planning/detour/shorten.hpp"

#include <algorithm>
#include <cmath>

#include "planning/detour/dubins.hpp"

namespace madori::planning {

using Pose = Transform2<Map, Base>;

std::vector<Pose> sampled(const std::vector<Pose>& corners, double radius_m, double step_m) {
  std::vector<Pose> poses{corners.front()};
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const DubinsCurve way = shortest_dubins(corners[i - 1], corners[i], radius_m);
    const int steps = std::max(1, static_cast<int>(std::lround(way.length_m() / step_m)));
    for (int k = 1; k < steps; ++k) poses.push_back(way.pose_at(way.length_m() * k / steps));
    poses.push_back(corners[i]);
  }
  return poses;
}

double dubins_length_m(const std::vector<Pose>& corners, double radius_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i)
    length_m += shortest_dubins(corners[i - 1], corners[i], radius_m).length_m();
  return length_m;
}

std::vector<Pose> shortened(const std::vector<Pose>& corners, double radius_m,
                            const std::function<bool(const Pose&)>& is_free_at) {
  constexpr double kStepM = 0.3;
  constexpr double kCheckM = 0.05;
  constexpr double kGainM = 0.05;
  constexpr int kMostChecks = 60'000;
  const auto poses = sampled(corners, radius_m, kStepM);
  std::vector<double> along_m{0.0};
  for (std::size_t i = 1; i < poses.size(); ++i)
    along_m.push_back(along_m.back() + shortest_dubins(poses[i - 1], poses[i], radius_m).length_m());
  int checks = 0;
  const auto is_free_way = [&](const DubinsCurve& way) {
    const int steps = std::max(1, static_cast<int>(std::ceil(way.length_m() / kCheckM)));
    for (int k = 1; k < steps; ++k)
      if (++checks > kMostChecks || !is_free_at(way.pose_at(way.length_m() * k / steps))) return false;
    return true;
  };
  std::vector<Pose> shorter{poses.front()};
  for (std::size_t i = 0; i + 1 < poses.size();) {
    std::size_t next = i + 1;
    for (std::size_t k = poses.size() - 1; k > i + 1 && checks <= kMostChecks; --k) {
      const DubinsCurve direct = shortest_dubins(poses[i], poses[k], radius_m);
      if (direct.length_m() > along_m[k] - along_m[i] - kGainM || !is_free_way(direct)) continue;
      next = k;
      break;
    }
    shorter.push_back(poses[next]);
    i = next;
  }
  return shorter;
}

}  // namespace madori::planning
