#pragma once

#include <Eigen/Dense>
#include <vector>

#include "mapping/drawing/labelling/log_odds.hpp"
#include "mapping/drawing/labelling/wall_model.hpp"

namespace madori::training {

/// Logistic regression of what was right on the log odds of what was said (J. Platt, "Probabilistic outputs
/// for support vector machines", 1999).
class CalibrationFit {
 public:
  void add(double said, bool is_wall, double weight) {
    if (weight > 0) rows_.push_back({mapping::log_odds(said, 1e-6), is_wall ? 1.0 : 0.0, weight});
  }

  /// Newton's method; the likelihood is concave. As said where nothing was added.
  [[nodiscard]] mapping::Calibration fitted() const {
    constexpr int kRounds = 25;
    Eigen::Vector2d of(1, 0);
    for (int round = 0; round < kRounds; ++round) {
      Eigen::Matrix2d h = 1e-9 * Eigen::Matrix2d::Identity();
      Eigen::Vector2d g(0, 0);
      for (const Row& row : rows_) {
        const Eigen::Vector2d x(row.log_odds, 1);
        const double p = mapping::probability_of(of.dot(x));
        g += row.weight * (row.right - p) * x;
        h += row.weight * p * (1 - p) * x * x.transpose();
      }
      of += h.ldlt().solve(g);
    }
    return {of[0], of[1]};
  }

 private:
  struct Row {
    double log_odds, right, weight;
  };
  std::vector<Row> rows_;
};

}  // namespace madori::training
