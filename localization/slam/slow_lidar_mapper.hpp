#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "localization/localizer/options.hpp"
#include "localization/motion_model/odometry_track.hpp"
#include "localization/slam/growing_map.hpp"
#include "localization/slam/mapper.hpp"
#include "localization/slam/strategies.hpp"
#include "localization/slam/surface_bundle.hpp"

namespace madori::localization {

struct SlowLidarOptions {
  StrategyOptions strategies;  ///< most_e_psr_m is what e_max is at the least
  OdometryNoise odometry;
  SurfaceScanOptions scan;
  double e_max_of_noise = 1.0;   ///< e_max is at least so many sigmas of the scan's own noise,
  double e_max_of_recent = 2.0;  ///< and so many times the mean e_psr of the scans accepted last;
  std::size_t recent = 10;
  int scans_to_jump = 2;  ///< so many more have to lead to where the wheels do not, before that is believed
  double residual_sigma_m = 0.05;  ///< of a point from its surface at the least, beside the wheels' word
};

/// A pose, and its covariance in Map axes: m, m, rad.
struct Belief {
  Transform2<Map, Base> map_from_base;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// SLAM for lidars that scan less than once a second, as published (Kis, Csemesz, Csáji 2021, Algorithms 1 to
/// 3): each scan is laid on a growing point map by RDNM and ICP, failing that by CPD and ICP, failing that by
/// the search of the whole map; a scan that lies nowhere is not added, and the wheels go on. Beyond the
/// paper: where the wheels speak against a pose that was found, it takes more than one scan to believe it.
class SlowLidarMapper final : public Mapper {
 public:
  explicit SlowLidarMapper(const SlowLidarOptions& options = {});

  PoseEstimate on_odometry(const OdometryReading& reading) override;
  PoseEstimate on_scan(Stamp stamp, const ScanPoints& points, const Point2<Base>& sensor) override;
  [[nodiscard]] FinishedMap finish() override;

  /// The point map, and what it says of itself; after finish() that of the last look.
  [[nodiscard]] const GrowingMap& map() const { return map_; }
  /// e_psr of each accepted scan to the map as it was before it, metres.
  [[nodiscard]] const std::vector<double>& e_psr_m() const { return e_psr_m_; }
  /// How a scan as noisy as this is laid on the map as it is now.
  [[nodiscard]] StrategyOptions strategies_for(const ScanPoints& points) const;

 private:
  [[nodiscard]] double e_max_m(double noise_m) const;
  [[nodiscard]] PoseEstimate estimate(Stamp stamp) const;
  [[nodiscard]] Belief carried(const Belief& from, const OdometryStep& step) const;
  [[nodiscard]] std::optional<StrategyResult> laid(const ScanPoints& points, const Point2<Base>& sensor,
                                                   const Belief& assumed);
  [[nodiscard]] bool is_believed(const Transform2<Map, Base>& pose, const Belief& here);
  [[nodiscard]] bool sees_through_last(const ScanPoints& points, const Transform2<Map, Base>& pose,
                                       const LikelihoodOptions& options) const;
  void begin_anew();
  void note_motion(Stamp stamp, const Belief& assumed, bool is_believed);

  struct Look {
    Stamp stamp{};
    Point2<Base> sensor;
    double path_m;  ///< driven since the one before
  };

  SlowLidarOptions options_;
  OdometryModel model_;
  OdometryTrack track_;
  OdometryStep since_scan_;
  GrowingMap map_;
  Transform2<Map, Base> anchor_;                          ///< the pose at the last scan
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  ///< of it, since a scan was laid on the map
  Stamp anchor_stamp_{};
  /// Where scans lie that the wheels speak against, carried on by the wheels, and how many more led there.
  std::optional<std::pair<Belief, int>> elsewhere_;
  int lost_ = 0;          ///< scans, all in all
  bool is_lost_ = false;  ///< the last one
  double path_m_ = 0.0;   ///< driven since the last accepted scan
  std::vector<double> e_psr_m_;
  std::vector<Look> looks_;  ///< the accepted scans, what they saw, and from where
  std::vector<ScanPoints> scans_;
  std::vector<Transform2<Map, Base>> poses_;
  std::vector<RelativeFactor> motions_;  ///< from each to the next by the wheels
  std::vector<Stamp> carried_;           ///< of those to which no motion of the wheels leads
};

}  // namespace madori::localization
