#include "localization/global/global_localizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "localization/global/circular_match.hpp"
#include "localization/health/reasons.hpp"
#include "localization/particle_filter/beam_path.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// The coarse field forgives what half a grid spacing and half a section put a pose off.
BeamModel coarse_model(BeamModel model) {
  model.hit_sigma_m = std::max(0.25, model.hit_sigma_m);
  return model;
}

bool same_place(const Pose& a, const Pose& b, double limit_m, double limit_rad) {
  return distance_m(a.translation(), b.translation()) < limit_m &&
         std::abs(wrap_angle(a.yaw_rad() - b.yaw_rad())) < limit_rad;
}

constexpr double kBeamsThatErrTogether = 12.0;

/// Neighbouring beams err together: a scan of few is worth fewer than the model's.
double effective_beams(const BeamBlocks& beams, const LikelihoodField& field) {
  return std::min(field.model().effective_beams, static_cast<double>(beams.beams()) / kBeamsThatErrTogether);
}

/// A place and a turn of the index.
struct Cell {
  std::uint32_t place;
  std::uint32_t turn;
};

/// About `wanted` cells of the lowest costs, each the best or second-best (not adjacent) turn of its place.
std::vector<Cell> cheapest(const std::vector<std::uint16_t>& costs, std::size_t places, std::size_t wanted) {
  constexpr int kTurns = PlaceIndex::kSections;
  std::vector<std::pair<std::uint16_t, Cell>> best;
  best.reserve(2 * places);
  for (std::size_t p = 0; p < places; ++p) {
    const std::uint16_t* row = costs.data() + p * kTurns;
    const auto first = static_cast<int>(std::min_element(row, row + kTurns) - row);
    int second = -1;
    for (int t = 0; t < kTurns; ++t) {
      const int apart = std::min((t - first + kTurns) % kTurns, (first - t + kTurns) % kTurns);
      if (apart > 2 && (second < 0 || row[t] < row[second])) second = t;
    }
    for (const int turn : {first, second})
      best.push_back({row[turn], {static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(turn)}});
  }
  const std::size_t kept = std::min(wanted, best.size());
  const auto by_cost = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::nth_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(kept), best.end(), by_cost);
  std::vector<Cell> cells(kept);
  for (std::size_t i = 0; i < kept; ++i) cells[i] = best[i].second;
  return cells;
}

constexpr std::array kSides{-1.0, 0.0, 1.0};
constexpr std::size_t kAround = kSides.size() * kSides.size() * kSides.size();

/// Poses in the neighbourhood of every cell, kAround a cell.
Particles around(const PlaceIndex& index, const std::vector<Cell>& cells) {
  const double section = 2.0 * kPi / PlaceIndex::kSections;
  const double step = index.options().spacing_m / 3.0;
  Particles poses;
  poses.origin = index.places().front();
  for (const auto& [place, turn] : cells)
    for (const double turned : kSides)
      for (const double up : kSides)
        for (const double right : kSides) {
          const Point2<Map>& p = index.places()[place];
          poses.add({p.x_m + right * step, p.y_m + up * step, turn * section + turned * section / 3.0}, 0.0);
        }
  return poses;
}

/// The best pose of every cell by falling sums, none like one before, `wanted` at most.
std::vector<Pose> largest_distinct(const Particles& poses, const std::vector<std::uint32_t>& sums,
                                   std::size_t wanted, double same_m, double same_rad) {
  std::vector<std::size_t> best(poses.size() / kAround);
  for (std::size_t cell = 0; cell < best.size(); ++cell) {
    const auto first = sums.begin() + static_cast<std::ptrdiff_t>(cell * kAround);
    best[cell] = static_cast<std::size_t>(std::max_element(first, first + kAround) - sums.begin());
  }
  std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) { return sums[a] > sums[b]; });
  std::vector<Pose> chosen;
  for (const std::size_t i : best) {
    const Pose pose = poses.pose(i);
    const bool known = std::any_of(chosen.begin(), chosen.end(),
                                   [&](const Pose& c) { return same_place(c, pose, same_m, same_rad); });
    if (!known) chosen.push_back(pose);
    if (chosen.size() == wanted) break;
  }
  return chosen;
}

/// The hypotheses by falling likelihood, none like one before.
std::vector<Hypothesis> distinct(std::vector<Hypothesis> all, double same_m, double same_rad) {
  std::sort(all.begin(), all.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_likelihood > b.log_likelihood; });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : all)
    if (std::none_of(kept.begin(), kept.end(), [&](const Hypothesis& k) {
          return same_place(k.fit.map_from_base, h.fit.map_from_base, same_m, same_rad);
        }))
      kept.push_back(h);
  return kept;
}

