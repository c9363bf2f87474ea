#include "localization/placement/placement.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "localization/drawing_fit/wall_hits.hpp"
#include "localization/placement/survey.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

/// Errors that drawings have, averaged over: drawn by CAD, drawn from plans, drawn as a sketch.
constexpr std::array kDrawingSigmasM{0.05, 0.15, 0.4};
/// A drawing that was imported the wrong way round, before anything is seen.
constexpr double kMirroredDrawings = 0.1;
constexpr double kLeastMirrored = 1e-4;  // nothing that was seen excludes it
/// Poses that are given and wrong altogether: the wrong vehicle, site or button.
constexpr double kWrongPriors = 0.05;
/// A vehicle that said to be surer of its place was right in so many cases
/// (docs/reference/buildings-figures.md).
constexpr double kSurest = 0.95;
constexpr std::size_t kSurveyed = 30;  // places that are refined, and half as many of the mirror image
constexpr std::size_t kKept = 64;
constexpr double kForgotten = 1e-6;      // a hypothesis of less comes back with the next survey, if at all
constexpr std::size_t kSurfaces = 1500;  // of a large memory, so many tell as much as all
constexpr double kSameM = 0.5;           // nearer than this, and turned by less, two hypotheses are one
constexpr double kSameRad = to_rad(8.0);
constexpr double kAnyPlace = 0.1;  // who may be anywhere around a place is not at that place
constexpr double kNearRad = to_rad(10.0);
constexpr double kAroundRad = to_rad(20.0);

double log_mean_exp(const std::array<double, kDrawingSigmasM.size()>& nats) {
  const double most = *std::max_element(nats.begin(), nats.end());
  double sum = 0.0;
  for (const double n : nats) sum += std::exp(n - most);
  return most + std::log(sum / static_cast<double>(nats.size()));
}

FreeWays mirror_image(FreeWays ways) {
  for (auto* some : {&ways.beams, &ways.driven})
    for (Segment2<Map>& s : *some) s.a.x_m = -s.a.x_m, s.b.x_m = -s.b.x_m;
  return ways;
}

Transform2<Map, Base> mirror_image(const Transform2<Map, Base>& at) {
  return {-at.x_m(), at.y_m(), kPi - at.yaw_rad()};
}

Transform2<Map, Base> half_way(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b) {
  return {0.5 * (a.x_m() + b.x_m()), 0.5 * (a.y_m() + b.y_m()),
          wrap_angle(a.yaw_rad() + 0.5 * wrap_angle(b.yaw_rad() - a.yaw_rad()))};
}

/// Chance that a normal variable of this sigma lies within +-limit.
double within(double limit, double sigma) {
  return std::erf(limit / (sigma * std::sqrt(2.0)));
}

/// Every n-th surface, each standing for n.
MemoryCloud sampled(const MemoryCloud& cloud, std::size_t most) {
  const std::size_t stride = cloud.size() / most + 1;
  MemoryCloud sample;
  for (std::size_t i = 0; i < cloud.size(); i += stride) {
    sample.push_back(cloud[i]);
    sample.back().weight *= static_cast<double>(stride);
  }
  return sample;
}

/// Share of the cloud's weight on drawn walls.
double share_explained(const WallIndex& index, const MemoryCloud& cloud,
                       const Transform2<Map, Map>& correction, const WallMixture& mixture) {
  double all = 1e-9;
  double on_walls = 0.0;
  for (const CloudSurface& p : cloud) all += p.weight;
  for_each_hit(index, cloud, correction, [&](const CloudSurface& p, const auto&, const auto& hit) {
    on_walls += p.weight * mixture.is_wall(hit);
  });
  return on_walls / all;
}

