#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// How well the drawing describes the building, learned from the fit: a seen surface of a drawn direction
/// lies on a drawn wall with a normal error of `sigma_m`, or is something else with probability 1 -
/// `inliers`.
struct DrawingModel {
  double sigma_m = 0.2;
  double inliers = 0.5;
};

/// Where the memory lies on the drawing: what to move it by, and how much better that is (nats of likelihood;
/// the pieces of one wall count as one for two metres).
struct Alignment {
  Transform2<Map, Map> correction;
  double gain = 0.0;        ///< over leaving it where it is
  double likelihood = 0.0;  ///< at the correction
};

/// Window of the search around where the memory lies now, turning about the memory's own centre.
struct AlignmentWindow {
  double half_m = 1.2;
  double half_rad = 0.35;
  std::size_t sample = 500;  ///< surfaces that are looked at on the grid
};

/// Fits the memory as a whole to the drawing, and turns the drawing into pulls on the keyframes.
class DrawingFit {
 public:
  explicit DrawingFit(const mapping::Walls& walls) : index_(std::make_shared<const WallIndex>(walls)) {}

  [[nodiscard]] const WallIndex& index() const { return *index_; }
  [[nodiscard]] const DrawingModel& model() const { return model_; }

  /// Surfaces of the cloud, in walls of two metres.
  [[nodiscard]] static double walls_seen(const MemoryCloud& cloud);
  /// Log likelihood of the cloud after `correction`, the drawing blurred to `sigma_m`.
  [[nodiscard]] double likelihood(const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                                  double sigma_m) const;
  /// The best rigid correction within the window, found on a grid and refined.
  [[nodiscard]] Alignment align(const MemoryCloud& cloud, const AlignmentWindow& window) const;
  /// From one start, with the plain model of a drawing never seen before: comparable between places.
  [[nodiscard]] Alignment settle(const MemoryCloud& cloud, const Transform2<Map, Map>& start) const;
  /// Learns sigma and the share of inliers from a cloud that lies right.
  void learn(const MemoryCloud& cloud);
  /// The drawing's pulls, one a keyframe, for keyframes at `poses`.
  [[nodiscard]] std::vector<UnaryFactor> pulls(const MemoryCloud& cloud,
                                               const std::vector<Transform2<Map, Base>>& poses) const;

  /// Share of the scan's surfaces, by length, that lie on drawn walls at `pose`.
  [[nodiscard]] double share_on_walls(const SurfaceScan& scan, const Transform2<Map, Base>& pose) const;
  /// The drawing's pull on one scan at `pose`: adds Gauss-Newton terms of (x, y, yaw), Map axes.
  void pull(const SurfaceScan& scan, const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian,
            Eigen::Vector3d& gradient) const;

 private:
  [[nodiscard]] Transform2<Map, Map> refine(const MemoryCloud& cloud, const Point2<Map>& centre,
                                            Transform2<Map, Map> correction, const DrawingModel& model) const;
  [[nodiscard]] std::vector<Transform2<Map, Map>> coarse(const MemoryCloud& cloud, const Point2<Map>& centre,
                                                         const AlignmentWindow& window) const;

  std::shared_ptr<const WallIndex> index_;  ///< copies share it
  DrawingModel model_;
};

}  // namespace madori::localization
