#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/score_grid.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// Sigma of one residual. Range noise is a third of it; the rest stands for what neighbouring beams share
/// (mixed pixels, the surface's own roughness), so that the information is not overrated.
inline constexpr double kResidualSigmaM = 0.08;

/// How a scan fits a piece of the memory.
struct MatchResult {
  bool converged = false;
  Transform2<Map, Base> map_from_base;
  /// Of (x, y, yaw) at the pose, Map axes; from the scan alone, without the prediction.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double inlier_share = 0.0;   ///< of the points that had the map around them
  double covered_share = 0.0;  ///< of the points, those that had the map around them
};

/// Another pull on the scan's pose: adds its Gauss-Newton terms of (x, y, yaw) at the pose, Map axes.
using ExtraPull = std::function<void(const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian,
                                     Eigen::Vector3d& gradient)>;

/// A prediction to lean on: `information` of (x, y, yaw), Map axes; zero for none.
struct MatchPrior {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
};

/// How far off a match may start: within decimetres, or within some centimetres (and is quicker).
enum class MatchStart { Rough, Near };

/// The surfaces of some keyframes put together, for matching scans against. Of one thread: it works in its
/// own room.
class LocalMap {
 public:
  struct Piece {
    const SurfaceScan* scan;
    Transform2<Map, Base> map_from_base;
  };
  /// Keeps what lies within `radius_m` of `centre`.
  LocalMap(const std::vector<Piece>& pieces, const Point2<Map>& centre, double radius_m) {
    build(pieces, centre, radius_m);
  }
  LocalMap() = default;
  /// Of other keyframes, in the same memory.
  void build(const std::vector<Piece>& pieces, const Point2<Map>& centre, double radius_m);

  [[nodiscard]] bool empty() const { return points_.empty(); }
  /// Exhaustive search in a window around the prediction.
  [[nodiscard]] SearchResult search(const SurfaceScan& scan, const Transform2<Map, Base>& prediction,
                                    const SearchWindow& window) const;
  /// Gauss-Newton on the distances to the nearest surface's tangent, robust (Geman-McClure), from `start`.
  [[nodiscard]] MatchResult refine(const SurfaceScan& scan, const Transform2<Map, Base>& start,
                                   const MatchPrior& prior, const ExtraPull& extra = {},
                                   MatchStart from = MatchStart::Rough) const;

  /// A remembered point, and how far the other keyframes confirm it, 0..1.
  struct Entry {
    SurfacePoint point;
    int piece = 0;
    double weight = 1.0;
  };
  /// Of the surfaces that look the same way as `p` (any, where it has no normal) the nearest within
  /// `reach_m`, at most 0.6; null without one. `before`, if any, is what was nearest before the pose moved a
  /// little: what is farther need not be asked.
  [[nodiscard]] const Entry* nearest(const SurfacePoint& p, double reach_m, const Entry* before) const;

 private:
  [[nodiscard]] bool may_be_near(const SurfacePoint& p, double reach_m) const;
  [[nodiscard]] std::size_t index_of(const Entry& e) const;
  void weigh();
  void build_index();
  void note_sides();

  std::vector<Entry> points_;    ///< Map frame
  std::vector<Entry> surfaces_;  ///< those with a normal, sorted by cell
  std::vector<std::uint32_t> cell_begin_, next_;
  int width_ = 0;
  int height_ = 0;
  Point2<Map> low_, high_;  ///< corners of what holds all points
  struct SeenBy {
    int pieces = 0;
    int last = -1;
  };
  std::vector<SeenBy> seen_by_;  ///< room for weigh(): how many pieces have points in a cell
  /// Which ways surfaces look in a cell, within one, and within two around it: a bit an eighth of a turn.
  static constexpr int kSidesReach = 2;
  std::array<std::vector<std::uint8_t>, kSidesReach + 1> sides_;
  std::size_t sides_width_ = 0;
  Point2<Map> sides_low_;
  mutable std::vector<const Entry*> found_;  ///< of each point of the scan that is matched
  mutable bool has_grid_ = false;            ///< it is built on the first search
  mutable ScoreGrid grid_;
  mutable std::vector<ScoreGrid::Mark> marks_;
};

}  // namespace madori::localization
