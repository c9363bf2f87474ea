#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "core/angle.hpp"
#include "sensors/vlp16/packet.hpp"
#include "simulation/lidar/echo.hpp"
#include "simulation/lidar/view.hpp"
#include "simulation/random.hpp"

namespace madori::test {

/// The VLP-16 of simulation::Vlp16Model of which only the eight lasers that aim upwards are measured: their
/// returns are those of thin beams without systematic errors, bit for bit (a test compares them), the others
/// come back empty. Half the rays, for long runs of what looks above the equipment. Strongest return, 10 Hz.
class UpperLasers {
 public:
  UpperLasers(const mapping::SensorRecord& mounting, const simulation::Vlp16Spec& spec, std::uint64_t seed)
      : mounting_(mounting), spec_(spec), seed_(seed) {
    for (std::size_t l = 0; l < kLasers; ++l) {
      const double elevation = to_rad(sensors::vlp16::kElevationsDeg[channel(l)]);
      const double step = 2.304e-6 * spec.rate_hz * 2.0 * kPi * static_cast<double>(channel(l));
      turns_[l] = {std::cos(step), std::sin(step), std::cos(elevation), std::sin(elevation)};
    }
  }

  [[nodiscard]] Duration next_complete() const {
    return Duration(static_cast<std::int64_t>((packet_ + 1) * kFirings - 1) * kFiringNs + kLastChannelNs);
  }
  /// Precondition: the view's track reaches next_complete().
  [[nodiscard]] sensors::vlp16::DataPacket measure(const simulation::View& view) {
    aim(view);
    beams_.cast(view.world.rays(), view.bodies, static_cast<float>(spec_.range_max_m));
    sensors::vlp16::DataPacket packet;
    packet.mode = sensors::vlp16::ReturnMode::Strongest;
    const std::uint64_t first = packet_ * kFirings;
    packet.time_us = static_cast<std::uint32_t>(first * kFiringNs / 1000 % 3'600'000'000U);
    for (std::size_t b = 0; b < sensors::vlp16::kBlocks; ++b) {
      const auto centi = static_cast<std::uint32_t>(std::lround(to_deg(azimuth_rad(first + 2 * b)) * 100.0));
      packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(centi % 36'000U);
    }
    fill(packet);
    ++packet_;
    return packet;
  }

 private:
  static constexpr std::uint64_t kFirings = 24;
  static constexpr std::int64_t kFiringNs = 55'296;
  static constexpr std::int64_t kLastChannelNs = 34'560;
  static constexpr std::uint64_t kStream = 0x16;
  static constexpr std::size_t kLasers = 8;
  static constexpr std::size_t kGroup = simulation::RayPacket::kLanes;
  /// The odd places of the firing order aim upwards: 1, 3 ... 15 degrees.
  static constexpr std::size_t channel(std::size_t laser) { return 2 * laser + 1; }
  static std::size_t place(std::size_t firing, std::size_t laser) {
    return (firing / kGroup * kLasers + laser) * kGroup + firing % kGroup;
  }
  [[nodiscard]] double azimuth_rad(std::uint64_t firing) const {
    const double turns =
        static_cast<double>(firing) * (static_cast<double>(kFiringNs) * 1e-9) * spec_.rate_hz;
    return (turns - std::floor(turns)) * 2.0 * kPi;
  }
  void aim(const simulation::View& view) {
    beams_.reset(kFirings * kLasers);
    for (std::size_t f = 0; f < kFirings; ++f) {
      const std::uint64_t firing = packet_ * kFirings + f;
      const Duration time(static_cast<std::int64_t>(firing) * kFiringNs);
      const auto from = simulation::sensor_pose(view.world, view.track.at(time), mounting_);
      const double azimuth = azimuth_rad(firing), ca = std::cos(azimuth), sa = std::sin(azimuth);
      for (std::size_t l = 0; l < kLasers; ++l) {
        const auto& [cs, ss, ce, se] = turns_[l];
        const double x = ca * cs - sa * ss, y = sa * cs + ca * ss;
        beams_.set(place(f, l), from, ce * x, -ce * y, se);
      }
    }
  }
  void fill(sensors::vlp16::DataPacket& packet) const {
    simulation::Random random(seed_, kStream, packet_);
    const simulation::EchoOptions options{static_cast<float>(spec_.noise_m), spec_.dropout, 0.0, 0.4F,
                                          static_cast<float>(spec_.range_max_m)};
    for (std::size_t f = 0; f < kFirings; ++f)
      for (std::size_t c = 0; c < sensors::vlp16::kChannels; ++c) {
        if (c % 2 == 0) {  // each laser has its own draw, measured or not
          (void)random.next();
          continue;
        }
        const auto hits = simulation::meet(beams_.spot(place(f, c / 2)), {}, 0.0F);
        const auto echo = simulation::echoes_of(hits, options, {}, 0.0F, random).strongest;
        if (echo.range_m == simulation::Hit::kNothing) continue;
        packet.blocks[f / 2].returns[f % 2 * sensors::vlp16::kChannels + c] = {
            static_cast<std::uint16_t>(std::lround(echo.range_m / sensors::vlp16::kMetresPerUnit)),
            simulation::reflectivity(echo.material)};
      }
  }

  /// How far a laser is turned since its firing's begin, and its elevation: cosine and sine of each.
  struct Turn {
    double cos_step, sin_step, cos_elevation, sin_elevation;
  };

  std::array<Turn, kLasers> turns_{};
  mapping::SensorRecord mounting_;
  simulation::Vlp16Spec spec_;
  std::uint64_t seed_;
  std::uint64_t packet_ = 0;
  simulation::BeamBatch beams_;
};

}  // namespace madori::test
