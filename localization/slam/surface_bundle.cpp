#include "localization/slam/surface_bundle.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>

#include "localization/localizer/pose_covariance.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

constexpr double kPieceLengthM = 0.3;       // of a piece of surface at the least, and in sigmas of the noise:
constexpr double kPieceLengthSigmas = 2.0;  // what its points are averaged over
constexpr double kStartReachM = 0.5;        // how far from its surface a point may start at the least,
constexpr double kStartSigmas = 4.0;        // and in sigmas of the noise;
constexpr double kEndSigmas = 2.5;          // the same in the end: scale of the Geman-McClure loss
constexpr double kShrinkARound = 0.7;       // of that reach
constexpr int kBundleRounds = 14;
constexpr double kMostSpread = 1.2;    // of a piece's points about its line, in sigmas: wider is a corner
constexpr double kFewestPoints = 8.0;  // of a piece of surface
constexpr double kBeamsAPoint = 0.2;   // neighbouring points share errors: a point tells as much as this many

/// What lies where, by square cells.
class Cells {
 public:
  explicit Cells(double side_m) : side_m_(side_m) {}
  void add(const Point2<Map>& p, std::uint32_t what) {
    cells_[key(cell(p.x_m), cell(p.y_m))].push_back(what);
  }
  /// All that is in the cell of `p` and those around it.
  template <class Visit>
  void around(const Point2<Map>& p, const Visit& visit) const {
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const auto at = cells_.find(key(cell(p.x_m) + dx, cell(p.y_m) + dy)); at != cells_.end())
          for (const std::uint32_t what : at->second) visit(what);
  }

 private:
  [[nodiscard]] int cell(double m) const { return static_cast<int>(std::floor(m / side_m_)); }
  static std::uint64_t key(int ix, int iy) {
    return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(ix)) << 32U) |
           static_cast<std::uint32_t>(iy);
  }
  double side_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

struct Blot {
  Point2<Map> at;  ///< mean of the points in a small cell
  double weight = 0.0;
};

/// Means of the points in square cells, in the cells' order.
std::vector<Blot> blots(const std::vector<Blot>& of, double side_m) {
  std::map<std::pair<int, int>, Blot> cells;
  for (const Blot& b : of) {
    Blot& sum = cells[{static_cast<int>(std::floor(b.at.x_m / side_m)),
                       static_cast<int>(std::floor(b.at.y_m / side_m))}];
    sum.at = {sum.at.x_m + b.weight * b.at.x_m, sum.at.y_m + b.weight * b.at.y_m};
    sum.weight += b.weight;
  }
  std::vector<Blot> means;
  for (const auto& [cell, sum] : cells)
    means.push_back({{sum.at.x_m / sum.weight, sum.at.y_m / sum.weight}, sum.weight});
  return means;
}

/// A piece of surface: a line through `at`.
struct Piece {
  Point2<Map> at;
  double normal_x = 0.0, normal_y = 0.0;
  double weight = 0.0;

  [[nodiscard]] double across(const Point2<Map>& p) const {
    return (p.x_m - at.x_m) * normal_x + (p.y_m - at.y_m) * normal_y;
  }
  [[nodiscard]] double along(const Point2<Map>& p) const {
    return (p.y_m - at.y_m) * normal_x - (p.x_m - at.x_m) * normal_y;
  }
};

/// One step of a piece towards the ridge: total least squares within a window that is longer than wide, and
/// moves across the surface only. False where there are too few points for a line.
bool step_to_ridge(Piece& piece, const std::vector<Blot>& cloud, const Cells& cells, double length_m,
                   double width_m, double least_points) {
  const bool is_turned = piece.normal_x != 0.0 || piece.normal_y != 0.0;
  double w_sum = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  cells.around(piece.at, [&](std::uint32_t i) {
    const double dx = cloud[i].at.x_m - piece.at.x_m, dy = cloud[i].at.y_m - piece.at.y_m;
    const double u = is_turned ? piece.along(cloud[i].at) / length_m : dx / length_m;
    const double v = is_turned ? piece.across(cloud[i].at) / width_m : dy / length_m;
    const double w = cloud[i].weight * std::exp(-0.5 * (u * u + v * v));
    w_sum += w, x += w * dx, y += w * dy, xx += w * dx * dx, xy += w * dx * dy, yy += w * dy * dy;
  });
  piece.weight = w_sum;
  if (w_sum < least_points) return false;
  x /= w_sum, y /= w_sum;
  xx = xx / w_sum - x * x, xy = xy / w_sum - x * y, yy = yy / w_sum - y * y;
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  piece.normal_x = -std::sin(direction);
  piece.normal_y = std::cos(direction);
  const double off = x * piece.normal_x + y * piece.normal_y;
  piece.at = {piece.at.x_m + off * piece.normal_x, piece.at.y_m + off * piece.normal_y};
  return std::hypot(0.5 * (xx - yy), xy) > 0.1 * (xx + yy);  // longer than thick, by what the window leaves
}

