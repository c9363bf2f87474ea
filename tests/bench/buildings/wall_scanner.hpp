#pragma once

#include <optional>
#include <vector>

#include "core/laser_scan.hpp"
#include "localization/scan_points.hpp"
#include "simulation/lidar/plane_scanner.hpp"

namespace madori::bench {

/// A 2D scanner 0.25 m above the floor at the vehicle's front: 270 degrees in steps of 0.5, ten scans a
/// second of 15 ms each, noise of 1.5 cm. It looks at a virtual factory from the true poses that it is told.
class WallScanner {
 public:
  explicit WallScanner(std::uint64_t seed);

  /// A true pose, in the order of time. The first one starts the scanner.
  void moved(Stamp at, const Transform2<simulation::Building, Base>& pose);

  struct Scan {
    Stamp stamp;  ///< of its middle beam
    localization::ScanPoints points;
  };
  /// Points on walls of the scans that are complete by the last pose.
  [[nodiscard]] std::vector<Scan> take(const simulation::World& world,
                                       const std::vector<simulation::Body>& bodies);
  [[nodiscard]] Point2<Base> place() const { return {mounting_.x_m, mounting_.y_m}; }

 private:
  mapping::SensorRecord mounting_;
  simulation::PlaneScanner scanner_;
  simulation::PoseTrack track_;
  std::optional<Stamp> epoch_;
  Stamp now_{};
};

}  // namespace madori::bench