/// Starts beside the likeliest hypotheses: a wall has two faces, and a scan that lies on the wrong ones is a
/// local optimum as far off as the wall is thick.
std::vector<Pose> other_faces(const std::vector<Hypothesis>& hypotheses) {
  constexpr std::size_t kHypotheses = 3;
  constexpr int kDirections = 8;
  std::vector<Pose> starts;
  for (std::size_t i = 0; i < std::min(kHypotheses, hypotheses.size()); ++i)
    for (const double thickness_m : {0.15, 0.3})
      for (int k = 0; k < kDirections; ++k) {
        const Pose& pose = hypotheses[i].fit.map_from_base;
        const double angle = 2.0 * kPi * k / kDirections;
        starts.emplace_back(pose.x_m() + thickness_m * std::cos(angle),
                            pose.y_m() + thickness_m * std::sin(angle), pose.yaw_rad());
      }
  return starts;
}

}  // namespace

const char* to_string(GlobalState state) {
  switch (state) {
    case GlobalState::Found:
      return "FOUND";
    case GlobalState::Ambiguous:
      return "AMBIGUOUS";
    case GlobalState::Nowhere:
      return "NOWHERE";
  }
  return "NOWHERE";
}

GlobalLocalizer::GlobalLocalizer(const mapping::Walls& walls, const GlobalOptions& options,
                                 std::optional<PlaceIndex> index, const BeamModel& model)
    : options_(options),
      distance_(walls),
      grid_(walls),
      coarse_(walls, coarse_model(model), 0.1),
      fine_(walls, model),
      index_(index ? std::move(*index) : PlaceIndex(walls, distance_)) {}

std::vector<Pose> GlobalLocalizer::candidates(const ScanPoints& points) const {
  if (index_.size() == 0 || points.empty()) return {};
  const PlaceIndex::View view = index_.view(points);
  std::vector<std::uint16_t> costs(index_.size() * PlaceIndex::kSections);
  const auto most = static_cast<std::uint8_t>(index_.options().unlike_m / index_.m_per_count());
  circular_match(view.data(), index_.views().data(), index_.size(), most, costs.data());
  const Particles poses = around(index_, cheapest(costs, index_.size(), options_.candidates));
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, BeamBlocks(points, coarse_, 96), coarse_, sums);
  constexpr double kApart = 0.25;  // candidates nearer than this register to the same place anyhow
  constexpr double kApartRad = 0.15;
  return largest_distinct(poses, sums, options_.refined, kApart, kApartRad);
}

double scan_noise_m(const ScanPoints& points) {
  constexpr double kNear = 1.0;
  constexpr std::size_t kLeast = 30;
  constexpr double kMedianOfRayleigh = 1.1774;
  std::vector<double> off;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Point2<Base> before = points.point(i - 1);
    const Point2<Base> after = points.point(i + 1);
    if (distance_m(before, after) > kNear) continue;
    off.push_back(distance_m(points.point(i),
                             Point2<Base>{0.5 * (before.x_m + after.x_m), 0.5 * (before.y_m + after.y_m)}));
  }
  if (off.size() < kLeast) return 0.0;
  const auto middle = off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2);
  std::nth_element(off.begin(), middle, off.end());
  return *middle / (kMedianOfRayleigh * std::sqrt(1.5));
}

void GlobalLocalizer::weigh(const ScanPoints& points, double noise_m,
                            std::vector<Hypothesis>& hypotheses) const {
  const LikelihoodField& field = noise_m > fine_.model().hit_sigma_m ? coarse_ : fine_;
  Particles poses;
  poses.origin = hypotheses.front().fit.map_from_base.translation();
  for (const Hypothesis& h : hypotheses) poses.add(h.fit.map_from_base, 0.0);
  const BeamBlocks beams(points, field);
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, beams, field, sums);
  const double effective = effective_beams(beams, field);
  const double per_count = log_likelihood_per_count(beams, field) * effective / field.model().effective_beams;
  BeamPathOptions path;
  path.end_margin_m = std::max(path.end_margin_m, 3.0 * noise_m);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    Hypothesis& h = hypotheses[i];
    h.through_walls = share_through_walls(points, distance_, h.fit.map_from_base, path);
    h.log_likelihood = per_count * sums[i] - options_.through_wall_nats * effective * h.through_walls;
  }
}

std::vector<Hypothesis> GlobalLocalizer::registered(const ScanPoints& points, double noise_m,
                                                    const std::vector<Pose>& poses,
                                                    SegmentIcpOptions icp) const {
  icp.last_scale_m = std::max(icp.last_scale_m, 1.5 * noise_m);
  icp.inlier_distance_m = std::max(icp.inlier_distance_m, 2.5 * noise_m);
  std::vector<Hypothesis> all;
  for (const Pose& pose : poses) {
    const RegistrationResult fit = segment_icp(points, grid_, pose, icp);
    if (fit.map_from_base.is_finite()) all.push_back({fit});
  }
  if (!all.empty()) weigh(points, noise_m, all);
  return all;
}

