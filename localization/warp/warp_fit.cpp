#include "localization/warp/warp_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>

#include "core/angle.hpp"
#include "localization/drawing_fit/alignment.hpp"
#include "localization/drawing_fit/wall_hits.hpp"
#include "localization/warp/wall_sides.hpp"
#include "localization/warp/warp_system.hpp"

namespace madori::localization {
namespace {

constexpr int kSettling = 2;        ///< rounds with the statistics learned in between
constexpr double kLeastNats = 3.0;  ///< of evidence before a warp is believed: odds of 20 to 1
constexpr double kFreedom = 3.0;    ///< of Student's t of the offsets: some walls are drawn quite wrong
constexpr double kStretchM = 8.0;   ///< a longer wall has several offsets
constexpr double kFinestM = 2.5;    ///< spacing of control points, a fifth of the range;
constexpr double kCoarsestM = 4.0;  ///< finer costs time, coarser does not follow a bend of 15 m
constexpr double kPieceM = 1.0;     ///< surfaces of so much of a wall are one row of the normal equations
constexpr double kShortestRangeM = 8.0;
constexpr double kLongestRangeM = 40.0;
constexpr double kSteepest = 0.45;     ///< step between control points by spacing; below 0.5 nothing folds
constexpr double kPriorCount = 10.0;   ///< walls' worth of belief in the statistics of a drawing never seen
constexpr double kLeastSigmaM = 0.01;  ///< residual: no memory is more exact
constexpr double kLeastOffsetM = 0.003;
constexpr double kLeastVotes = 0.2;  ///< walls of two metres: less cannot move a wall
constexpr double kVoteM = 0.05;      ///< bins of the search for a wall that stands elsewhere
/// Of the fits that follow a growing memory so many have taken walls for their neighbours: 35 of 500 places
/// in buildings bent by 1 m, seeds 1 to 20 (tests/unit/localization/warp).
constexpr double kNeighbours = 0.07;

/// A surface that may belong to a stretch of a wall's side.
struct Pair {
  std::size_t surface;
  std::size_t wall;
  int side;
  std::size_t unit;   ///< key of the stretch
  double distance_m;  ///< as WallSides::Candidate
  double along_m;
  double odds;         ///< of direction and side
  double weight;       ///< of the surface, in observations
  double spread_m2;    ///< variance of where the warp carries the wall
  double share = 0.0;  ///< probability that the surface belongs to it
};

struct Unit {
  std::size_t key = 0;
  double offset_m = 0.0;
  double variance_m2 = 0.0;
  double precision = 0.0;  ///< of its prior
  double weight = 0.0;     ///< surfaces, as observations
};

double student_log(double offset_m, double scale_m) {
  static const double norm =
      std::lgamma(0.5 * (kFreedom + 1.0)) - std::lgamma(0.5 * kFreedom) - 0.5 * std::log(kFreedom * kPi);
  const double z = offset_m / scale_m;
  return norm - std::log(scale_m) - 0.5 * (kFreedom + 1.0) * std::log1p(z * z / kFreedom);
}
double student_weight(double offset_m, double scale_m) {
  const double z = offset_m / scale_m;
  return (kFreedom + 1.0) / (kFreedom + z * z);
}

/// Errors of a drawing persist along a wall: two metres of it are one observation, and so is a shorter wall
/// as a whole (the reveal of a door, the face of a column), of which no long straight surface is expected.
double weight_of(const CloudSurface& surface, double wall_m) {
  constexpr double kObservationM = 2.0;
  constexpr double kShortestM = 0.4;
  const double expected = std::clamp(wall_m / kObservationM, 0.1, 1.0);
  return std::min(1.0, surface.weight / expected) * kVoxelM / std::clamp(wall_m, kShortestM, kObservationM);
}

enum class Shape { Identity, Similarity, Field };

/// One explanation of the cloud: association and least squares by turns.
class Explanation {
 public:
  Explanation(const WallSides& sides, const MemoryCloud& cloud, const DrawingWarp& start, Shape shape)
      : sides_(sides), cloud_(cloud), warp_(start), shape_(shape), statistics_(start.statistics()) {
    first_key_.push_back(0);
    for (const WallSides::Line& line : sides.lines())
      first_key_.push_back(first_key_.back() + 2 * stretches(line));
    unit_of_key_.assign(first_key_.back(), -1);
    fresh_ = start == DrawingWarp();
    pivot_ = centre_of(cloud_);
  }

