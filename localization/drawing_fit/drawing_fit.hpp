#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "localization/drawing_fit/alignment.hpp"
#include "localization/drawing_fit/drawing_model.hpp"
#include "localization/drawing_fit/memory_cloud.hpp"
#include "localization/drawing_fit/wall_index.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// An error that neighbouring walls have in common.
struct SharedError {
  double sigma_m = 0.0;
  double range_m = 15.0;  ///< within which walls share it
};

/// Fits the memory as a whole to the drawing, and turns the drawing into pulls on the keyframes.
class DrawingFit {
 public:
  explicit DrawingFit(const mapping::Walls& walls) : index_(std::make_shared<const WallIndex>(walls)) {}
  /// Where it is known from which sides each can be seen.
  DrawingFit(const mapping::Walls& walls, const std::vector<VisibleFace>& faces)
      : index_(std::make_shared<const WallIndex>(walls, faces)) {}
  /// Of which it is known how exactly it describes what is seen.
  DrawingFit(const mapping::Walls& walls, const DrawingModel& model)
      : index_(std::make_shared<const WallIndex>(walls)), model_(model) {}

  [[nodiscard]] const WallIndex& index() const { return *index_; }
  [[nodiscard]] const DrawingModel& model() const { return model_; }

  /// Surfaces of the cloud, in walls of two metres.
  [[nodiscard]] static double walls_seen(const MemoryCloud& cloud);
  /// Log likelihood of the cloud after `correction`, the drawing blurred to `sigma_m`.
  [[nodiscard]] double likelihood(const MemoryCloud& cloud, const Transform2<Map, Map>& correction,
                                  double sigma_m) const;
  /// The best rigid correction within the window, found on a grid and refined.
  [[nodiscard]] Alignment align(const MemoryCloud& cloud, const AlignmentWindow& window) const;
  /// From one start, with the plain model of a drawing never seen before: comparable between places. With
  /// `stay` at the optimum that the start is at, else at the best of those around it.
  [[nodiscard]] Alignment settle(const MemoryCloud& cloud, const Transform2<Map, Map>& start,
                                 bool stay = false) const;
  /// Learns sigma and the share of inliers from a cloud that lies right.
  void learn(const MemoryCloud& cloud);
  /// The drawing's pulls, one a keyframe, for keyframes at `poses`. Where the drawing as a whole lies beside
  /// the building by `shared` there, all walls err together and tell no more than one of them.
  [[nodiscard]] std::vector<UnaryFactor> pulls(const MemoryCloud& cloud,
                                               const std::vector<Transform2<Map, Base>>& poses,
                                               const SharedError& shared = {}) const;

  /// Share of the scan's surfaces, by length, that lie on drawn walls at `pose`.
  [[nodiscard]] double share_on_walls(const SurfaceScan& scan, const Transform2<Map, Base>& pose) const;
  /// The drawing's pull on one scan at `pose`: adds Gauss-Newton terms of (x, y, yaw), Map axes.
  void pull(const SurfaceScan& scan, const Transform2<Map, Base>& pose, Eigen::Matrix3d& hessian,
            Eigen::Vector3d& gradient) const;

 private:
  std::shared_ptr<const WallIndex> index_;  ///< copies share it
  DrawingModel model_;
};

}  // namespace madori::localization
