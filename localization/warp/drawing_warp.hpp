#pragma once

#include <memory>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/transform2.hpp"

namespace madori::localization {

/// building = scale * R(yaw) * map + (x, y): how the drawing as a whole lies on the building.
struct WarpSimilarity {
  double scale = 1.0;  ///< metres of the building a metre of the drawing
  double yaw_rad = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;

  friend bool operator==(const WarpSimilarity&, const WarpSimilarity&) = default;
};

/// A displacement field: a uniform cubic B-spline over a lattice of control points on the drawing. Beyond the
/// lattice the control points are zero, so that the field ends smoothly.
struct WarpField {
  Point2<Map> origin;             ///< of control point (0, 0)
  double spacing_m = 2.0;         ///< of the control points
  int width = 0;                  ///< control points along x
  int height = 0;                 ///< along y
  std::vector<double> control_m;  ///< x, y of each control point, Building axes, row by row from the lowest
  std::vector<double> sigma_m;    ///< of the displacement at each control point (the larger axis), row by row

  friend bool operator==(const WarpField&, const WarpField&) = default;
};

/// The largest step between neighbouring control points. Up to half of their spacing nothing folds.
[[nodiscard]] double steepest_step_m(const WarpField& field);

/// What the walls seen so far say of the drawing's errors (empirical Bayes); where the next fit starts.
struct WarpStatistics {
  double amplitude_m = 0.3;  ///< standard deviation of the field; the prior of a drawing never seen before
  double range_m = 15.0;     ///< where the field's correlation has fallen to 0.14 (Matern, nu = 1)
  double offset_m = 0.05;    ///< of single walls beside the field
  double residual_m = 0.05;  ///< of the pieces of a wall beside the wall
  double inliers = 0.6;      ///< share of the surfaces that are drawn walls

  friend bool operator==(const WarpStatistics&, const WarpStatistics&) = default;
};

/// Relates the drawing (Map) to the building as it is (Building, metric): a size and a rigid motion of the
/// whole, and a smooth displacement field. A value: immutable, cheap to copy, identity by default.
class DrawingWarp {
 public:
  DrawingWarp() = default;
  /// Preconditions: scale > 0, the vectors of the field have width * height entries (control_m twice that),
  /// or none. Steps between neighbouring control points below half their spacing make it invertible.
  DrawingWarp(const WarpSimilarity& similarity, WarpField field, const WarpStatistics& statistics);

  /// Every place carried onto itself, to the bit; the uncertainty need not be zero.
  [[nodiscard]] bool is_identity() const { return !data_ || data_->identity; }

  [[nodiscard]] Point2<Building> building(const Point2<Map>& p) const;
  /// The inverse, by Newton's method: to below 0.1 mm.
  [[nodiscard]] Point2<Map> map(const Point2<Building>& p) const;
  /// The heading is turned as the surroundings are: by the rotation in the polar decomposition of the
  /// Jacobian.
  [[nodiscard]] Transform2<Building, Base> building(const Transform2<Map, Base>& pose) const;
  [[nodiscard]] Transform2<Map, Base> map(const Transform2<Building, Base>& pose) const;

  /// By how much the surroundings of `p` are turned from Map to Building.
  [[nodiscard]] double turn_rad(const Point2<Map>& p) const;
  /// Standard deviation, an axis, of where `p` of the drawing lies in the building; zero for the default.
  [[nodiscard]] double sigma_m(const Point2<Map>& p) const;

  [[nodiscard]] const WarpSimilarity& similarity() const { return data().similarity; }
  [[nodiscard]] const WarpField& field() const { return data().field; }
  [[nodiscard]] const WarpStatistics& statistics() const { return data().statistics; }

  friend bool operator==(const DrawingWarp& a, const DrawingWarp& b) {
    return a.data_ == b.data_ ||
           (a.similarity() == b.similarity() && a.field() == b.field() && a.statistics() == b.statistics());
  }

 private:
  struct Data {
    WarpSimilarity similarity;
    WarpField field;
    WarpStatistics statistics;
    bool identity = true;
  };
  struct Local;  ///< a place carried over, and the Jacobian there

  [[nodiscard]] const Data& data() const;
  [[nodiscard]] Local local(const Point2<Map>& p) const;

  std::shared_ptr<const Data> data_;  ///< null: identity
};

}  // namespace madori::localization