/// Ridges of the cloud, at about `length_m` from each other, strongest first.
std::vector<Piece> ridges(const std::vector<Blot>& points, double length_m, double width_m,
                          double least_points) {
  constexpr int kSteps = 5;
  const std::vector<Blot> cloud = blots(points, 0.2 * std::min(length_m, width_m));
  Cells cells(2.5 * std::max(length_m, width_m));
  for (std::uint32_t i = 0; i < cloud.size(); ++i) cells.add(cloud[i].at, i);
  std::vector<Piece> found;
  for (const Blot& seed : blots(points, 0.7 * length_m)) {
    Piece piece{seed.at};
    bool is_line = true;
    for (int k = 0; k < kSteps && is_line; ++k)
      is_line = step_to_ridge(piece, cloud, cells, length_m, width_m, least_points);
    if (is_line) found.push_back(piece);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
  std::vector<Piece> apart;
  Cells taken(length_m);
  for (const Piece& piece : found) {
    bool is_new = true;
    taken.around(piece.at, [&](std::uint32_t k) {
      is_new &= std::abs(apart[k].across(piece.at)) > 0.5 * width_m ||
                std::abs(apart[k].along(piece.at)) > 0.6 * length_m ||
                std::abs(apart[k].normal_x * piece.normal_x + apart[k].normal_y * piece.normal_y) < 0.8;
    });
    if (!is_new) continue;
    taken.add(piece.at, static_cast<std::uint32_t>(apart.size()));
    apart.push_back(piece);
  }
  return apart;
}

/// What the points of one scan say of one piece: sums of the Gauss-Newton terms.
struct Saying {
  Eigen::Matrix3d pose = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> both = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d line = Eigen::Matrix2d::Zero();
  Eigen::Vector3d pose_pull = Eigen::Vector3d::Zero();
  Eigen::Vector2d line_pull = Eigen::Vector2d::Zero();
  double squares_m2 = 0.0;  ///< of the distances from the line, and how many
  double points = 0.0;
};
using Heard = std::vector<std::pair<std::uint32_t, Saying>>;  ///< of one piece, by the scans in their order

/// Every point draws at the piece that it lies nearest to.
std::vector<Heard> listen(const std::vector<ScanPoints>& scans, const std::vector<Pose>& poses,
                          const std::vector<Piece>& pieces, double length_m, double scale_m) {
  const double reach_m = 2.0 * scale_m;
  Cells cells(std::max(reach_m, length_m));
  for (std::uint32_t k = 0; k < pieces.size(); ++k) cells.add(pieces[k].at, k);
  std::vector<Heard> heard(pieces.size());
  for (std::uint32_t s = 0; s < scans.size(); ++s)
    for (std::size_t i = 0; i < scans[s].size(); ++i) {
      const Point2<Map> p = poses[s] * scans[s].point(i);
      double least = reach_m;
      const Piece* nearest = nullptr;
      cells.around(p, [&](std::uint32_t k) {
        const double beyond = std::max(0.0, std::abs(pieces[k].along(p)) - 0.5 * length_m);
        const double off = std::hypot(pieces[k].across(p), 3.0 * beyond);
        if (off < least) least = off, nearest = &pieces[k];
      });
      if (nearest == nullptr) continue;
      const double r = nearest->across(p);
      const double ratio = 1.0 + r * r / (scale_m * scale_m);
      const double w = scans[s].weight_of(i) / (ratio * ratio);
      const Eigen::Vector3d j(
          nearest->normal_x, nearest->normal_y,
          nearest->normal_y * (p.x_m - poses[s].x_m()) - nearest->normal_x * (p.y_m - poses[s].y_m()));
      const Eigen::Vector2d l(-1.0, -nearest->along(p));
      Heard& of_piece = heard[static_cast<std::size_t>(nearest - pieces.data())];
      if (of_piece.empty() || of_piece.back().first != s) of_piece.emplace_back(s, Saying{});
      Saying& saying = of_piece.back().second;
      saying.squares_m2 += r * r, saying.points += 1.0;
      saying.pose += w * j * j.transpose();
      saying.both += w * j * l.transpose();
      saying.line += w * l * l.transpose();
      saying.pose_pull += w * r * j;
      saying.line_pull += w * r * l;
    }
  return heard;
}

/// Points of a corner, or of two surfaces, spread wider than noise alone spreads them about a line. Such a
/// piece leans to whichever of its surfaces a scan saw more of, which bends the map: 2 % of its size at 0.3
/// m.
bool is_one_line(const Heard& scans, double most_m) {
  double squares_m2 = 0.0, points = 0.0;
  for (const auto& [s, saying] : scans) squares_m2 += saying.squares_m2, points += saying.points;
  return squares_m2 < points * most_m * most_m;
}

/// Normal equations of all poses. What two scans say of a piece that both saw is a block of the matrix, and
/// in a hall nearly all scans saw the same pieces: the matrix is full. So it is never made; conjugate
/// gradients ask only what it makes of a step.
class Equations {
 public:
  explicit Equations(std::size_t poses)
      : own_(poses, Eigen::Matrix3d::Zero()),
        pull_(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(poses))) {}

  void add_piece(const Heard& scans, double information);
  void add_motion(const RelativeFactor& motion, const std::vector<Pose>& poses);
  void hold(std::uint32_t pose, double information) {
    own_[pose] += information * Eigen::Matrix3d::Identity();
  }
  /// The step of all poses: x, y, yaw of each.
  [[nodiscard]] Eigen::VectorXd solve() const;

 private:
  struct Tie {
    std::uint32_t from, to;
    Eigen::Matrix3d block;  ///< rows of `to`
  };
  struct Word {
    std::uint32_t scan;
    Eigen::Matrix<double, 3, 2> both, weighed;  ///< with the line; the same with the line's inverse
  };
  [[nodiscard]] static auto part(auto& all, std::uint32_t i) {
    return all.template segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  [[nodiscard]] Eigen::VectorXd times(const Eigen::VectorXd& step) const;

  std::vector<Eigen::Matrix3d> own_;  ///< on the diagonal, but for what is eliminated with the pieces
  std::vector<Tie> ties_;
  std::vector<Word> words_;
  std::vector<std::size_t> ends_;  ///< of each piece in `words_`
  Eigen::VectorXd pull_;
};

/// The piece's own line is eliminated (Schur): what is left of what the scans say of it is about each other.
void Equations::add_piece(const Heard& scans, double information) {
  if (scans.size() < 2) return;
  Eigen::Matrix2d line = 1e-3 * Eigen::Matrix2d::Identity();
  Eigen::Vector2d line_pull = Eigen::Vector2d::Zero();
  for (const auto& [s, saying] : scans) line += saying.line, line_pull += saying.line_pull;
  const Eigen::Matrix2d inverse = line.inverse();
  for (const auto& [s, saying] : scans) {
    const Eigen::Matrix<double, 3, 2> weighed = information * saying.both * inverse;
    own_[s] += information * saying.pose;
    part(pull_, s) += information * saying.pose_pull - weighed * line_pull;
    words_.push_back({s, saying.both, weighed});
  }
  ends_.push_back(words_.size());
}

void Equations::add_motion(const RelativeFactor& motion, const std::vector<Pose>& poses) {
  const auto from = static_cast<std::uint32_t>(motion.from), to = static_cast<std::uint32_t>(motion.to);
  const Pose& a = poses[from];
  const Pose& b = poses[to];
  const Eigen::Vector3d error = relative_error(motion, a, b);
  const auto [by_from, by_to] = relative_jacobians(a.yaw_rad(), b.x_m() - a.x_m(), b.y_m() - a.y_m());
  const Eigen::Matrix3d& w = motion.information;
  own_[from] += by_from.transpose() * w * by_from;
  own_[to] += by_to.transpose() * w * by_to;
  ties_.push_back({from, to, by_to.transpose() * w * by_from});
  part(pull_, from) += by_from.transpose() * w * error;
  part(pull_, to) += by_to.transpose() * w * error;
}

Eigen::VectorXd Equations::times(const Eigen::VectorXd& step) const {
  Eigen::VectorXd product(step.size());
  for (std::uint32_t i = 0; i < own_.size(); ++i) part(product, i) = own_[i] * part(step, i);
  for (const Tie& tie : ties_) {
    part(product, tie.to) += tie.block * part(step, tie.from);
    part(product, tie.from) += tie.block.transpose() * part(step, tie.to);
  }
  std::size_t first = 0;
  for (const std::size_t end : ends_) {
    Eigen::Vector2d line = Eigen::Vector2d::Zero();
    for (std::size_t k = first; k < end; ++k) line += words_[k].both.transpose() * part(step, words_[k].scan);
    for (std::size_t k = first; k < end; ++k) part(product, words_[k].scan) -= words_[k].weighed * line;
    first = end;
  }
  return product;
}

/// Conjugate gradients, preconditioned by the blocks on the diagonal.
Eigen::VectorXd Equations::solve() const {
  constexpr double kLeast = 1e-8;  // of the residual that there was, as preconditioned
  std::vector<Eigen::Matrix3d> inverse = own_;
  for (const Word& word : words_) inverse[word.scan] -= word.weighed * word.both.transpose();
  for (Eigen::Matrix3d& m : inverse) m = m.inverse().eval();
  const auto preconditioned = [&](const Eigen::VectorXd& v) {
    Eigen::VectorXd by(v.size());
    for (std::uint32_t i = 0; i < inverse.size(); ++i) part(by, i) = inverse[i] * part(v, i);
    return by;
  };
  Eigen::VectorXd step = Eigen::VectorXd::Zero(pull_.size()), residual = -pull_;
  Eigen::VectorXd way = preconditioned(residual);
  double left = residual.dot(way);
  const double enough = kLeast * kLeast * left;
  for (Eigen::Index k = 0; k < pull_.size() && left > enough; ++k) {
    const Eigen::VectorXd product = times(way);
    const double by = left / way.dot(product);
    step += by * way;
    residual -= by * product;
    const Eigen::VectorXd next = preconditioned(residual);
    const double left_now = residual.dot(next);
    way = next + (left_now / left) * way;
    left = left_now;
  }
  return step;
}

/// A step leads no farther than the surfaces that it was worked out with were sought.
Pose stepped(const Pose& pose, const Eigen::Vector3d& step, double most_m) {
  constexpr double kMostRad = 0.1;
  const double by = std::min({1.0, most_m / std::max(1e-12, std::hypot(step[0], step[1])),
                              kMostRad / std::max(1e-12, std::abs(step[2]))});
  return {pose.x_m() + by * step[0], pose.y_m() + by * step[1], pose.yaw_rad() + by * step[2]};
}

std::vector<Blot> cloud_of(const std::vector<ScanPoints>& scans, const std::vector<Pose>& poses) {
  std::vector<Blot> cloud;
  for (std::size_t s = 0; s < scans.size(); ++s)
    for (std::size_t i = 0; i < scans[s].size(); ++i)
      if (scans[s].weight_of(i) > 0.0) cloud.push_back({poses[s] * scans[s].point(i), scans[s].weight_of(i)});
  return cloud;
}

}  // namespace

