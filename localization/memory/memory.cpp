#include "localization/memory/memory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::localization {
namespace {

/// Map-axes information of a pose, expressed in the axes of another pose.
Eigen::Matrix3d turned_into(const Eigen::Matrix3d& information, double yaw_rad) {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  r(0, 0) = r(1, 1) = std::cos(yaw_rad);
  r(0, 1) = -std::sin(yaw_rad);
  r(1, 0) = std::sin(yaw_rad);
  return r.transpose() * information * r;
}

/// No scan match is better than this, however many points agree: 1 cm and 0.15 degrees.
Eigen::Matrix3d limited(const Eigen::Matrix3d& information) {
  const Eigen::Vector3d floor(1e-4, 1e-4, 7e-6);
  const Eigen::Matrix3d regular = information + 1e-3 * Eigen::Matrix3d::Identity();
  return (regular.inverse() + Eigen::Matrix3d(floor.asDiagonal())).inverse();
}

}  // namespace

Memory::Memory(const MemoryOptions& options) : options_(options) {}

std::size_t Memory::window_begin() const {
  std::size_t begin = keyframes_.size();
  const double newest = keyframes_.empty() ? 0.0 : keyframes_.back().path_m;
  while (begin > 0 && static_cast<int>(keyframes_.size() - begin) < options_.window_keyframes &&
         newest - keyframes_[begin - 1].path_m < options_.window_path_m) {
    --begin;
  }
  return begin;
}

LocalMap Memory::recent_map(const Point2<Map>& centre) const {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t i = window_begin(); i < keyframes_.size(); ++i) {
    pieces.push_back({&keyframes_[i].scan, poses_[i]});
  }
  return {pieces, centre, options_.map_radius_m};
}

LocalMap Memory::whole_map(const Point2<Map>& centre) const {
  std::vector<std::pair<double, std::size_t>> near;
  const std::size_t recent = window_begin();
  for (std::size_t i = 0; i < recent; ++i) {
    const double d = distance_m(poses_[i].translation(), centre);
    if (d < options_.nearby_m) {
      near.emplace_back(d, i);
    }
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), static_cast<std::size_t>(options_.nearby_keyframes)));
  std::vector<LocalMap::Piece> pieces;
  for (const auto& [d, i] : near) {
    pieces.push_back({&keyframes_[i].scan, poses_[i]});
  }
  for (std::size_t i = recent; i < keyframes_.size(); ++i) {
    pieces.push_back({&keyframes_[i].scan, poses_[i]});
  }
  return {pieces, centre, options_.map_radius_m};
}

int Memory::add(Keyframe keyframe, const Transform2<Map, Base>& map_from_base,
                const Eigen::Matrix3d& motion_information) {
  const int id = static_cast<int>(keyframes_.size());
  if (!empty()) {
    factors_.push_back(
        {id - 1, id, poses_.back().inverse() * map_from_base, limited(motion_information), false});
  }
  keyframes_.push_back(std::move(keyframe));
  poses_.push_back(map_from_base);
  return static_cast<int>(keyframes_.size()) - 1;
}

std::vector<Memory::LoopCandidate> Memory::loop_candidates() const {
  const std::size_t end = window_begin();
  const Transform2<Map, Base>& here = poses_.back();
  std::vector<LoopCandidate> found;
  std::size_t i = 0;
  while (i < end) {  // one candidate per stay in the neighbourhood
    if (distance_m(poses_[i].translation(), here.translation()) > options_.loop_radius_m) {
      ++i;
      continue;
    }
    LoopCandidate c{i, i, i, options_.loop_radius_m};
    for (; i < end && distance_m(poses_[i].translation(), here.translation()) <= options_.loop_radius_m;
         ++i) {
      const double d = distance_m(poses_[i].translation(), here.translation()) +
                       std::abs(wrap_angle(poses_[i].yaw_rad() - here.yaw_rad()));
      if (d < c.distance_m || c.nearest == c.first) {
        c.distance_m = d;
        c.nearest = i;
      }
    }
    const std::size_t half = static_cast<std::size_t>(options_.loop_chain) / 2;
    c.first = c.nearest > half ? c.nearest - half : 0;
    c.last = std::min(end - 1, c.nearest + half);
    found.push_back(c);
  }
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.distance_m < b.distance_m; });
  if (found.size() > 2) {
    found.resize(2);  // the nearest two say enough
  }
  return found;
}

bool Memory::close_loop(const LoopCandidate& candidate) {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t i = candidate.first; i <= candidate.last; ++i) {
    pieces.push_back({&keyframes_[i].scan, poses_[i]});
  }
  const LocalMap map(pieces, poses_.back().translation(), options_.map_radius_m);
  if (map.empty()) {
    return false;
  }
  const double open_m = keyframes_.back().path_m - last_loop_path_m_ + extra_open_m_;
  SearchWindow window;
  window.sigma_m = 0.05 + options_.drift_per_m * open_m;
  window.sigma_rad = 0.01 + options_.drift_rad_per_m * open_m;
  window.half_m = std::clamp(3.0 * window.sigma_m, 0.2, 3.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.5);
  const SurfaceScan& scan = keyframes_.back().scan;
  const SearchResult coarse = map.search(scan, poses_.back(), window);
  const MatchResult match = map.refine(scan, coarse.map_from_base, {});
  if (match.inlier_share < options_.loop_inliers ||
      distance_m(match.map_from_base.translation(), coarse.map_from_base.translation()) > 0.15) {
    return false;
  }
  const Transform2<Map, Base>& old = poses_[candidate.nearest];
  RelativeFactor factor;
  factor.from = static_cast<int>(candidate.nearest);
  factor.to = static_cast<int>(keyframes_.size()) - 1;
  factor.motion = old.inverse() * match.map_from_base;
  factor.information = turned_into(limited(match.information), old.yaw_rad());
  factor.loop = true;
  factors_.push_back(factor);
  return true;
}

int Memory::close_loops() {
  int closed = 0;
  for (const LoopCandidate& candidate : loop_candidates()) {
    closed += close_loop(candidate) ? 1 : 0;
  }
  if (closed > 0) {
    loops_ += closed;
    last_loop_path_m_ = keyframes_.back().path_m;
    extra_open_m_ = 0.0;
  }
  return closed;
}

bool Memory::optimise(const std::vector<UnaryFactor>& unary) {
  return optimise_graph(poses_, factors_, unary);
}

void Memory::move(const Transform2<Map, Map>& by, std::size_t first) {
  for (std::size_t i = first; i < poses_.size(); ++i) {
    poses_[i] = by * poses_[i];
  }
}

}  // namespace madori::localization
