#include "localization/memory/memory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/memory/fuse.hpp"

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

}  // namespace

Memory::Memory(const MemoryOptions& options) : options_(options) {}

Memory::Memory(const MemoryOptions& options, std::vector<Keyframe> keyframes,
               std::vector<Transform2<Map, Base>> poses, std::vector<RelativeFactor> factors, int loops)
    : options_(options),
      keyframes_(std::move(keyframes)),
      poses_(std::move(poses)),
      factors_(std::move(factors)),
      loops_(loops),
      broken_(true),
      looked_back_(keyframes_.size()),
      last_loop_path_m_(keyframes_.empty() ? 0.0 : keyframes_.back().path_m) {}

std::size_t Memory::window_begin(std::size_t newest) const {
  std::size_t begin = newest + 1;
  while (begin > 0 && static_cast<int>(newest + 1 - begin) < options_.window_keyframes &&
         keyframes_[newest].path_m - keyframes_[begin - 1].path_m < options_.window_path_m) {
    --begin;
  }
  return begin;
}

double Memory::weakest_agreement(std::size_t first) const {
  double weakest = 1.0;
  for (std::size_t k = first; k < size(); ++k) weakest = std::min(weakest, keyframes_[k].agreement);
  return weakest;
}

LocalMap Memory::recent_map(const Point2<Map>& centre) const {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t i = window_begin(); i < keyframes_.size(); ++i) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  return {pieces, centre, options_.map_radius_m};
}

LocalMap Memory::whole_map(const Point2<Map>& centre, double until_path_m) const {
  std::vector<std::pair<double, std::size_t>> near;
  const std::size_t recent = window_begin();
  for (std::size_t i = 0; i < recent; ++i) {
    const double d = distance_m(poses_[i].translation(), centre);
    if (d < options_.nearby_m && keyframes_[i].path_m <= until_path_m) {
      near.emplace_back(d, i);
    }
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), static_cast<std::size_t>(options_.nearby_keyframes)));
  std::vector<LocalMap::Piece> pieces;
  pieces.reserve(near.size() + keyframes_.size() - recent);
  for (const auto& [d, i] : near) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  for (std::size_t i = recent; i < keyframes_.size() && keyframes_[i].path_m <= until_path_m; ++i) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  return {pieces, centre, options_.map_radius_m};
}

void Memory::add(SurfaceScan scan, double path_m, const Transform2<Map, Base>& map_from_base,
                 const Eigen::Matrix3d& motion_information) {
  add(std::move(scan), path_m, map_from_base,
      MeasuredMotion{empty() ? Transform2<Base, Base>() : poses_.back().inverse() * map_from_base,
                     motion_information});
}

void Memory::add(SurfaceScan scan, double path_m, const Transform2<Map, Base>& map_from_base,
                 const MeasuredMotion& motion) {
  const int id = static_cast<int>(size());
  double path = 0.0;
  if (!empty()) {
    path = keyframes_.back().path_m + path_m;
    const double metres = std::min(path_m, 10.0);
    const Eigen::Vector3d grown(options_.chain_m * options_.chain_m * metres,
                                options_.chain_m * options_.chain_m * metres,
                                options_.chain_rad * options_.chain_rad * metres);
    factors_.push_back({id - 1, id, motion.motion, limited(motion.information, grown), false});
  }
  keyframes_.push_back(
      {std::make_shared<const SurfaceScan>(std::move(scan)), path, broken_, motion.agreement});
  poses_.push_back(map_from_base);
  broken_ = false;
}

