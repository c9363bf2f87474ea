#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::localization {

/// The control points of the field that are estimated; none for a warp without one.
struct WarpLattice {
  Point2<Map> origin;
  double spacing_m = 2.0;
  int width = 0;
  int height = 0;
  [[nodiscard]] int nodes() const { return width * height; }
};

/// A stretch of a wall's side that was seen: normal . displacement(place) + offset(unit) = distance.
struct WarpObservation {
  int unit = 0;           ///< which offset
  Point2<Map> place;      ///< on the drawn wall
  double normal_x = 0.0;  ///< the wall's left normal in the building
  double normal_y = 0.0;
  double distance_m = 0.0;
  double information = 0.0;  ///< 1 / m^2
};

/// Precisions of the prior.
struct WarpPriorWeights {
  double amplitude_m{};
  double range_m{};
  bool similarity = true;                ///< estimated at all
  std::vector<double> offset_precision;  ///< one a unit, 1 / m^2
};

/// The Gaussian posterior of displacement field, offsets and similarity. The similarity is
/// p + t + a (p - pivot) + b rot90(p - pivot).
class WarpPosterior {
 public:
  /// Solves the normal equations by sparse Cholesky decomposition.
  WarpPosterior(const WarpLattice& lattice, const Point2<Map>& pivot,
                const std::vector<WarpObservation>& observations, const WarpPriorWeights& prior);
  ~WarpPosterior();
  WarpPosterior(WarpPosterior&&) noexcept;
  WarpPosterior& operator=(WarpPosterior&&) noexcept;

  [[nodiscard]] Eigen::Vector2d control(int node) const;
  [[nodiscard]] double offset(int unit) const;
  [[nodiscard]] Eigen::Vector4d similarity() const;  ///< t_x, t_y, a, b; zero where not estimated

  /// Log marginal likelihood but for what depends on the observations alone: to compare priors.
  [[nodiscard]] double log_marginal() const;
  /// Laplace: log prior of field and similarity at their estimates, - 1/2 log|H| of all (the offsets' prior
  /// is the caller's, by its true shape), and the 2 pi of field and similarity.
  [[nodiscard]] double occam_nats() const;
  /// z' Q1 z of the field, where Q1 is the prior precision at amplitude 1.
  [[nodiscard]] double roughness() const;

  /// Elements of the covariance (Takahashi, Fagan, Chen 1973): to be called before what follows.
  void invert();
  [[nodiscard]] double offset_variance(int unit) const;
  /// Degrees of freedom that the observations determine: of the field, and of all.
  [[nodiscard]] double field_freedom() const;
  [[nodiscard]] double freedom() const;
  /// Variance of the displacement at a control point's place, the larger axis; 0 without a field's lattice.
  [[nodiscard]] double variance_at(int node) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace madori::localization