  /// `doubt` is how much of the warp's uncertainty the association allows for.
  void round(double doubt) {
    pair_up(doubt);
    vote();
    share_out();
    solve(doubt);
  }
  void learn_statistics();

  [[nodiscard]] const DrawingWarp& warp() const { return warp_; }
  [[nodiscard]] double nats() const;
  void try_ranges();
  [[nodiscard]] WarpFit result() const;

 private:
  [[nodiscard]] static std::size_t stretches(const WallSides::Line& line) {
    return static_cast<std::size_t>(std::max(1.0, std::round(line.length_m / kStretchM)));
  }
  [[nodiscard]] std::size_t key_of(const WallSides::Candidate& c) const {
    const WallSides::Line& line = sides_.lines()[c.wall];
    const std::size_t count = stretches(line);
    const auto at = line.length_m > 0.0
                        ? static_cast<std::size_t>(c.along_m / line.length_m * static_cast<double>(count))
                        : 0;
    return first_key_[c.wall] + 2 * std::min(at, count - 1) + static_cast<std::size_t>(c.side);
  }
  [[nodiscard]] double spread_m2(const Point2<Map>& p, double doubt) const {
    const double sigma = fresh_ ? statistics_.amplitude_m : warp_.sigma_m(p);
    return doubt * doubt * sigma * sigma;
  }
  [[nodiscard]] double odds(const Pair& pair, double offset_m) const;
  void pair_up(double doubt);
  void vote();
  void share_out();
  void solve(double doubt);
  [[nodiscard]] WarpLattice lattice() const;
  [[nodiscard]] Eigen::Vector2d normal_at(std::size_t wall, const Point2<Map>& place) const;
  [[nodiscard]] std::vector<WarpObservation> observations() const;
  void take_posterior();