std::vector<Pose> bundle_scans(const std::vector<ScanPoints>& scans, std::vector<Pose> poses,
                               const std::vector<RelativeFactor>& wheels, double noise_m) {
  const double noise = std::max(noise_m, kLeastNoiseM);
  const double length_m = std::max(kPieceLengthM, kPieceLengthSigmas * noise);
  const double last_m = kEndSigmas * noise;
  double reach_m = std::max(kStartReachM, kStartSigmas * noise);
  for (int round = 0; round < kBundleRounds; ++round) {
    const double width_m = std::max(noise, 0.4 * reach_m);
    const std::vector<Piece> pieces =
        ridges(blots(cloud_of(scans, poses), 0.1 * length_m), 0.5 * length_m, width_m, kFewestPoints);
    Equations equations(poses.size());
    for (const Heard& scans_of_piece : listen(scans, poses, pieces, 0.5 * length_m, reach_m))
      if (is_one_line(scans_of_piece, kMostSpread * noise * reach_m / last_m))
        equations.add_piece(scans_of_piece, kBeamsAPoint / (noise * noise));
    for (const RelativeFactor& motion : wheels) equations.add_motion(motion, poses);
    for (std::uint32_t i = 0; i < poses.size(); ++i) equations.hold(i, i == 0 ? 1e9 : 1e-3);
    const Eigen::VectorXd step = equations.solve();
    for (std::size_t i = 0; i < poses.size(); ++i)
      poses[i] = stepped(poses[i], step.segment<3>(3 * static_cast<Eigen::Index>(i)), reach_m);
    reach_m = std::max(last_m, kShrinkARound * reach_m);
  }
  return poses;
}

}  // namespace madori::localization
