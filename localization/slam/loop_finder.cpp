#include "localization/slam/loop_finder.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "localization/memory/fuse.hpp"
#include "localization/pose_axes.hpp"
#include "localization/slam/joints.hpp"

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

/// Of the motion that two alike views stand for.
Eigen::Matrix3d guess_covariance(const StretchOptions& o) {
  return Eigen::Vector3d(0.5 * o.search_m, 0.5 * o.search_m, 0.5 * o.search_rad).cwiseAbs2().asDiagonal();
}

std::size_t from_of(const RelativeFactor& f) {
  return static_cast<std::size_t>(f.from);
}
std::size_t to_of(const RelativeFactor& f) {
  return static_cast<std::size_t>(f.to);
}

}  // namespace

bool LoopFinder::is_complete(const Memory& memory, std::size_t k) const {
  constexpr std::size_t kUntilJudged = JointOptions().keyframes;
  const std::size_t last = stretch_around(memory.keyframes(), k, options_.stretch).last;
  for (std::size_t i = k + 1; i <= last + 1 && i < memory.size(); ++i)
    if (memory.keyframes()[i].cut) return true;
  return last + kUntilJudged < memory.size();
}

std::vector<LoopFinder::Candidate> LoopFinder::candidates(const Memory& memory, std::size_t newest) const {
  const GraphSpread spread(newest, memory.poses(), memory.factors());
  const StretchOptions& stretch = options_.stretch;
  const Eigen::Matrix3d of_guess = guess_covariance(stretch);
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
    if (spread.chi_squared(k, motion.inverse(), of_guess) > kOneInAThousand) continue;
    found.push_back({k, alike.difference, motion});
  }
  const std::vector<std::size_t> pieces = memory.pieces();
  const bool is_tied = pieces[newest] == pieces.front();
  return apart(memory, std::move(found), is_tied ? options_.tried : options_.tried_apart);
}

/// The most alike that are some driving apart from each other.
std::vector<LoopFinder::Candidate> LoopFinder::apart(const Memory& memory, std::vector<Candidate> found,
                                                     std::size_t count) const {
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.difference < b.difference; });
  std::vector<Candidate> some;
  for (const Candidate& c : found) {
    if (some.size() == count) break;
    if (std::none_of(some.begin(), some.end(), [&](const Candidate& other) {
          return between_m(memory, other.keyframe, c.keyframe) < options_.apart_m;
        }))
      some.push_back(c);
  }
  return some;
}

/// The candidate's stretch and the one here laid on each other, where they fit.
std::optional<LoopFinder::Laid> LoopFinder::lay(const Memory& memory, const GraphSpread& spread,
                                                const Candidate& c, const Stretch& here) const {
  const auto match = match_stretches(memory, stretch_around(memory.keyframes(), c.keyframe, options_.stretch),
                                     here, c.motion, options_.stretch);
  if (!match) return std::nullopt;
  const RelativeFactor back = reversed(match->factor);
  const double off = spread.chi_squared(c.keyframe, back.motion, back.information.inverse());
  return Laid{match->factor, off <= kOneInAThousand};
}

void LoopFinder::seek(const Memory& memory, std::size_t newest) {
  const Stretch here = stretch_around(memory.keyframes(), newest, options_.stretch);
  std::optional<GraphSpread> spread;
  for (const Candidate& c : candidates(memory, newest)) {
    if (!spread) spread.emplace(newest, memory.poses(), memory.factors());
    const auto laid = lay(memory, *spread, c, here);
    if (laid && laid->may_be) likely_.push_back(laid->factor);
  }
}

/// What the graph knows to be another place than keyframe `k`, and what passes for it all the same.
void LoopFinder::survey(const Memory& memory, std::size_t k) {
  const StretchOptions& stretch = options_.stretch;
  const GraphSpread spread(k, memory.poses(), memory.factors());
  const Eigen::Matrix3d of_guess = guess_covariance(stretch);
  std::vector<Candidate> elsewhere;
  for (std::size_t i = 0; i < k; ++i) {
    if (!spread.at(i)) continue;
    const ViewDifference alike = compare_views(views_[k], views_[i]);
    const Transform2<Base, Base> motion(0.0, 0.0, alike.turn_rad());
    if (alike.difference <= options_.most_unlike &&
        spread.chi_squared(i, motion.inverse(), of_guess) > kOneInAThousand)
      elsewhere.push_back({i, alike.difference, motion});
  }
  const Stretch here = stretch_around(memory.keyframes(), k, stretch);
  for (const Candidate& c : apart(memory, std::move(elsewhere), options_.tried)) {
    const auto laid = lay(memory, spread, c, here);
    if (laid && !laid->may_be) mistakes_.push_back(laid->factor);
  }
}

/// Surveys so densely that a mistake of that length would show. False: not all could be looked at now.
bool LoopFinder::survey_for(const Memory& memory, double length_m) {
  constexpr double kTimes = 2.0;
  is_surveyed_.resize(sought_.size(), 0);
  const auto step = static_cast<std::size_t>(std::max(1.0, length_m / (kTimes * options_.every_m)));
  for (std::size_t i = 0; i < sought_.size(); i += step) {
    if (is_surveyed_[i] != 0) continue;
    if (surveys_left_ == 0) return false;
    --surveys_left_;
    survey(memory, sought_[i]);
    is_surveyed_[i] = 1;
  }
  return true;
}