std::vector<Hypothesis> GlobalLocalizer::refine(const ScanPoints& points,
                                                const std::vector<Pose>& poses) const {
  const double noise = scan_noise_m(points);
  const double same_m = std::max(options_.same_m, noise);
  std::vector<Hypothesis> best =
      distinct(registered(points, noise, poses, options_.icp), same_m, options_.same_rad);
  SegmentIcpOptions narrow = options_.icp;
  narrow.first_scale_m = 0.15;
  const std::vector<Hypothesis> beside = registered(points, noise, other_faces(best), narrow);
  best.insert(best.end(), beside.begin(), beside.end());
  return distinct(std::move(best), same_m, options_.same_rad);
}

GlobalAnswer GlobalLocalizer::answer(std::vector<Hypothesis> hypotheses) const {
  GlobalAnswer answer;
  answer.hypotheses = std::move(hypotheses);
  auto& all = answer.hypotheses;
  if (all.empty()) {
    answer.reason = reason::kNothingToSearch.english;
    return answer;
  }
  std::sort(all.begin(), all.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_likelihood > b.log_likelihood; });
  double sum = 0.0;
  for (const Hypothesis& h : all) sum += std::exp(h.log_likelihood - all.front().log_likelihood);
  for (Hypothesis& h : all) h.probability = std::exp(h.log_likelihood - all.front().log_likelihood) / sum;
  const Hypothesis& best = all.front();
  const double lead = all.size() > 1 ? best.log_likelihood - all[1].log_likelihood : options_.clear_nats;
  const bool is_clear = best.fit.inlier_fraction >= options_.well_explained && lead >= options_.clear_nats;
  if (best.fit.inlier_fraction < options_.least_explained) {
    answer.reason = reason::kNoPlace.english;
  } else if (best.through_walls > options_.most_through) {
    answer.reason = reason::kThroughWalls.english;
  } else if (best.probability < options_.certain) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kTwoAlike.english;
  } else if (best.fit.inlier_fraction < options_.well_explained && lead < options_.clear_nats) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kMuchUndrawn.english;
  } else if (best.through_walls > options_.doubtful_through && !is_clear) {
    answer.state = GlobalState::Ambiguous;
    answer.reason = reason::kThroughSomeWalls.english;
  } else {
    answer.state = GlobalState::Found;
  }
  return answer;
}

double GlobalLocalizer::lead_of_nearby(const ScanPoints& points, const Pose& map_from_base) const {
  constexpr int kSteps = 6;  // of a third of a metre: within the coarse field's reach
  constexpr double kStepM = 0.33;
  constexpr int kTurns = 3;
  constexpr double kTurnRad = 0.07;
  Particles poses;
  poses.origin = map_from_base.translation();
  poses.add(map_from_base, 0.0);
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; ++j)
      for (int k = -kTurns; k <= kTurns; ++k)
        poses.add({map_from_base.x_m() + i * kStepM, map_from_base.y_m() + j * kStepM,
                   map_from_base.yaw_rad() + k * kTurnRad},
                  0.0);
  const BeamBlocks beams(points, coarse_, 96);
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, beams, coarse_, sums);
  const std::uint32_t best = *std::max_element(sums.begin(), sums.end());
  return log_likelihood_per_count(beams, coarse_) * effective_beams(beams, coarse_) /
         coarse_.model().effective_beams * (best - sums.front());
}

GlobalAnswer GlobalLocalizer::judge(const ScanPoints& points, const std::vector<Pose>& poses) const {
  return answer(refine(points, poses));
}

GlobalAnswer GlobalLocalizer::locate(const ScanPoints& points) const {
  return judge(points, candidates(points));
}

GlobalAnswer GlobalLocalizer::locate(const ScanPoints& points, const GlobalAnswer& before,
                                     const Transform2<Base, Base>& moved) const {
  constexpr double kCarried = 0.5;  // farther off than odometry errs between two scans
  constexpr double kCarriedRad = 0.15;
  constexpr double kRemembered = 1e-3;  // hypotheses below this probability are dropped
  std::vector<Pose> poses;
  std::vector<double> prior;
  double least = 0.0;
  for (const Hypothesis& h : before.hypotheses) {
    if (h.probability < kRemembered) continue;
    poses.push_back(h.fit.map_from_base * moved);
    prior.push_back(std::log(h.probability));
    least = std::min(least, prior.back());
  }
  for (const Pose& fresh : candidates(points)) poses.push_back(fresh);
  std::vector<Hypothesis> hypotheses = refine(points, poses);
  for (Hypothesis& h : hypotheses) {
    double carried = least + std::log(kRemembered);  // a place that nothing spoke for until now
    for (std::size_t i = 0; i < prior.size(); ++i)
      if (same_place(h.fit.map_from_base, poses[i], kCarried, kCarriedRad))
        carried = std::max(carried, prior[i]);
    h.log_likelihood += carried;
  }
  return answer(std::move(hypotheses));
}

}  // namespace madori::localization