  const WallSides& sides_;
  const MemoryCloud& cloud_;
  DrawingWarp warp_;
  Shape shape_;
  WarpStatistics statistics_;
  bool fresh_ = false;
  Point2<Map> pivot_;
  std::vector<Pair> pairs_;             ///< by surface
  std::vector<std::size_t> first_key_;  ///< of each wall
  std::vector<int> unit_of_key_;
  std::vector<Unit> units_;
  WarpLattice lattice_;
  std::vector<WarpObservation> rows_;
  WarpPriorWeights prior_;
  std::optional<WarpPosterior> posterior_;
};

double Explanation::odds(const Pair& pair, double offset_m) const {
  const double inliers = std::clamp(statistics_.inliers, 0.05, 0.98);
  const double variance = statistics_.residual_m * statistics_.residual_m + pair.spread_m2;
  const double r = pair.distance_m - offset_m;
  return pair.odds * inliers / (1.0 - inliers) * 2.0 * WallSides::kReachM / std::sqrt(2.0 * kPi * variance) *
         std::exp(-0.5 * r * r / variance);
}

void Explanation::pair_up(double doubt) {
  pairs_.clear();
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const CloudSurface& s = cloud_[i];
    const Transform2<Map, Base> at = warp_.map(Transform2<Building, Base>(s.x_m, s.y_m, 0.0));
    const double nx = at.cos_yaw() * s.normal_x - at.sin_yaw() * s.normal_y;
    const double ny = at.sin_yaw() * s.normal_x + at.cos_yaw() * s.normal_y;
    const double spread = spread_m2(at.translation(), doubt);
    sides_.for_each_near(at.translation(), nx, ny, [&](const WallSides::Candidate& c) {
      pairs_.push_back({i, c.wall, c.side, key_of(c), c.distance_m, c.along_m, c.odds,
                        weight_of(s, sides_.lines()[c.wall].length_m), spread});
    });
  }
}

/// Where does each stretch stand beside the warp? The best of all offsets, by the surfaces that no other wall
/// explains.
void Explanation::vote() {
  constexpr int kBins = static_cast<int>(2.0 * WallSides::kReachM / kVoteM) + 1;
  const auto bin_of = [](double d) {
    return static_cast<int>(std::lround((d + WallSides::kReachM) / kVoteM));
  };
  units_.clear();
  std::fill(unit_of_key_.begin(), unit_of_key_.end(), -1);
  std::vector<std::array<float, kBins>> votes;
  std::vector<double> spreads;
  for (std::size_t first = 0; first < pairs_.size();) {
    std::size_t last = first;
    double sum = 1.0;
    for (; last < pairs_.size() && pairs_[last].surface == pairs_[first].surface; ++last)
      sum += odds(pairs_[last], 0.0);
    for (; first < last; ++first) {
      const Pair& pair = pairs_[first];
      int& unit = unit_of_key_[pair.unit];
      if (unit < 0) {
        unit = static_cast<int>(units_.size());
        units_.push_back({pair.unit});
        votes.emplace_back();
        votes.back().fill(0.0F);
        spreads.push_back(pair.spread_m2);
      }
      const double others = (sum - 1.0 - odds(pair, 0.0)) / sum;
      votes[static_cast<std::size_t>(unit)]
           [static_cast<std::size_t>(std::clamp(bin_of(pair.distance_m), 0, kBins - 1))] +=
          static_cast<float>(pair.weight * pair.odds * (1.0 - others));
    }
  }
  const double inliers = std::clamp(statistics_.inliers, 0.05, 0.98);
  const double width = std::max(statistics_.residual_m, kVoteM);
  const double peak = inliers / (1.0 - inliers) * 2.0 * WallSides::kReachM / std::sqrt(2.0 * kPi) / width;
  std::array<double, kBins> gain{};
  for (int k = 0; k < kBins; ++k) {
    const double z = k * kVoteM / width;
    gain[static_cast<std::size_t>(k)] = std::log1p(peak * std::exp(-0.5 * z * z));
  }
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const float cast = std::accumulate(votes[u].begin(), votes[u].end(), 0.0F);
    if (cast < kLeastVotes) continue;
    const double scale = std::sqrt(statistics_.offset_m * statistics_.offset_m + spreads[u]);
    double best = -1e9;
    for (int k = 0; k < kBins; ++k) {
      const double offset = k * kVoteM - WallSides::kReachM;
      double score = student_log(offset, scale);
      for (int b = 0; b < kBins; ++b) {
        const float count = votes[u][static_cast<std::size_t>(b)];
        if (count > 0.0F) score += count * gain[static_cast<std::size_t>(std::abs(b - k))];
      }
      if (score > best) {
        best = score;
        units_[u].offset_m = offset;
      }
    }
  }
}

void Explanation::share_out() {
  for (Unit& unit : units_) unit.weight = 0.0;
  std::vector<double> own;
  for (std::size_t first = 0; first < pairs_.size();) {
    std::size_t last = first;
    double sum = 1.0;
    own.clear();
    for (; last < pairs_.size() && pairs_[last].surface == pairs_[first].surface; ++last) {
      own.push_back(
          odds(pairs_[last], units_[static_cast<std::size_t>(unit_of_key_[pairs_[last].unit])].offset_m));
      sum += own.back();
    }
    for (std::size_t k = 0; first < last; ++first, ++k) {
      pairs_[first].share = own[k] / sum;
      units_[static_cast<std::size_t>(unit_of_key_[pairs_[first].unit])].weight +=
          pairs_[first].weight * pairs_[first].share;
    }
  }
}

