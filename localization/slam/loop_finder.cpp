#include "localization/slam/loop_finder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

#include "localization/memory/fuse.hpp"
#include "localization/slam/graph_spread.hpp"

namespace madori::localization {
namespace {

double between_m(const Memory& memory, std::size_t a, std::size_t b) {
  return std::abs(memory.keyframes()[a].path_m - memory.keyframes()[b].path_m);
}

struct Span {
  double low = 1e12;
  double high = -1e12;

  void add(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  [[nodiscard]] double length() const { return high - low; }
};

std::size_t from_of(const RelativeFactor& f) {
  return static_cast<std::size_t>(f.from);
}
std::size_t to_of(const RelativeFactor& f) {
  return static_cast<std::size_t>(f.to);
}

}  // namespace

bool LoopFinder::is_complete(const Memory& memory, std::size_t k) const {
  constexpr std::size_t kUntilJudged = 3;  // keyframes that follow a joint before it is judged
  const std::size_t last = stretch_around(memory.keyframes(), k, options_.stretch).last;
  for (std::size_t i = k + 1; i <= last + 1 && i < memory.size(); ++i)
    if (memory.keyframes()[i].cut) return true;
  return last + kUntilJudged < memory.size();
}

std::vector<LoopFinder::Candidate> LoopFinder::candidates(const Memory& memory, std::size_t newest) const {
  const GraphSpread spread(newest, memory.poses(), memory.factors());
  const StretchOptions& stretch = options_.stretch;
  const Eigen::Matrix3d of_guess =
      Eigen::Vector3d(0.5 * stretch.search_m, 0.5 * stretch.search_m, 0.5 * stretch.search_rad)
          .cwiseAbs2()
          .asDiagonal();
  std::vector<Candidate> found;
  for (std::size_t k = 0; k < newest; ++k) {
    const auto& known = spread.at(k);
    if (known) {
      if (between_m(memory, k, newest) < options_.young_m) continue;
      const double sigma_m = std::sqrt(std::max((*known)(0, 0), (*known)(1, 1)));
      if (3.0 * sigma_m < options_.sure_m) continue;
      const double away_m = distance_m(memory.poses()[k].translation(), memory.poses()[newest].translation());
      if (away_m > 4.1 * sigma_m + stretch.search_m) continue;
    }
    const ViewDifference alike = compare_views(views_[newest], views_[k]);
    if (alike.difference > options_.most_unlike) continue;
    const Transform2<Base, Base> motion(0.0, 0.0, alike.turn_rad());
    if (spread.chi_squared(k, motion.inverse(), of_guess) > options_.most_sigmas2) continue;
    found.push_back({k, alike.difference, motion});
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.difference < b.difference; });
  const std::vector<std::size_t> pieces = memory.pieces();
  const bool is_tied = pieces[newest] == pieces.front();
  std::vector<Candidate> apart;
  for (const Candidate& c : found) {
    if (apart.size() == (is_tied ? options_.tried : options_.tried_apart)) break;
    if (std::none_of(apart.begin(), apart.end(), [&](const Candidate& other) {
          return between_m(memory, other.keyframe, c.keyframe) < options_.apart_m;
        }))
      apart.push_back(c);
  }
  return apart;
}

void LoopFinder::seek(const Memory& memory, std::size_t newest) {
  const Stretch here = stretch_around(memory.keyframes(), newest, options_.stretch);
  std::optional<GraphSpread> spread;
  for (const Candidate& c : candidates(memory, newest)) {
    if (!spread) spread.emplace(newest, memory.poses(), memory.factors());
    const auto match =
        match_stretches(memory, stretch_around(memory.keyframes(), c.keyframe, options_.stretch), here,
                        c.motion, options_.stretch);
    if (!match) continue;
    const RelativeFactor back = reversed(match->factor);
    if (spread->chi_squared(c.keyframe, back.motion, back.information.inverse()) > options_.most_sigmas2)
      continue;
    likely_.push_back(match->factor);
  }
}

std::vector<std::vector<RelativeFactor>> LoopFinder::mended_cuts(const Memory& memory) {
  std::vector<std::vector<RelativeFactor>> mended;
  StretchOptions options = options_.stretch;
  options.search_m = options_.joint_m;
  options.search_rad = options_.joint_rad;
  std::erase_if(cuts_, [&](const auto& cut) {
    const auto& [first, motion] = cut;
    if (first >= views_.size()) return false;
    const auto match = match_stretches(memory, stretch_around(memory.keyframes(), first - 1, options),
                                       stretch_around(memory.keyframes(), first, options), motion, options);
    if (match) mended.push_back({match->factor});
    return true;
  });
  return mended;
}

/// Both ends are near to each other by motions that were measured.
bool LoopFinder::comparable(const Memory& memory, const RelativeFactor& a, const RelativeFactor& b) const {
  const auto near = [&](std::size_t i, std::size_t k) {
    if (between_m(memory, i, k) > options_.comparable_m) return false;
    for (std::size_t c = std::min(i, k) + 1; c <= std::max(i, k); ++c)
      if (memory.keyframes()[c].cut) return false;
    return true;
  };
  return near(from_of(a), from_of(b)) && near(to_of(a), to_of(b));
}

/// Around the cycle that two loops and the driving between their ends make, nothing is left.
bool LoopFinder::agree(const Memory& memory, const RelativeFactor& a, const RelativeFactor& b) const {
  const auto& poses = memory.poses();
  const auto by_b = (poses[from_of(a)].inverse() * poses[from_of(b)]) * b.motion *
                    (poses[to_of(b)].inverse() * poses[to_of(a)]);
  const double driven_m = between_m(memory, from_of(a), from_of(b)) + between_m(memory, to_of(a), to_of(b));
  const Transform2<Base, Base> off = a.motion.inverse() * by_b;
  const double m2 =
      2.0 * options_.match_sigma_m * options_.match_sigma_m + options_.drift_m * options_.drift_m * driven_m;
  const double rad2 = 2.0 * options_.match_sigma_rad * options_.match_sigma_rad +
                      options_.drift_rad * options_.drift_rad * driven_m;
  const double lever2 = rad2 * driven_m * driven_m / 4.0;
  return (off.x_m() * off.x_m() + off.y_m() * off.y_m()) / (m2 + lever2) +
             off.yaw_rad() * off.yaw_rad() / rad2 <
         options_.most_sigmas2;
}

/// The loops that agree with the newest, where they are enough and no others speak for another place.
std::vector<RelativeFactor> LoopFinder::believed(const Memory& memory, const RelativeFactor& newest) const {
  std::vector<RelativeFactor> with;
  std::size_t against = 0;
  Span here, there;
  for (const RelativeFactor& f : likely_) {
    if (!comparable(memory, f, newest)) {
      against += between_m(memory, to_of(f), to_of(newest)) < options_.comparable_m;
      continue;
    }
    if (!agree(memory, f, newest)) {
      ++against;
      continue;
    }
    with.push_back(f);
    here.add(memory.keyframes()[to_of(f)].path_m);
    there.add(memory.keyframes()[from_of(f)].path_m);
  }
  const std::vector<std::size_t> pieces = memory.pieces();
  const bool apart = pieces[from_of(newest)] != pieces[to_of(newest)];
  if (with.size() < options_.together || 2 * against >= with.size()) return {};
  if (here.length() < options_.span_m) return {};
  if (apart && (std::min(here.length(), there.length()) < options_.span_apart_m ||
                !fit_all_over(memory, pieces, newest)))
    return {};
  return with;
}

/// With two pieces laid on each other by a loop, all that they see of each other speaks, not the place of the
/// loop alone: buildings repeat themselves, but not everywhere.
bool LoopFinder::fit_all_over(const Memory& memory, const std::vector<std::size_t>& pieces,
                              const RelativeFactor& loop) const {
  const auto& poses = memory.poses();
  const auto& keyframes = memory.keyframes();
  const std::size_t ours = pieces[from_of(loop)], theirs = pieces[to_of(loop)];
  const Transform2<Map, Map> by = poses[from_of(loop)] * loop.motion * poses[to_of(loop)].inverse();
  constexpr std::size_t kOthers = 3;
  SightCount sum;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (pieces[k] != theirs ||
        distance_m(poses[k].translation(), poses[to_of(loop)].translation()) > options_.around_m)
      continue;
    const Transform2<Map, Base> here = by * poses[k];
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const double away_m = distance_m(poses[i].translation(), here.translation());
      if (pieces[i] == ours && away_m < options_.near_m) near.emplace_back(away_m, i);
    }
    std::sort(near.begin(), near.end());
    const SightRing ring(*keyframes[k].scan);
    const std::size_t asked = std::min(near.size(), kOthers);
    for (std::size_t n = 0; n < asked; ++n) {
      const std::size_t i = near[n * near.size() / asked].second;
      const Transform2<Base, Base> motion = here.inverse() * poses[i];
      sum += ring.of(*keyframes[i].scan, motion);
      sum += SightRing(*keyframes[i].scan).of(*keyframes[k].scan, motion.inverse());
    }
  }
  return sum.contradiction() < options_.most_through_all;
}