/// How well the cloud holds the vehicle's pose (x, y, yaw) where a placement puts it: its Hessian.
Eigen::Matrix3d hold_of(const WallIndex& index, const MemoryCloud& cloud,
                        const Transform2<Map, Map>& correction, const Point2<Map>& vehicle,
                        const WallMixture& mixture, double sigma_m) {
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for_each_hit(index, cloud, correction, [&](const CloudSurface& p, const auto& q, const auto& hit) {
    const double information = p.weight * kShareOfObservation * mixture.is_wall(hit);
    const Eigen::Vector3d j = jacobian(hit, q, vehicle);
    h += kTrust * information / (sigma_m * sigma_m) * j * j.transpose();
  });
  return h;
}

/// Chance that the vehicle is within these of where a placement puts it.
double share_within(const Eigen::Matrix3d& hold, double m, double rad) {
  const Eigen::Matrix3d covariance = hold.inverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(covariance.topLeftCorner<2, 2>());
  return within(m, std::sqrt(axes.eigenvalues()[1])) * within(rad, std::sqrt(covariance(2, 2)));
}

/// Density of a pose that was given rightly, and of one that was not, 1/(m^2 rad).
struct PriorDensity {
  double right = 0.0;
  double wrong = 0.0;
};

double normal(const Transform2<Map, Base>& pose, const Transform2<Map, Base>& mean, double m, double rad) {
  const double d = distance_m(pose.translation(), mean.translation()) / m;
  const double a = wrap_angle(pose.yaw_rad() - mean.yaw_rad()) / rad;
  return std::exp(-0.5 * (d * d + a * a)) / (std::pow(2.0 * kPi, 1.5) * m * m * rad);
}

/// The person is right and the vehicle was not, the other way round, or neither.
PriorDensity density(const StartPrior& prior, const Transform2<Map, Base>& first, double area_m2) {
  const double vehicle = prior.former ? std::min(prior.former->probability, kSurest) : 0.0;
  const double known =
      vehicle > 0.0 ? normal(first, prior.former->map_from_base, 0.5 * kNearM, 0.5 * kNearRad) : 0.0;
  return {(1.0 - kWrongPriors) * (1.0 - vehicle) *
              normal(first, prior.map_from_base, prior.sigma_m, prior.sigma_rad),
          kWrongPriors * (vehicle * known + (1.0 - vehicle) / (2.0 * kPi * area_m2))};
}

}  // namespace

double log_prior(const StartPrior& prior, const Transform2<Map, Base>& first, double area_m2) {
  const PriorDensity p = density(prior, first, area_m2);
  return std::log(p.right + p.wrong);
}

double prior_holds(const StartPrior& prior, const Transform2<Map, Base>& first, double area_m2) {
  const PriorDensity p = density(prior, first, area_m2);
  return p.right / (p.right + p.wrong);
}

PlaceBelief::PlaceBelief(const mapping::Walls& walls)
    : walls_(std::make_shared<const mapping::DistanceField>(walls)),
      log_mirrored_(std::log(kMirroredDrawings)) {
  const mapping::GridFrame& frame = walls_->frame();
  area_m2_ = frame.width * frame.cell_m * (frame.height * frame.cell_m);
}

/// What is remembered, or its mirror image.
struct PlaceBelief::Seen {
  MemoryCloud cloud;
  WallPieces pieces;
  FreeWays ways;
  Transform2<Map, Base> first, at;  ///< the vehicle at the beginning, and now
};

