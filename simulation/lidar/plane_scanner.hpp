#pragma once

#include <cstdint>
#include <vector>

#include "simulation/lidar/echo.hpp"
#include "simulation/lidar/view.hpp"

namespace madori::simulation {

/// The mechanics of a 2D scanner of 270 deg: the mirror turns evenly, beam i at -135 deg + i /
/// beams_a_degree.
struct PlaneScannerOptions {
  Duration period{};       ///< of one turn
  int beams_a_degree = 2;  ///< 541 beams of 2
  int every = 1;           ///< only each so-many-th turn is measured
  EchoOptions echo;
  BeamSpot spot;
  RangeBias bias;
  Lean lean;                 ///< how it truly hangs
  std::uint64_t stream = 0;  ///< of the random numbers
};

class PlaneScanner {
 public:
  PlaneScanner(const mapping::SensorRecord& mounting, const PlaneScannerOptions& options, std::uint64_t seed)
      : mounting_(mounting), options_(options), seed_(seed) {}

  /// When the next scan begins, and when its last beam is fired, since the start.
  [[nodiscard]] Duration next_start() const {
    return options_.period * options_.every * static_cast<std::int64_t>(scan_);
  }
  [[nodiscard]] Duration next_complete() const { return next_start() + options_.period * 3 / 4; }
  [[nodiscard]] std::uint64_t scans() const { return scan_; }
  /// Turns of the mirror before the newest scan's, that one with it.
  [[nodiscard]] std::uint64_t turns() const { return scan_ * static_cast<std::uint64_t>(options_.every); }
  [[nodiscard]] std::size_t beams() const {
    return static_cast<std::size_t>(270 * options_.beams_a_degree) + 1;
  }
  [[nodiscard]] double angle_rad(std::size_t beam) const;
  /// The next scan's echoes, beam by beam. Precondition: the view's track reaches next_complete().
  [[nodiscard]] const std::vector<Echo>& measure(const View& view);

 private:
  mapping::SensorRecord mounting_;
  PlaneScannerOptions options_;
  std::uint64_t seed_;
  std::uint64_t scan_ = 0;
  BeamBatch beams_;
  std::vector<Echo> echoes_;
};

}  // namespace madori::simulation
