#pragma once

#include <stdint.h>

#include "localization/landmarks/descriptor.hpp"
#include "localization/landmarks/uncertain_pose.hpp"

namespace madori::localization::landmarks {

/// End points of a descriptor, metres.
struct DescriptorPoints {
  explicit DescriptorPoints(const Descriptor& descriptor);

  int size = 0;
  float x_m[Descriptor::kMost];
  float y_m[Descriptor::kMost];
};

/// A descriptor as normal distributions: four grids of square cells, shifted by half a cell against each
/// other (Biber and Strasser, The Normal Distributions Transform, IROS 2003, sections III and IV). Only cells
/// with at least three points are kept, so 400 points never need more than 4 x 133.
class DescriptorField {
 public:
  DescriptorField(const DescriptorPoints& points, double cell_m);

  /// Score of points seen from `pose` and its Gauss-Newton terms in (x, y, yaw), axes of the descriptor.
  struct Terms {
    double score = 0.0;  ///< mean over the points and grids, 0..1
    Matrix3 hessian;     ///< each point counted once: information of the match
    Vector3 gradient;
  };
  [[nodiscard]] Terms terms(const DescriptorPoints& points, const Displacement& pose) const;
  /// The score alone, of every `stride`-th point.
  [[nodiscard]] double score(const DescriptorPoints& points, const Displacement& pose, int stride = 1) const;

 private:
  static constexpr int kMostCells = Descriptor::kMost / 3;
  struct Cell {
    int32_t key;
    float mean_x, mean_y;
    float a, b, c;  ///< inverse covariance (a b; b c), 1/m^2
  };
  [[nodiscard]] int32_t key_of(int grid, double x, double y) const;
  [[nodiscard]] const Cell* find(int grid, double x, double y) const;
  void fill(int grid, const DescriptorPoints& points);

  double cell_m_;
  int counts_[4] = {};
  Cell cells_[4][kMostCells];
};

/// A scan matched to a landmark's descriptor.
struct DescriptorMatch {
  Displacement landmark_from_scan;  ///< p_landmark = landmark_from_scan * p_scan
  FullUncertainty uncertainty;      ///< axes of the landmark
  /// Score relative to the one that the descriptor has with itself: 1 for the same scan from the same place.
  double quality = 0.0;
  double rival_quality = 0.0;  ///< of the best other place in the window
};

/// Where the scan may have been taken, landmark's axes: half widths around a centre.
struct MatchWindow {
  Displacement centre;
  double reach_m = 0.0;
  double reach_rad = 0.0;
};

/// Tries starts all over the window on the coarsest cells, then Newton's method on the best ones from coarse
/// to fine (Biber and Strasser, section V). The cells are 1, 1/2 and 1/4 of the descriptor's median range. No
/// heap; about 2 x sizeof(DescriptorField) of stack.
[[nodiscard]] DescriptorMatch match_descriptor(const Descriptor& landmark, const Descriptor& scan,
                                               const MatchWindow& window);

}  // namespace madori::localization::landmarks