void PlaceBelief::judge(const DrawingFit& fit, const Seen& seen, const std::optional<StartPrior>& prior,
                        Placement& placement) const {
  std::array<double, kDrawingSigmasM.size()> nats{};
  const DrawingModel plain;
  for (std::size_t i = 0; i < nats.size(); ++i)
    nats[i] =
        log_likelihood(fit.index(), seen.cloud, placement.correction, WallMixture(plain, kDrawingSigmasM[i]));
  const auto best = static_cast<std::size_t>(std::max_element(nats.begin(), nats.end()) - nats.begin());
  const double sigma = kDrawingSigmasM[best];
  const WallMixture mixture(plain, sigma);
  placement.explained = share_explained(fit.index(), seen.cloud, placement.correction, mixture);
  Eigen::Matrix3d hold = hold_of(fit.index(), seen.cloud, placement.correction,
                                 placement.correction * seen.at.translation(), mixture, sigma);
  hold.diagonal() += Eigen::Vector3d(1.0 / area_m2_, 1.0 / area_m2_, 0.1);  // the drawing is finite
  if (prior) hold += prior_holds(*prior, placement.correction * seen.first, area_m2_) * prior->information();
  placement.near = share_within(hold, kNearM, kNearRad);
  placement.around = share_within(hold, kAroundM, kAroundRad);
  placement.votes = votes_at(fit.index(), seen.cloud, seen.pieces, placement.correction, mixture);
  placement.votes.crossed_nats = nats_of_crossed_walls(seen.ways, placement.correction, *walls_, fit.index());
  placement.nats = log_mean_exp(nats) - placement.votes.crossed_nats + placement.log_prior;
}

void PlaceBelief::weigh(const DrawingFit& fit, const Memory& memory, const MemoryCloud& all,
                        const std::optional<StartPrior>& prior, const Transform2<Map, Base>& at,
                        bool everywhere, const std::vector<Transform2<Map, Base>>& proposed) {
  Seen seen{sampled(all, kSurfaces), {}, free_ways(memory), memory.poses().front(), at};
  seen.pieces = wall_pieces(seen.cloud);
  const Seen mirrored{mirror_image(seen.cloud), seen.pieces, mirror_image(seen.ways),
                      mirror_image(seen.first), mirror_image(at)};
  std::vector<Placement> found{{}};
  for (const Placement& p : placements_)
    if (p.probability > kForgotten) found.push_back(p);
  const std::size_t known = found.size();  // they stay where they are as well as go where they are drawn to
  for (std::size_t i = 0; i < known; ++i) found.push_back(found[i]);
  if (prior) found.push_back({prior->map_from_base * memory.poses().front().inverse()});
  if (prior && prior->former)
    found.push_back({prior->former->map_from_base * memory.poses().front().inverse()});
  for (const auto& place : proposed) found.push_back({place * at.inverse()});
  if (everywhere) {
    for (const auto& correction : survey(fit.index(), seen.cloud, at, kSurveyed))
      found.push_back({correction});
    for (const auto& correction : survey(fit.index(), mirrored.cloud, mirrored.at, kSurveyed / 2)) {
      found.push_back({correction});
      found.back().mirrored = true;
    }
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    Placement& p = found[i];
    const Seen& view = p.mirrored ? mirrored : seen;
    p.correction = fit.settle(view.cloud, p.correction, i < known).correction;
    p.log_prior = -std::log(2.0 * kPi * area_m2_);
    if (p.mirrored)
      p.log_prior += log_mirrored_;
    else if (prior)
      p.log_prior = log_prior(*prior, p.correction * seen.first, area_m2_);
    judge(fit, view, p.mirrored ? std::nullopt : prior, p);
  }
  share_out(std::move(found), seen, mirrored);
}

