#include "localization/memory/memory.hpp"

#include <algorithm>
#include <utility>

#include "localization/memory/fuse.hpp"
#include "localization/memory/loop_closing.hpp"
#include "localization/memory/thinning.hpp"

namespace madori::localization {

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
  while (begin > 0 && (begin > newest || !keyframes_[begin].cut) &&
         static_cast<int>(newest + 1 - begin) < options_.window_keyframes &&
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

const LocalMap& Memory::recent_map(const Point2<Map>& centre) const {
  constexpr double kSameCentreM = 2.0;
  if (room_.has_recent && distance_m(centre, room_.recent_centre) < kSameCentreM) return room_.recent;
  auto& pieces = room_.pieces;
  pieces.clear();
  for (std::size_t i = window_begin(); i < keyframes_.size(); ++i) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  room_.recent_centre = centre;
  room_.recent.build(pieces, centre, options_.map_radius_m);
  room_.has_recent = true;
  return room_.recent;
}

const LocalMap& Memory::whole_map(const Point2<Map>& centre, double until_path_m) const {
  auto& near = room_.near;
  near.clear();
  const std::size_t recent = window_begin();
  for (std::size_t i = 0; i < recent; ++i) {
    const double d = distance_m(poses_[i].translation(), centre);
    if (d < options_.nearby_m && keyframes_[i].path_m <= until_path_m) {
      near.emplace_back(d, i);
    }
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), static_cast<std::size_t>(options_.nearby_keyframes)));
  auto& pieces = room_.pieces;
  pieces.clear();
  for (const auto& [d, i] : near) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  for (std::size_t i = recent; i < keyframes_.size() && keyframes_[i].path_m <= until_path_m; ++i) {
    pieces.push_back({keyframes_[i].scan.get(), poses_[i]});
  }
  room_.whole.build(pieces, centre, options_.map_radius_m);
  return room_.whole;
}

void Memory::add(const SurfaceScan& scan, double path_m, const Transform2<Map, Base>& map_from_base,
                 const Eigen::Matrix3d& motion_information) {
  add(scan, path_m, map_from_base,
      MeasuredMotion{empty() ? Transform2<Base, Base>() : poses_.back().inverse() * map_from_base,
                     motion_information});
}

void Memory::add(const SurfaceScan& scan, double path_m, const Transform2<Map, Base>& map_from_base,
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
  keyframes_.push_back({kept(scan), path, broken_, motion.agreement});
  poses_.push_back(map_from_base);
  room_.has_recent = false;
  broken_ = false;
}

std::shared_ptr<const SurfaceScan> Memory::kept(const SurfaceScan& scan) {
  if (room_.spare.empty()) return std::make_shared<const SurfaceScan>(scan);
  auto copy = std::move(room_.spare.back());
  room_.spare.pop_back();
  *copy = scan;
  return copy;
}

void Memory::make_room() {
  constexpr std::size_t kAhead = 32;  ///< keyframes: at most 4 a second are driven, thinking takes 1 s
  constexpr std::size_t kSpare = 16;
  keyframes_.reserve(size() + kAhead);
  poses_.reserve(size() + kAhead);
  factors_.reserve(factors_.size() + kAhead);
  std::size_t most = 0;
  for (std::size_t i = window_begin(); i < size(); ++i)
    most = std::max(most, keyframes_[i].scan->points.size());
  room_.spare.reserve(kSpare);
  while (room_.spare.size() < kSpare) room_.spare.push_back(std::make_shared<SurfaceScan>());
  for (const auto& scan : room_.spare) scan->points.reserve(most + most / 4);
}

void Memory::forget_across(std::size_t first) {
  const int begin = static_cast<int>(first);
  std::erase_if(factors_, [&](const RelativeFactor& f) { return (f.from < begin) != (f.to < begin); });
  looked_back_ = std::min(looked_back_, first);
  room_.has_recent = false;
}