WarpLattice Explanation::lattice() const {
  WarpLattice made;
  if (shape_ != Shape::Field || pairs_.empty()) return made;  // nothing seen bends nothing
  const double range = statistics_.range_m;
  made.spacing_m = std::clamp(0.2 * range, kFinestM, kCoarsestM);
  Point2<Map> low{1e9, 1e9};
  Point2<Map> high{-1e9, -1e9};
  for (const Pair& pair : pairs_) {
    const Point2<Map> p = sides_.foot(pair.wall, pair.along_m);
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  const double margin = std::min(range, 10.0);
  const auto first = [&](double value) { return std::floor((value - margin) / made.spacing_m); };
  const auto count = [&](double from, double to) {
    return static_cast<int>(std::ceil((to + margin) / made.spacing_m) - first(from)) + 1;
  };
  made.origin = {first(low.x_m) * made.spacing_m, first(low.y_m) * made.spacing_m};
  made.width = count(low.x_m, high.x_m);
  made.height = count(low.y_m, high.y_m);
  return made;
}

/// The wall's left normal where the warp carries it.
Eigen::Vector2d Explanation::normal_at(std::size_t wall, const Point2<Map>& place) const {
  const WallSides::Line& line = sides_.lines()[wall];
  const double turn = warp_.turn_rad(place);
  return {-line.uy * std::cos(turn) - line.ux * std::sin(turn),
          -line.uy * std::sin(turn) + line.ux * std::cos(turn)};
}

std::vector<WarpObservation> Explanation::observations() const {
  struct Sum {
    double weight = 0.0;
    double along = 0.0;
    double x = 0.0;
    double y = 0.0;
    std::size_t wall = 0;
    int unit = 0;
  };
  std::unordered_map<std::uint64_t, std::size_t> index;
  std::vector<Sum> sums;
  for (const Pair& pair : pairs_) {
    if (pair.share < 1e-3) continue;
    const CloudSurface& s = cloud_[pair.surface];
    const double variance = statistics_.residual_m * statistics_.residual_m + pair.spread_m2;
    const double w = pair.weight * pair.share / variance;
    const auto piece = static_cast<std::uint64_t>(pair.along_m / kPieceM);
    const auto [at, fresh] =
        index.try_emplace((static_cast<std::uint64_t>(pair.unit) << 16U) | piece, sums.size());
    if (fresh) sums.push_back({0.0, 0.0, 0.0, 0.0, pair.wall, unit_of_key_[pair.unit]});
    Sum& sum = sums[at->second];
    sum.weight += w;
    sum.along += w * pair.along_m;
    sum.x += w * s.x_m;
    sum.y += w * s.y_m;
  }
  std::vector<WarpObservation> rows;
  rows.reserve(sums.size());
  for (const Sum& sum : sums) {
    WarpObservation row;
    row.unit = sum.unit;
    row.place = sides_.foot(sum.wall, sum.along / sum.weight);
    const Eigen::Vector2d normal = normal_at(sum.wall, row.place);
    row.normal_x = normal.x();
    row.normal_y = normal.y();
    row.distance_m = row.normal_x * (sum.x / sum.weight - row.place.x_m) +
                     row.normal_y * (sum.y / sum.weight - row.place.y_m);
    row.information = sum.weight;
    rows.push_back(row);
  }
  return rows;
}

void Explanation::solve(double doubt) {
  lattice_ = lattice();
  rows_ = observations();
  prior_.amplitude_m = statistics_.amplitude_m;
  prior_.range_m = statistics_.range_m;
  prior_.similarity = shape_ != Shape::Identity;
  prior_.offset_precision.clear();
  const double square = statistics_.offset_m * statistics_.offset_m;
  const double doubted = doubt * statistics_.amplitude_m;
  for (Unit& unit : units_) {
    const double scale = std::sqrt(square + (shape_ == Shape::Identity ? 0.0 : doubted * doubted));
    unit.precision = student_weight(unit.offset_m, scale) / square;
    prior_.offset_precision.push_back(unit.precision);
  }
  posterior_.emplace(lattice_, pivot_, rows_, prior_);
  for (std::size_t u = 0; u < units_.size(); ++u)
    units_[u].offset_m = posterior_->offset(static_cast<int>(u));
  take_posterior();
}

void Explanation::take_posterior() {
  const Eigen::Vector4d s = posterior_->similarity();
  WarpSimilarity similarity;
  const double c = 1.0 + s[2];
  const double d = s[3];
  similarity.scale = std::hypot(c, d);
  similarity.yaw_rad = std::atan2(d, c);
  similarity.x_m = pivot_.x_m + s[0] - (c * pivot_.x_m - d * pivot_.y_m);
  similarity.y_m = pivot_.y_m + s[1] - (d * pivot_.x_m + c * pivot_.y_m);
  if (shape_ == Shape::Identity) similarity = {};
  WarpField field;
  field.origin = lattice_.origin;
  field.spacing_m = lattice_.spacing_m;
  field.width = lattice_.width;
  field.height = lattice_.height;
  double steepest = 0.0;
  for (int p = 0; p < lattice_.nodes(); ++p) {
    const Eigen::Vector2d control = posterior_->control(p);
    field.control_m.push_back(control.x());
    field.control_m.push_back(control.y());
    if (p % lattice_.width > 0) steepest = std::max(steepest, (control - posterior_->control(p - 1)).norm());
    if (p >= lattice_.width)
      steepest = std::max(steepest, (control - posterior_->control(p - lattice_.width)).norm());
  }
  const double most = kSteepest * lattice_.spacing_m;
  if (steepest > most)
    for (double& control : field.control_m) control *= most / steepest;
  const bool had = !fresh_ && !warp_.field().sigma_m.empty();
  if (had && lattice_.nodes() > 0) {  // until inverted: what was known before
    for (int p = 0; p < lattice_.nodes(); ++p)
      field.sigma_m.push_back(warp_.sigma_m({lattice_.origin.x_m + p % lattice_.width * lattice_.spacing_m,
                                             lattice_.origin.y_m + p / lattice_.width * lattice_.spacing_m}));
  }
  warp_ = DrawingWarp(similarity, std::move(field), statistics_);
  fresh_ = fresh_ || !had;
}

void Explanation::learn_statistics() {
  posterior_->invert();
  double square = kPriorCount * 0.03 * 0.03;
  double count = kPriorCount;
  double all = kPriorCount;
  double belonging = kPriorCount * 0.6;
  double squares = 0.0;
  double seen = 0.0;
  for (std::size_t u = 0; u < units_.size(); ++u)
    units_[u].variance_m2 = posterior_->offset_variance(static_cast<int>(u));
  for (const Pair& pair : pairs_) {
    const double w = pair.weight * pair.share;
    const double offset = units_[static_cast<std::size_t>(unit_of_key_[pair.unit])].offset_m;
    const Point2<Map> foot = sides_.foot(pair.wall, pair.along_m);
    const Point2<Building> at = warp_.building(foot);
    const CloudSurface& s = cloud_[pair.surface];
    const Eigen::Vector2d normal = normal_at(pair.wall, foot);
    const double r = normal.x() * (s.x_m - at.x_m) + normal.y() * (s.y_m - at.y_m) - offset;
    squares += w * r * r;
    seen += w;
    belonging += kShareOfObservation * s.weight * pair.share;
  }
  for (const CloudSurface& s : cloud_) all += kShareOfObservation * s.weight;
  const double left = std::max(0.2 * seen, seen - posterior_->freedom());
  statistics_.residual_m = std::clamp(std::sqrt((square + squares) / (count + left)), kLeastSigmaM, 0.2);
  statistics_.inliers = std::clamp(belonging / all, 0.05, 0.98);
  double offsets = kPriorCount * 0.05 * 0.05;
  double units = kPriorCount;
  for (const Unit& unit : units_) {
    const double importance = std::min(1.0, unit.weight);  // a stretch hardly seen says little
    offsets += importance * student_weight(unit.offset_m, statistics_.offset_m) *
               (unit.offset_m * unit.offset_m + unit.variance_m2);
    units += importance;
  }
  statistics_.offset_m = std::clamp(std::sqrt(offsets / units), kLeastOffsetM, 0.3);
  if (shape_ == Shape::Field) {
    const double freedom = posterior_->field_freedom();
    statistics_.amplitude_m = std::clamp(
        std::sqrt((kPriorCount * 0.3 * 0.3 + posterior_->roughness()) / (kPriorCount + freedom)), 0.01, 1.0);
    WarpField field = warp_.field();
    field.sigma_m.clear();
    for (int p = 0; p < lattice_.nodes(); ++p)
      field.sigma_m.push_back(std::sqrt(std::max(0.0, posterior_->variance_at(p))));
    warp_ = DrawingWarp(warp_.similarity(), std::move(field), statistics_);
    fresh_ = false;
  }
}

/// The range with the greatest marginal likelihood of the present one and its neighbours.
void Explanation::try_ranges() {
  if (shape_ != Shape::Field) return;
  const auto score = [&](double range, const WarpPosterior& p) {
    const double z = std::log(range / 15.0) / 0.5;
    return p.log_marginal() - 0.5 * z * z;
  };
  double best = score(statistics_.range_m, *posterior_);
  const double present = statistics_.range_m;
  for (const double factor : {0.8, 1.25}) {
    const double range = std::clamp(present * factor, kShortestRangeM, kLongestRangeM);
    WarpPriorWeights prior = prior_;
    prior.range_m = range;
    const WarpPosterior other(lattice_, pivot_, rows_, prior);
    if (score(range, other) > best) {
      best = score(range, other);
      statistics_.range_m = range;
    }
  }
  warp_ = DrawingWarp(warp_.similarity(), warp_.field(), statistics_);
}

double Explanation::nats() const {
  double nats = posterior_->occam_nats();
  for (std::size_t first = 0; first < pairs_.size();) {
    const CloudSurface& s = cloud_[pairs_[first].surface];
    double sum = 0.0;
    std::size_t last = first;
    for (; last < pairs_.size() && pairs_[last].surface == pairs_[first].surface; ++last) {
      const Unit& unit = units_[static_cast<std::size_t>(unit_of_key_[pairs_[last].unit])];
      sum += odds(pairs_[last], unit.offset_m);
    }
    first = last;
    nats += kShareOfObservation * s.weight * std::log1p(sum);
  }
  // A unit without data must not count: its prior at zero, and its term of the determinant.
  const double none =
      student_log(0.0, 1.0) + 0.5 * std::log(2.0 * kPi) - 0.5 * std::log(student_weight(0.0, 1.0));
  for (const Unit& unit : units_)
    nats += student_log(unit.offset_m, statistics_.offset_m) + 0.5 * std::log(2.0 * kPi) - none;
  return nats;
}

WarpFit Explanation::result() const {
  WarpFit fit;
  fit.warp = warp_;
  fit.walls.resize(sides_.lines().size());
  std::vector<std::array<double, 2>> weights(fit.walls.size(), {0.0, 0.0});
  std::vector<std::array<double, 2>> near(fit.walls.size(), {0.0, 0.0});
  double squares = 0.0;
  double all = 0.0;
  for (const Pair& pair : pairs_) {
    const auto side = static_cast<std::size_t>(pair.side);
    const Unit& unit = units_[static_cast<std::size_t>(unit_of_key_[pair.unit])];
    WallSide& found = fit.walls[pair.wall].sides[side];
    const double length = kVoxelM * pair.share;
    const double w = pair.weight * pair.share;
    found.seen_m += length;
    found.offset_m += w * unit.offset_m;
    found.sigma_m += w * (unit.variance_m2 + statistics_.residual_m * statistics_.residual_m);
    weights[pair.wall][side] += w;
    if (std::abs(pair.distance_m - unit.offset_m) < 0.5) near[pair.wall][side] += kVoxelM;
    squares += w * (unit.offset_m * unit.offset_m);
    all += w;
    fit.walls_seen += w;
  }
  for (std::size_t i = 0; i < fit.walls.size(); ++i) {
    for (std::size_t side = 0; side < 2; ++side) {
      WallSide& found = fit.walls[i].sides[side];
      const double w = weights[i][side];
      const double spread =
          statistics_.offset_m * statistics_.offset_m + statistics_.residual_m * statistics_.residual_m;
      // What was seen a little counts a little: shrunk towards what is known of all walls.
      found.sigma_m = w > 0.0 ? std::sqrt(found.sigma_m / w) : std::sqrt(spread);
      found.offset_m = w > 0.0 ? found.offset_m / w : 0.0;
      found.inliers = near[i][side] > 0.0 ? std::min(1.0, found.seen_m / near[i][side]) : 0.0;
    }
  }
  fit.residual_m =
      std::sqrt(statistics_.residual_m * statistics_.residual_m + (all > 0.0 ? squares / all : 0.0));
  return fit;
}

/// What a start led to, and what that is worth by what is seen and by what was told.
struct End {
  Explanation way;
  double nats = 0.0;
  double told = 0.0;
};

/// Association and statistics by turns. Each end is compared by the statistics that it learned itself: by
/// those of before, where the drawing seemed good, a bend of a metre costs several times what it does.
End settled(Explanation way, const WarpPrior& told) {
  for (const double doubt : {1.0, 0.5}) way.round(doubt);
  for (int k = 0; k < kSettling; ++k) {
    way.round(0.0);
    way.learn_statistics();
  }
  const double nats = way.nats(), log_told = told ? told(way.warp()) : 0.0;
  return {std::move(way), nats, log_told};
}

}  // namespace

