#include "localization/self_calibration/strain_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

constexpr double kPriorM = 1.0;  // only against directions that a scan does not see
constexpr double kPriorRad = 0.1;

/// Every so-manieth keyframe, so that few enough are tried.
std::vector<const CalibrationKeyframe*> some_of(const std::vector<CalibrationKeyframe>& keyframes) {
  constexpr std::size_t kMost = 60;
  const std::size_t every = (keyframes.size() + kMost - 1) / kMost;
  std::vector<const CalibrationKeyframe*> some;
  for (std::size_t i = 0; i < keyframes.size(); i += every) some.push_back(&keyframes[i]);
  return some;
}

/// Explained surface on the grid of strains, row by row along y.
class StrainGrid {
 public:
  explicit StrainGrid(const CalibrationOptions& options)
      : step_(options.strain_step), reach_(static_cast<int>(std::lround(options.most_strain / step_))) {}

  [[nodiscard]] int side() const { return 2 * reach_ + 1; }
  [[nodiscard]] Eigen::Vector3d strain(int i, int j) const {
    return {(i - reach_) * step_, (j - reach_) * step_, 0.0};
  }
  void push(double explained_m) { explained_m_.push_back(explained_m); }
  [[nodiscard]] double at(int i, int j) const {
    const bool outside = i < 0 || j < 0 || i >= side() || j >= side();
    return outside ? -1.0
                   : explained_m_[static_cast<std::size_t>(i) * static_cast<std::size_t>(side()) +
                                  static_cast<std::size_t>(j)];
  }
  [[nodiscard]] bool is_peak(int i, int j) const {
    for (int di = -1; di <= 1; ++di)
      for (int dj = -1; dj <= 1; ++dj)
        if (at(i + di, j + dj) > at(i, j)) return false;
    return at(i, j) > 0.0;
  }

 private:
  double step_;
  int reach_;
  std::vector<double> explained_m_;
};

}  // namespace

Point2<Map> middle_of(const std::vector<CalibrationKeyframe>& keyframes) {
  Point2<Map> middle;
  for (const CalibrationKeyframe& k : keyframes) {
    middle.x_m += k.map_from_base.x_m() / static_cast<double>(keyframes.size());
    middle.y_m += k.map_from_base.y_m() / static_cast<double>(keyframes.size());
  }
  return middle;
}

Transform2<Map, Base> unstrained(const Transform2<Map, Base>& pose, const StrainAbout& strained) {
  const Point2<Map>& m = strained.middle;
  return {m.x_m + (pose.x_m() - m.x_m) / (1.0 + strained.strain[0]),
          m.y_m + (pose.y_m() - m.y_m) / (1.0 + strained.strain[1]), pose.yaw_rad()};
}

double explained_m(const WallIndex& drawing, const StrainAbout& strained, const Transform2<Map, Base>& pose,
                   const std::vector<SurfacePiece>& pieces, double scale_m, double beside_m) {
  double sum = 0.0;
  for (const SurfacePiece& piece : pieces)
    if (const auto row = strain_row(drawing, strained, pose, piece, beside_m))
      sum += piece.length_m * geman_mcclure(row->residual_m, scale_m);
  return sum;
}

Transform2<Map, Base> fit_keyframe(const WallIndex& drawing, const StrainAbout& strained,
                                   const Transform2<Map, Base>& start,
                                   const std::vector<SurfacePiece>& pieces,
                                   const CalibrationOptions& options) {
  constexpr int kRounds = 9;
  Transform2<Map, Base> pose = start;
  double scale = options.first_scale_m;
  const double noise2 = options.piece_sigma_m * options.piece_sigma_m;
  const Eigen::Matrix3d prior = Eigen::Vector3d(noise2 / (kPriorM * kPriorM), noise2 / (kPriorM * kPriorM),
                                                noise2 / (kPriorRad * kPriorRad))
                                    .asDiagonal();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix3d a = prior;
    Eigen::Vector3d b = -prior * pose_difference(pose, start);
    for (const SurfacePiece& piece : pieces)
      if (const auto row = strain_row(drawing, strained, pose, piece, options.beside_m)) {
        const double weight = piece.length_m * geman_mcclure(row->residual_m, scale);
        a += weight * row->by_pose * row->by_pose.transpose();
        b -= weight * row->residual_m * row->by_pose;
      }
    const Eigen::Vector3d step = a.ldlt().solve(b);
    if (!step.allFinite()) return start;
    pose = {pose.x_m() + step.x(), pose.y_m() + step.y(), pose.yaw_rad() + step.z()};
    scale = std::max(options.last_scale_m, 0.7 * scale);
  }
  return pose;
}

std::vector<StrainPeak> search_strains(const WallIndex& drawing,
                                       const std::vector<CalibrationKeyframe>& keyframes,
                                       const CalibrationOptions& options) {
  const auto some = some_of(keyframes);
  const Point2<Map> middle = middle_of(keyframes);
  const double beside_m = 3.0 * options.last_scale_m;
  StrainGrid grid(options);
  for (int i = 0; i < grid.side(); ++i)
    for (int j = 0; j < grid.side(); ++j) {
      const StrainAbout strained{middle, grid.strain(i, j)};
      double sum = 0.0;
      for (const CalibrationKeyframe* k : some) {
        const auto start = unstrained(k->map_from_base, strained);
        sum += explained_m(drawing, strained, fit_keyframe(drawing, strained, start, k->pieces, options),
                           k->pieces, options.last_scale_m, beside_m);
      }
      grid.push(sum);
    }
  std::vector<StrainPeak> peaks;
  for (int i = 0; i < grid.side(); ++i)
    for (int j = 0; j < grid.side(); ++j)
      if (grid.is_peak(i, j)) peaks.push_back({grid.strain(i, j), grid.at(i, j)});
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const StrainPeak& a, const StrainPeak& b) { return a.explained_m > b.explained_m; });
  return peaks;
}

}  // namespace madori::localization