void Memory::lead_otherwise(std::size_t first, const RelativeFactor& motion) {
  forget_across(first);
  factors_.push_back(motion);
  move(poses_[first - 1] * motion.motion * poses_[first].inverse(), first);
}

void Memory::cut(std::size_t first) {
  forget_across(first);
  keyframes_[first].cut = keyframes_[first].after_break = true;
}

void Memory::tie(const std::vector<RelativeFactor>& loops) {
  for (const RelativeFactor& f : loops) {
    const auto older = static_cast<std::size_t>(std::min(f.from, f.to));
    const auto newer = static_cast<std::size_t>(std::max(f.from, f.to));
    for (std::size_t k = older + 1; k <= newer; ++k)  // what was sought among its own alone
      if (keyframes_[k].cut) looked_back_ = std::min(looked_back_, k);
    factors_.push_back(f);
  }
  loops_ += static_cast<int>(loops.size());
}

std::vector<std::size_t> Memory::pieces() const {
  std::vector<std::size_t> of(size());
  for (std::size_t k = 0; k < size(); ++k) of[k] = k;
  const auto root = [&of](std::size_t k) {
    while (of[k] != k) k = of[k] = of[of[k]];
    return k;
  };
  for (const RelativeFactor& f : factors_) {
    const std::size_t a = root(static_cast<std::size_t>(f.from));
    const std::size_t b = root(static_cast<std::size_t>(f.to));
    of[std::max(a, b)] = std::min(a, b);
  }
  for (std::size_t k = 0; k < size(); ++k) of[k] = root(k);
  return of;
}

void Memory::move_piece(const Transform2<Map, Map>& by, std::size_t piece) {
  const std::vector<std::size_t> of = pieces();
  for (std::size_t k = 0; k < size(); ++k)
    if (of[k] == piece) poses_[k] = by * poses_[k];
  room_.has_recent = false;
}

void Memory::keep_piece(std::size_t piece) {
  std::vector<char> gone;
  for (const std::size_t of : pieces()) gone.push_back(of == piece ? 0 : 1);
  std::erase_if(factors_,
                [&](const RelativeFactor& f) { return gone[static_cast<std::size_t>(f.from)] != 0; });
  compact(gone, keyframes_, poses_, factors_);
  looked_back_ = size();
  room_.has_recent = false;
}

void Memory::forget_broken_end() {
  std::size_t end = size();
  while (end > 0 && keyframes_[end - 1].after_break) --end;
  if (end == size()) return;
  keyframes_.resize(end);
  poses_.resize(end);
  std::erase_if(factors_,
                [end](const RelativeFactor& f) { return std::max(f.from, f.to) >= static_cast<int>(end); });
  looked_back_ = std::min(looked_back_, end);
  room_.has_recent = false;
}

void Memory::put_behind(Memory earlier) {
  if (earlier.empty() || empty()) return;
  const auto shift = static_cast<int>(earlier.size());
  const double way_m = earlier.keyframes_.back().path_m + options_.break_open_m - keyframes_.front().path_m;
  earlier.factors_.push_back(
      {shift - 1, shift, {}, limited(Eigen::Matrix3d::Zero(), Eigen::Vector3d::Zero()), false});
  for (Keyframe& keyframe : keyframes_) {
    keyframe.path_m += way_m;
    earlier.keyframes_.push_back(std::move(keyframe));
  }
  earlier.keyframes_[earlier.poses_.size()].after_break = true;
  earlier.poses_.insert(earlier.poses_.end(), poses_.begin(), poses_.end());
  for (const RelativeFactor& f : factors_)
    earlier.factors_.push_back({f.from + shift, f.to + shift, f.motion, f.information, f.loop});
  earlier.loops_ += loops_;
  earlier.looked_back_ = static_cast<std::size_t>(shift);
  earlier.broken_ = broken_;
  earlier.room_.has_recent = false;
  *this = std::move(earlier);
}