double WallDeviation::offset_m() const {
  const double seen = seen_m();
  if (seen <= 0.0) return 0.0;
  return (sides[0].seen_m * sides[0].offset_m + sides[1].seen_m * sides[1].offset_m) / seen;
}

WarpFit fit_warp(const WallIndex& drawn, const MemoryCloud& cloud, const DrawingWarp& before,
                 const std::vector<DrawingWarp>& further, const WarpPrior& told) {
  const WallSides sides(drawn.walls());
  const auto explain = [&](const DrawingWarp& start, Shape shape) {
    return settled(Explanation(sides, cloud, start, shape), told);
  };
  if (cloud.empty() || drawn.walls().empty()) {
    WarpFit none;
    none.warp = none.next = before;
    none.walls.resize(drawn.walls().size());
    return none;
  }
  End field = explain(before, Shape::Field);
  field.way.try_ranges();
  const End whole = explain(DrawingWarp(before.similarity(), {}, before.statistics()), Shape::Similarity);
  const End identity = explain(DrawingWarp({}, {}, before.statistics()), Shape::Identity);
  const auto warp_of = [&](const End& end) {
    WarpField shape = field.way.warp().field();
    if (&end != &field) std::fill(shape.control_m.begin(), shape.control_m.end(), 0.0);
    return DrawingWarp(end.way.warp().similarity(), std::move(shape), field.way.warp().statistics());
  };
  const End& bent = whole.nats + whole.told > field.nats + field.told ? whole : field;
  const double gain = bent.nats + bent.told - identity.nats - identity.told;
  const End& here = gain < kLeastNats ? identity : bent;
  std::vector<End> elsewhere;
  std::vector<double> odds;  // their logarithms, against what keeps the place as it is
  for (const DrawingWarp& start : further) {
    End first = explain(start, Shape::Field);
    // The present one was fitted again and again while the memory grew: a better one goes on before they
    // compare.
    elsewhere.push_back(first.nats > here.nats ? explain(first.way.warp(), Shape::Field) : std::move(first));
    const End& end = elsewhere.back();
    odds.push_back(kTrust * (end.nats - here.nats) + std::log(kNeighbours) + end.told - here.told);
  }
  const auto likeliest = std::max_element(odds.begin(), odds.end());
  const bool stays = likeliest == odds.end() || *likeliest < 0.0;
  const auto taken = static_cast<std::size_t>(likeliest - odds.begin());
  if (!stays) elsewhere[taken].way.try_ranges();
  const double log_taken = stays ? 0.0 : *likeliest;
  WarpFit fit = stays ? here.way.result() : elsewhere[taken].way.result();
  fit.warp = stays ? warp_of(here) : elsewhere[taken].way.warp();
  fit.next = stays ? field.way.warp() : fit.warp;
  fit.evidence_nats = stays ? gain : elsewhere[taken].nats - identity.nats;
  if (!stays) fit.others.push_back({warp_of(here), std::exp(-log_taken)});
  for (std::size_t i = 0; i < elsewhere.size(); ++i)
    if (stays || i != taken) fit.others.push_back({elsewhere[i].way.warp(), std::exp(odds[i] - log_taken)});
  return fit;
}

WarpFit fit_warp_from_start(const WallIndex& drawn, const MemoryCloud& cloud) {
  constexpr int kKeyframes = 4;  // two metres of driving
  int last = 0;
  for (const CloudSurface& s : cloud) last = std::max(last, s.keyframe);
  WarpFit fit;
  for (int until = kKeyframes; until - kKeyframes < last; until += kKeyframes) {
    MemoryCloud seen;
    std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(seen),
                 [&](const CloudSurface& s) { return s.keyframe <= until; });
    fit = fit_warp(drawn, seen, fit.next);
  }
  return fit;
}

}  // namespace madori::localization
