#pragma once

#include <memory>
#include <random>
#include <vector>

#include "localization/global/scan_noise.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/options.hpp"
#include "localization/particle_filter/particles.hpp"
#include "localization/slam/grid_match.hpp"
#include "localization/slam/laid_way.hpp"
#include "localization/slam/mapper.hpp"
#include "localization/slam/scan_follower.hpp"

namespace madori::localization {

struct RbpfOptions {
  LocalizerOptions front;  ///< how the motion from keyframe to keyframe is measured
  std::size_t particles = 30;
  double resample_below = 0.5;  ///< of the particles, that their weights must be worth
  double beams = 12.0;          ///< independent ones, that a scan is worth
  double sample_m = 0.03;       ///< K = 27 poses around the best one, so far apart,
  double sample_rad = 0.01;     ///< are weighed
  double least_inliers = 0.3;  ///< of a scan, that must lie on a particle's own map: else the motion is drawn
  std::uint32_t seed = 1;
};

/// Rao-Blackwellized mapping (Grisetti, Stachniss, Burgard, Improved Techniques for Grid Mapping with
/// Rao-Blackwellized Particle Filters, 2007; Eq. 3.6 and on of the lifelong localization thesis, with the
/// weight that is missing there): every particle is a way with a map of its own. At each keyframe the scan is
/// laid on the particle's own map, from where the keyframes driven last put it and from where the wheels do;
/// K poses around a match give the proposal's mean, covariance and weight: w <- w sum_j p(z | m, x_j)
/// p(x_j | x', u), u being the wheels. Where the two matches differ, one is drawn by its weight. Resampled
/// when the weights are worth half of the particles. Maps share what was the same when a particle was copied.
class RbpfMapper final : public Mapper {
 public:
  explicit RbpfMapper(const RbpfOptions& options = {});

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) override;
  [[nodiscard]] FinishedMap finish() override;

  /// What the weights are worth, of all particles. For whoever watches the filter.
  [[nodiscard]] double effective_particles() const;

 private:
  /// A way, newest pose first; particles share what they have in common.
  struct Moment {
    Transform2<Map, Base> map_from_base;
    std::shared_ptr<const Moment> before;
  };
  struct Particle {
    std::shared_ptr<const Moment> way;
    SurfaceGrid map;
    double log_weight = 0.0;  ///< since the last resampling
    double log_sum = 0.0;     ///< of all the way
  };

  /// Where a particle may go, and the logarithm of what that explains.
  struct Proposal {
    Eigen::Vector3d mean;
    Eigen::Matrix3d covariance;
    double log_eta;
  };

  [[nodiscard]] PoseEstimate estimate(Stamp stamp) const;
  [[nodiscard]] Proposal around(const GridMatch& match, const SurfaceScan& scan, const SurfaceGrid& map,
                                const PosePrior& prior) const;
  void follow(const SurfaceScan& scan);
  void remember(const SurfaceScan& scan);
  void propose(const SurfaceScan& scan, const MeasuredMotion& motion);
  void extend(Particle& particle, const SurfaceScan& scan, const Transform2<Map, Base>& by_scans,
              const PosePrior& prior, const Transform2<Map, Base>& drawn);
  void resample_where_needed();
  [[nodiscard]] Transform2<Map, Base> sampled(const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance);
  [[nodiscard]] std::vector<double> weights() const;
  [[nodiscard]] std::size_t best() const;

  RbpfOptions options_;
  ScanFollower follower_;
  MapState front_;  ///< recent keyframes as they were driven; drifts, no loop is closed in it
  LidarNoise noise_;
  Transform2<Map, Base> anchor_;  ///< the pose at the last scan, in the front's map
  bool is_lost_ = false;
  std::vector<Particle> particles_;
  std::mt19937 engine_;
  std::vector<ReckonedPose> reckoned_;  ///< one a scan
  std::vector<std::size_t> scan_of_;    ///< the scan that each keyframe is
};

}  // namespace madori::localization
