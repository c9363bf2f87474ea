#pragma once

#include <array>
#include <vector>

#include "sensors/vlp16/packet.hpp"
#include "simulation/lidar/range_bias.hpp"
#include "simulation/lidar/view.hpp"

namespace madori::simulation {

/// A VLP-16 that turns and fires: packet n covers 24 firings (12 in dual-return mode), 55.296 us apart, each
/// beam cast from where the sensor is at its firing.
class Vlp16Model {
 public:
  /// `hour_offset` is the time past the hour when the simulation starts.
  Vlp16Model(const mapping::SensorRecord& mounting, const Vlp16Spec& spec, std::uint64_t seed,
             Duration hour_offset);

  /// When the last beam of the next packet is fired, since the start.
  [[nodiscard]] Duration next_complete() const;
  /// Measures the next packet. Precondition: the view's track reaches next_complete().
  [[nodiscard]] sensors::vlp16::DataPacket measure(const View& view);

 private:
  [[nodiscard]] std::size_t firings() const { return spec_.dual_return ? 12 : 24; }
  [[nodiscard]] double azimuth_rad(std::uint64_t firing) const;
  /// Which firings of the next packet are measured (Vlp16Spec::keep_every_firing).
  void choose_firings();
  void aim(const View& view);
  void fill(sensors::vlp16::DataPacket& packet) const;

  mapping::SensorRecord mounting_;
  Vlp16Spec spec_;
  std::uint64_t seed_;
  Duration hour_offset_;
  std::uint64_t packet_ = 0;
  std::vector<std::size_t> kept_;  ///< within the packet
  BeamSpot spot_;
  std::array<RangeBias, sensors::vlp16::kChannels> bias_;  ///< each laser has its own
  BeamBatch beams_;
};

}  // namespace madori::simulation
