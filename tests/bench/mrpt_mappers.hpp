#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/frames.hpp"
#include "core/laser_scan.hpp"
#include "core/odometry.hpp"
#include "core/transform2.hpp"

namespace madori::bench {

/// A mapper of MRPT 2.5 with the settings that Debian's mrpt-common ships: `icp-slam`
/// (icp-slam_demo_classic.ini) or `rbpf-slam` (gridmapping_RBPF_ICPbased_intel.ini, made for the Intel log).
class PeerMapper {
 public:
  virtual ~PeerMapper() = default;
  virtual void on_odometry(const OdometryReading& reading) = 0;
  virtual void on_scan(const LaserScan& scan) = 0;
  /// Where each scan lies, in its order: of icp-slam as it was driven, of rbpf-slam the likeliest way.
  [[nodiscard]] virtual std::vector<Transform2<Map, Base>> way() = 0;
};

/// Throws std::exception where the settings are not installed.
[[nodiscard]] std::unique_ptr<PeerMapper> peer_mapper(const std::string& name);

}  // namespace madori::bench