/// One hypothesis a place; the belief goes by the votes against the one that fits best.
void PlaceBelief::share_out(std::vector<Placement> found, const Seen& seen, const Seen& mirrored) {
  const auto place_of = [&](const Placement& p) {
    return p.correction * (p.mirrored ? mirrored.at : seen.at);
  };
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.nats > b.nats; });
  placements_.clear();
  for (const Placement& p : found) {
    const bool known = std::any_of(placements_.begin(), placements_.end(), [&](const Placement& k) {
      return k.mirrored == p.mirrored && same_place(place_of(p), place_of(k), kSameM, kSameRad);
    });
    if (known || placements_.size() == kKept) continue;
    placements_.push_back(p);
  }
  double sum = 0.0;
  for (Placement& p : placements_) {
    const Placement& best = placements_.front();
    p.probability = std::exp(log_odds(p.votes, best.votes) + p.log_prior - best.log_prior);
    sum += p.probability;
  }
  for (Placement& p : placements_) p.probability /= sum;
  std::stable_sort(placements_.begin(), placements_.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

void PlaceBelief::forget() {
  if (!placements_.empty())
    log_mirrored_ = std::min(log_mirrored_, std::log(std::max(kLeastMirrored, probability_mirrored())));
  placements_.clear();
}

void PlaceBelief::exclude_mirror() {
  log_mirrored_ = std::log(kLeastMirrored);
}

void PlaceBelief::moved(const Transform2<Map, Map>& by) {
  for (Placement& p : placements_)
    if (!p.mirrored) p.correction = p.correction * by.inverse();
}

double PlaceBelief::probability_within(const Transform2<Map, Base>& at, const Transform2<Map, Base>& place,
                                       double m, double rad, double Placement::*share) const {
  double sum = 0.0;
  for (const Placement& p : placements_)
    if (!p.mirrored && same_place(p.correction * at, place, m, rad)) sum += p.probability * p.*share;
  return sum;
}

double PlaceBelief::probability_near(const Transform2<Map, Base>& at,
                                     const Transform2<Map, Base>& place) const {
  return probability_within(at, place, kNearM, kNearRad, &Placement::near);
}

double PlaceBelief::probability_around(const Transform2<Map, Base>& at,
                                       const Transform2<Map, Base>& place) const {
  return probability_within(at, place, kAroundM, kAroundRad, &Placement::around);
}

Transform2<Map, Base> PlaceBelief::middle_around(const Transform2<Map, Base>& at, bool wide) const {
  const Transform2<Map, Base> near = mean_around(at, 1.0);
  if (!wide) return near;
  // Whatever lies within 1 m of one middle lies within 2 m of each of them. Where the mean is too near to one
  // of several ways, half way between two of them another may hold all.
  const std::vector<Way> ways = ways_around(at, 2.0);
  std::vector middles{near, mean_around(at, 2.0), at};
  for (std::size_t i = 0; i < ways.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) middles.push_back(half_way(ways[i].there, ways[k].there));
  return *std::ranges::max_element(
      middles, {}, [&](const Transform2<Map, Base>& middle) { return probability_around(at, middle); });
}

std::vector<PlaceBelief::Way> PlaceBelief::ways_around(const Transform2<Map, Base>& at, double scale) const {
  std::vector<Way> ways;
  for (const Placement& p : placements_)
    if (const Way way{p.correction * at, p.probability};
        !p.mirrored && same_place(way.there, at, scale * kAroundM, scale * kAroundRad))
      ways.push_back(way);
  return ways;
}

Transform2<Map, Base> PlaceBelief::mean_around(const Transform2<Map, Base>& at, double scale) const {
  double sum = 0.0, x_m = 0.0, y_m = 0.0, turn_rad = 0.0;
  for (const auto& [there, probability] : ways_around(at, scale)) {
    sum += probability;
    x_m += probability * (there.x_m() - at.x_m());
    y_m += probability * (there.y_m() - at.y_m());
    turn_rad += probability * wrap_angle(there.yaw_rad() - at.yaw_rad());
  }
  if (!(sum > 0.0)) return at;
  return {at.x_m() + x_m / sum, at.y_m() + y_m / sum, wrap_angle(at.yaw_rad() + turn_rad / sum)};
}

std::optional<Placement> PlaceBelief::best() const {
  for (const Placement& p : placements_)
    if (!p.mirrored && p.near > kAnyPlace) return p;
  return std::nullopt;
}

double PlaceBelief::probability_elsewhere(const Transform2<Map, Base>& at) const {
  for (const Placement& p : placements_)
    if (!p.mirrored && !same_place(p.correction * at, at, kNearM, kNearRad)) return p.probability;
  return 0.0;
}

double PlaceBelief::probability_mirrored() const {
  double sum = 0.0;
  for (const Placement& p : placements_) sum += p.mirrored ? p.probability : 0.0;
  return sum;
}

}  // namespace madori::localization