std::vector<std::vector<RelativeFactor>> LoopFinder::look(const Memory& memory, bool at_end) {
  std::vector<std::vector<RelativeFactor>> groups = mended_cuts(memory);
  if (!groups.empty()) return groups;
  const auto& keyframes = memory.keyframes();
  while (views_.size() < memory.size() && (at_end || is_complete(memory, views_.size()))) {
    const std::size_t k = views_.size();
    views_.push_back(place_view(
        stretch_scan(memory, stretch_around(keyframes, k, options_.stretch), options_.stretch.spacing_m)));
    if (keyframes[k].path_m - sought_path_m_ < options_.every_m && !keyframes[k].cut) continue;
    sought_path_m_ = keyframes[k].path_m;
    const std::size_t before = likely_.size();
    seek(memory, k);
    for (std::size_t h = before; h < likely_.size(); ++h) {
      auto group = believed(memory, likely_[h]);
      if (group.empty()) continue;
      std::erase_if(likely_, [&](const RelativeFactor& f) {
        return std::any_of(group.begin(), group.end(),
                           [&](const RelativeFactor& g) { return g.from == f.from && g.to == f.to; });
      });
      groups.push_back(std::move(group));
      return groups;  // the graph changes before the next is sought
    }
  }
  return mended_cuts(memory);
}

}  // namespace madori::localization