double LoopFinder::longest_mistake_m(const Memory& memory) const {
  double longest_m = 0.0;
  const std::vector<std::size_t> pieces = memory.pieces();
  for (const RelativeFactor& m : mistakes_) {
    const Group group = group_of(memory, pieces, mistakes_, m);
    longest_m = std::max({longest_m, group.here_m, group.there_m});
  }
  return longest_m;
}

std::vector<std::size_t> LoopFinder::surely_tied(const Memory& memory) const {
  std::vector<std::size_t> of(memory.size());
  for (std::size_t k = 1; k < of.size(); ++k) of[k] = of[k - 1] + (memory.keyframes()[k].cut ? 1 : 0);
  const double longest_m = longest_mistake_m(memory);
  for (const Tie& tie : ties_) {
    if (tie.length_m < options_.surer * longest_m) continue;
    const std::size_t a = of[tie.from], b = of[tie.to];
    std::replace(of.begin(), of.end(), std::max(a, b), std::min(a, b));
  }
  return of;
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
    if (match && match->sights.contradiction() < options_.most_through_all) {
      mended.push_back({match->factor});
      ties_.push_back({first - 1, first, std::numeric_limits<double>::infinity()});
    }
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
         kOneInAThousand;
}

/// The loops that agree with one of them.
LoopFinder::Group LoopFinder::group_of(const Memory& memory, const std::vector<std::size_t>& pieces,
                                       const std::vector<RelativeFactor>& loops,
                                       const RelativeFactor& one) const {
  Group group;
  Span here, there;
  for (const RelativeFactor& f : loops) {
    if (pieces[from_of(f)] != pieces[from_of(one)] || pieces[to_of(f)] != pieces[to_of(one)]) continue;
    const bool is_near = comparable(memory, f, one);
    if (!is_near && between_m(memory, to_of(f), to_of(one)) >= options_.comparable_m) continue;
    if (!agree(memory, f, one) || (!is_near && pieces[from_of(one)] == pieces[to_of(one)])) {
      ++group.against;
      continue;
    }
    if (!is_near) continue;
    group.loops.push_back(f);
    here.add(memory.keyframes()[to_of(f)].path_m);
    there.add(memory.keyframes()[from_of(f)].path_m);
  }
  group.here_m = here.length();
  group.there_m = there.length();
  return group;
}

/// The loops that agree with the newest, where they are enough and no others speak for another place.
std::vector<RelativeFactor> LoopFinder::believed(const Memory& memory, const RelativeFactor& newest) {
  const std::vector<std::size_t> pieces = memory.pieces();
  Group group = group_of(memory, pieces, likely_, newest);
  if (group.loops.size() < options_.together || 2 * group.against >= group.loops.size()) return {};
  if (group.here_m < options_.span_m) return {};
  if (pieces[from_of(newest)] != pieces[to_of(newest)]) {
    const double length_m = std::min(group.here_m, group.there_m);
    if (length_m < options_.span_apart_m || !fit_all_over(memory, pieces, newest)) return {};
    if (!survey_for(memory, length_m / options_.surer)) {
      is_put_off_ = true;
      return {};
    }
    if (length_m < options_.surer * longest_mistake_m(memory)) return {};
    ties_.push_back({from_of(newest), to_of(newest), length_m});
  }
  return std::move(group.loops);
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
      sum += sights_of_each_other(*keyframes[k].scan, ring, *keyframes[i].scan, here.inverse() * poses[i]);
    }
  }
  return sum.contradiction() < options_.most_through_all;
}

/// The first group of loops that is believed, from the likely one `from` on; its loops are likely no longer.
std::vector<std::vector<RelativeFactor>> LoopFinder::taken(const Memory& memory, std::size_t from) {
  for (std::size_t h = from; h < likely_.size(); ++h) {
    auto group = believed(memory, likely_[h]);
    if (group.empty()) continue;
    std::erase_if(likely_, [&](const RelativeFactor& f) {
      return std::any_of(group.begin(), group.end(),
                         [&](const RelativeFactor& g) { return g.from == f.from && g.to == f.to; });
    });
    return {std::move(group)};
  }
  return {};
}

std::vector<std::vector<RelativeFactor>> LoopFinder::look(const Memory& memory, bool at_end) {
  std::vector<std::vector<RelativeFactor>> groups = mended_cuts(memory);
  if (!groups.empty()) return groups;
  surveys_left_ = at_end ? std::numeric_limits<std::size_t>::max() : options_.surveys;
  const auto& keyframes = memory.keyframes();
  while (views_.size() < memory.size() && (at_end || is_complete(memory, views_.size()))) {
    const std::size_t k = views_.size();
    views_.push_back(place_view(
        stretch_scan(memory, stretch_around(keyframes, k, options_.stretch), options_.stretch.spacing_m)));
    if (keyframes[k].path_m - sought_path_m_ < options_.every_m && !keyframes[k].cut) continue;
    sought_path_m_ = keyframes[k].path_m;
    sought_.push_back(k);
    const std::size_t before = std::exchange(is_put_off_, false) ? 0 : likely_.size();
    seek(memory, k);
    groups = taken(memory, before);
    if (!groups.empty()) return groups;  // the graph changes before the next is sought
  }
  if (at_end && std::exchange(is_put_off_, false)) groups = taken(memory, 0);
  if (!groups.empty()) return groups;
  return mended_cuts(memory);
}

}  // namespace madori::localization