int Memory::close_loops(const LoopCheck& is_right) {
  int closed = 0;
  for (; looked_back_ < size(); ++looked_back_) {
    const Keyframe& keyframe = keyframes_[looked_back_];
    extra_open_m_ = keyframe.after_break ? options_.break_open_m : extra_open_m_;
    const double open_m = keyframe.path_m - last_loop_path_m_ + extra_open_m_;
    int here = 0;
    for (const LoopCandidate& candidate :
         loop_candidates(poses_, looked_back_, window_begin(looked_back_), options_)) {
      const auto loop = match_loop(keyframes_, poses_, looked_back_, candidate, open_m, options_);
      if (!loop || (is_right && !is_right(*this, *loop))) continue;
      factors_.push_back(*loop);
      ++here;
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

int Memory::forget_loops(const LoopCheck& is_wrong) {
  const auto forgotten = static_cast<int>(
      std::erase_if(factors_, [&](const RelativeFactor& f) { return f.loop && is_wrong(*this, f); }));
  loops_ -= forgotten;
  return forgotten;
}

/// The recent ones stay: they are matched against.
int Memory::fuse() {
  const std::size_t before = size();
  const std::vector<char> gone =
      thin_out(keyframes_, poses_, factors_, std::min(window_begin(), looked_back_), options_);
  const auto fused = std::count(gone.begin(), gone.end(), 1);
  if (fused > 0) compact(gone, keyframes_, poses_, factors_);
  looked_back_ -= before - size();
  room_.has_recent = false;
  return static_cast<int>(fused);
}

std::size_t Memory::bytes() const {
  std::size_t sum = poses_.size() * sizeof(poses_[0]) + factors_.size() * sizeof(factors_[0]);
  for (const Keyframe& keyframe : keyframes_) {
    sum += sizeof(keyframe) + sizeof(SurfaceScan) + keyframe.scan->points.size() * sizeof(SurfacePoint);
  }
  return sum;
}

Transform2<Map, Map> Memory::take_in(Memory& other, std::size_t known) {
  const Transform2<Map, Map> by = other.poses_.back() * poses_[known - 1].inverse();
  const int shift = static_cast<int>(other.size()) - static_cast<int>(known);
  const double way_m = other.keyframes_.back().path_m - keyframes_[known - 1].path_m;
  for (std::size_t i = known; i < size(); ++i) {
    other.keyframes_.push_back(keyframes_[i]);
    other.keyframes_.back().path_m += way_m;
    other.poses_.push_back(by * poses_[i]);
  }
  for (const RelativeFactor& f : factors_) {  // loops are closed in the copy only
    if (f.to >= static_cast<int>(known)) {
      other.factors_.push_back({f.from + shift, f.to + shift, f.motion, f.information, f.loop});
    }
  }
  other.broken_ = broken_;
  std::swap(room_.spare, other.room_.spare);
  std::swap(*this, other);
  std::swap(room_, other.room_);  // the cycle's room stays the cycle's, but for the spare scans
  room_.has_recent = false;
  return by;
}

bool Memory::optimise(const std::vector<UnaryFactor>& unary, const GraphOptions& options) {
  room_.has_recent = false;
  return optimise_graph(poses_, factors_, unary, options);
}

double Memory::loops_against(const Transform2<Map, Map>& by, std::size_t first) const {
  return localization::loops_against(factors_, poses_, by, first);
}

void Memory::move(const Transform2<Map, Map>& by, std::size_t first) {
  room_.has_recent = false;
  for (std::size_t i = first; i < poses_.size(); ++i) {
    poses_[i] = by * poses_[i];
  }
}

Memory RememberedParts::together() const {
  Memory all = now;
  all.forget_broken_end();
  if (earlier) all.put_behind(*earlier);
  all.skip_loops();
  (void)all.fuse();
  return all;
}

}  // namespace madori::localization
