#include "simulation/lidar/vlp16_model.hpp"

#include <array>
#include <cmath>

#include "core/angle.hpp"
#include "simulation/lidar/echo.hpp"
#include "simulation/random.hpp"

namespace madori::simulation {
namespace {

namespace vlp16 = sensors::vlp16;

constexpr std::uint64_t kStream = 0x16, kBiasStream = 0x16'B1A5;
constexpr std::size_t kRaysABeam = 2;  ///< 300,000 beams a second: no more
constexpr std::int64_t kFiringNs = 55'296;
constexpr std::int64_t kLastChannelNs = 34'560;  ///< 15 channels of 2.304 us
constexpr std::int64_t kHourUs = 3'600'000'000;
constexpr std::size_t kGroup = RayPacket::kLanes;  ///< firings whose beams of one channel are cast together

vlp16::Return encode_echo(const Echo& echo) {
  if (echo.range_m == Hit::kNothing) return {};
  return {static_cast<std::uint16_t>(std::lround(echo.range_m / vlp16::kMetresPerUnit)),
          reflectivity(echo.material)};
}

/// Place of a beam in the batch of `kept` firings. Eight neighbouring firings of one channel make one packet
/// of rays, which stay close together; thinned firings fill the packets with the neighbouring channels'
/// beams.
std::size_t place(std::size_t firing, std::size_t channel, std::size_t kept) {
  if (kept % kGroup == 0) return (firing / kGroup * vlp16::kChannels + channel) * kGroup + firing % kGroup;
  return vlp16::ring_of(channel) * kept + firing;
}

}  // namespace

Vlp16Model::Vlp16Model(const mapping::SensorRecord& mounting, const Vlp16Spec& spec, std::uint64_t seed,
                       Duration hour_offset)
    : mounting_(mounting),
      spec_(spec),
      seed_(seed),
      hour_offset_(hour_offset),
      spot_(spec.beam_m, spec.beam_spread_rad, kRaysABeam) {
  Random random(seed, kBiasStream, 0);
  for (RangeBias& laser : bias_) laser = RangeBias(spec.bias_m, random);
}

Duration Vlp16Model::next_complete() const {
  const auto last = static_cast<std::int64_t>((packet_ + 1) * firings() - 1);
  return Duration(last * kFiringNs + kLastChannelNs);
}

double Vlp16Model::azimuth_rad(std::uint64_t firing) const {
  const double turns = static_cast<double>(firing) * (static_cast<double>(kFiringNs) * 1e-9) * spec_.rate_hz;
  return (turns - std::floor(turns)) * 2.0 * kPi;
}

void Vlp16Model::choose_firings() {
  const auto every = static_cast<std::uint64_t>(spec_.keep_every_firing);
  kept_.clear();
  for (std::size_t f = 0; f < firings(); ++f)
    if ((packet_ * firings() + f) % every == 0) kept_.push_back(f);
}

void Vlp16Model::aim(const View& view) {
  beams_.reset(kept_.size() * vlp16::kChannels, spot_);
  const double channel_rad = 2.304e-6 * spec_.rate_hz * 2.0 * kPi;
  struct Laser {
    double cos_elevation, sin_elevation, cos_step, sin_step;
  };
  std::array<Laser, vlp16::kChannels> lasers;
  for (std::size_t c = 0; c < vlp16::kChannels; ++c) {
    const double elevation = to_rad(vlp16::kElevationsDeg[c]), step = channel_rad * static_cast<double>(c);
    lasers[c] = {std::cos(elevation), std::sin(elevation), std::cos(step), std::sin(step)};
  }
  for (std::size_t f = 0; f < kept_.size(); ++f) {
    const std::uint64_t firing = packet_ * firings() + kept_[f];
    const Duration time(static_cast<std::int64_t>(firing) * kFiringNs);
    const SensorPose from =
        sensor_pose(view.world, view.track.at(time), mounting_, {spec_.pitch_deg, spec_.roll_deg});
    const double azimuth = azimuth_rad(firing), ca = std::cos(azimuth), sa = std::sin(azimuth);
    for (std::size_t c = 0; c < vlp16::kChannels; ++c) {
      const Laser& l = lasers[c];
      const double x = ca * l.cos_step - sa * l.sin_step, y = sa * l.cos_step + ca * l.sin_step;
      beams_.set(place(f, c, kept_.size()), from, l.cos_elevation * x, -l.cos_elevation * y, l.sin_elevation);
    }
  }
}

void Vlp16Model::fill(vlp16::DataPacket& packet) const {
  Random random(seed_, kStream, packet_);
  const EchoOptions options{static_cast<float>(spec_.noise_m), spec_.dropout, spec_.rain, 0.4F,
                            static_cast<float>(spec_.range_max_m)};
  const bool wide = spot_.rays().size() > 1;
  for (std::size_t k = 0; k < kept_.size(); ++k) {
    const std::size_t f = kept_[k];
    const std::size_t block = spec_.dual_return ? f / 2 * 2 : f / 2;
    const auto azimuth = static_cast<float>(azimuth_rad(packet_ * firings() + f));
    for (std::size_t c = 0; c < vlp16::kChannels; ++c) {
      const float share = wide ? static_cast<float>(random.uniform()) : 0.0F;
      const SpotHits hits = meet(beams_.spot(place(k, c, kept_.size())), spot_, share);
      const Echoes echoes = echoes_of(hits, options, bias_[c], azimuth, random);
      const std::size_t index = f % 2 * vlp16::kChannels + c;
      packet.blocks[block].returns[index] = encode_echo(spec_.dual_return ? echoes.last : echoes.strongest);
      if (spec_.dual_return) packet.blocks[block + 1].returns[index] = encode_echo(echoes.beside_last());
    }
  }
}

vlp16::DataPacket Vlp16Model::measure(const View& view) {
  choose_firings();
  aim(view);
  beams_.cast(view.world.rays(), view.bodies, static_cast<float>(spec_.range_max_m));
  vlp16::DataPacket packet;
  packet.mode = spec_.dual_return ? vlp16::ReturnMode::Dual : vlp16::ReturnMode::Strongest;
  const std::uint64_t first = packet_ * firings();
  const std::int64_t us = (hour_offset_.count() + static_cast<std::int64_t>(first) * kFiringNs) / 1000;
  packet.time_us = static_cast<std::uint32_t>(us % kHourUs);
  for (std::size_t b = 0; b < vlp16::kBlocks; ++b) {
    const std::uint64_t firing = first + (spec_.dual_return ? b / 2 * 2 : 2 * b);
    const auto centi = static_cast<std::uint32_t>(std::lround(to_deg(azimuth_rad(firing)) * 100.0));
    packet.blocks[b].azimuth_cdeg = static_cast<std::uint16_t>(centi % 36'000U);
  }
  fill(packet);
  ++packet_;
  return packet;
}

}  // namespace madori::simulation