std::vector<Memory::LoopCandidate> Memory::loop_candidates(std::size_t newest) const {
  const std::size_t end = window_begin(newest);
  const Transform2<Map, Base>& here = poses_[newest];
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

bool Memory::close_loop(std::size_t newest, const LoopCandidate& candidate) {
  std::vector<LocalMap::Piece> pieces;
  for (std::size_t i = candidate.first; i <= candidate.last; ++i) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  const LocalMap map(pieces, poses_[newest].translation(), options_.map_radius_m);
  if (map.empty()) {
    return false;
  }
  const double open_m = keyframes_[newest].path_m - last_loop_path_m_ + extra_open_m_;
  SearchWindow window;
  window.sigma_m = 0.05 + options_.drift_per_m * open_m;
  window.sigma_rad = 0.01 + options_.drift_rad_per_m * open_m;
  window.half_m = std::clamp(3.0 * window.sigma_m, 0.2, 3.0);
  window.half_rad = std::clamp(3.0 * window.sigma_rad, 0.05, 0.5);
  const SurfaceScan& scan = *keyframes_[newest].scan;
  const SearchResult coarse = map.search(scan, poses_[newest], window);
  const MatchResult match = map.refine(scan, coarse.map_from_base, {});
  if (match.inlier_share < options_.loop_inliers ||
      distance_m(match.map_from_base.translation(), coarse.map_from_base.translation()) > 0.15) {
    return false;
  }
  const Transform2<Map, Base>& old = poses_[candidate.nearest];
  RelativeFactor factor;
  factor.from = static_cast<int>(candidate.nearest);
  factor.to = static_cast<int>(newest);
  factor.motion = old.inverse() * match.map_from_base;
  factor.information = turned_into(limited(match.information), old.yaw_rad());
  factor.loop = true;
  factors_.push_back(factor);
  return true;
}

int Memory::close_loops() {
  int closed = 0;
  for (; looked_back_ < size(); ++looked_back_) {
    const Keyframe& keyframe = keyframes_[looked_back_];
    extra_open_m_ = keyframe.after_break ? options_.break_open_m : extra_open_m_;
    int here = 0;
    for (const LoopCandidate& candidate : loop_candidates(looked_back_)) {
      here += close_loop(looked_back_, candidate) ? 1 : 0;
    }
    if (here > 0) {
      last_loop_path_m_ = keyframe.path_m;
      extra_open_m_ = 0.0;
    }
    closed += here;
  }
  loops_ += closed;
  return closed;
}

bool Memory::is_crowded(std::size_t k, const std::vector<char>& gone) const {
  int beside = 0;
  for (std::size_t i = k + 1; i < size() && beside < options_.keyframes_a_place; ++i) {
    beside += gone[i] == 0 &&
                      distance_m(poses_[i].translation(), poses_[k].translation()) < options_.place_m &&
                      std::abs(wrap_angle(poses_[i].yaw_rad() - poses_[k].yaw_rad())) < options_.place_rad
                  ? 1
                  : 0;
  }
  return beside >= options_.keyframes_a_place;
}

/// The first keyframe stays: the start pose is tied to it. The recent ones stay: they are matched against.
int Memory::fuse() {
  std::vector<char> gone(size(), 0);
  int fused = 0;
  for (std::size_t k = 1; k < std::min(window_begin(), looked_back_); ++k) {
    if (is_crowded(k, gone) && take_out(static_cast<int>(k), poses_, factors_)) {
      gone[k] = 1;
      ++fused;
    }
  }
  if (fused > 0) forget(gone);
  return fused;
}

void Memory::forget(const std::vector<char>& gone) {
  std::vector<int> number(size(), 0);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < gone.size(); ++k) {
    number[k] = static_cast<int>(kept);
    if (gone[k] != 0) continue;
    keyframes_[kept] = keyframes_[k];
    poses_[kept] = poses_[k];
    ++kept;
  }
  looked_back_ -= size() - kept;
  keyframes_.resize(kept);
  poses_.resize(kept);
  for (RelativeFactor& f : factors_) {
    f.from = number[static_cast<std::size_t>(f.from)];
    f.to = number[static_cast<std::size_t>(f.to)];
  }
}

std::size_t Memory::bytes() const {
  std::size_t sum = poses_.size() * sizeof(poses_[0]) + factors_.size() * sizeof(factors_[0]);
  for (const Keyframe& keyframe : keyframes_) {
    sum += sizeof(keyframe) + sizeof(SurfaceScan) + keyframe.scan->points.size() * sizeof(SurfacePoint);
  }
  return sum;
}

Transform2<Map, Map> Memory::take_in(Memory other, std::size_t known) {
  const Transform2<Map, Map> by = other.poses_.back() * poses_[known - 1].inverse();
  const int shift = static_cast<int>(other.size()) - static_cast<int>(known);
  for (std::size_t i = known; i < size(); ++i) {
    other.keyframes_.push_back(keyframes_[i]);
    other.poses_.push_back(by * poses_[i]);
  }
  for (const RelativeFactor& f : factors_) {  // loops are closed in the copy only
    if (f.to >= static_cast<int>(known)) {
      other.factors_.push_back({f.from + shift, f.to + shift, f.motion, f.information, f.loop});
    }
  }
  other.broken_ = broken_;
  *this = std::move(other);
  return by;
}

bool Memory::optimise(const std::vector<UnaryFactor>& unary) {
  return optimise_graph(poses_, factors_, unary);
}

double Memory::loops_against(const Transform2<Map, Map>& by, std::size_t first) const {
  constexpr double kLossSq = 9.0;  // GraphOptions::loop_loss
  const auto nats = [](const RelativeFactor& f, const auto& from, const auto& to) {
    const Eigen::Vector3d e = relative_error(f, from, to);
    return 0.5 * kLossSq * std::log1p(e.dot(f.information * e) / kLossSq);
  };
  double sum = 0.0;
  for (const RelativeFactor& f : factors_) {
    const auto from = static_cast<std::size_t>(f.from);
    const auto to = static_cast<std::size_t>(f.to);
    if (!f.loop || (from < first) == (to < first)) continue;
    sum +=
        nats(f, from < first ? poses_[from] : by * poses_[from], to < first ? poses_[to] : by * poses_[to]) -
        nats(f, poses_[from], poses_[to]);
  }
  return sum;
}

void Memory::move(const Transform2<Map, Map>& by, std::size_t first) {
  for (std::size_t i = first; i < poses_.size(); ++i) {
    poses_[i] = by * poses_[i];
  }
}

}  // namespace madori::localization
