#include "sensors/vlp16/assembler.hpp"

#include <algorithm>
#include <cmath>

#include "core/angle.hpp"

namespace madori::sensors::vlp16 {
namespace {

constexpr std::int64_t kLateUs = 1'000'000;     ///< further back it is the clock that jumped
constexpr std::int64_t kSilenceUs = 1'000'000;  ///< longer: what was gathered belongs to no common frame
constexpr std::int64_t kDoubtUs = 100'000;      ///< one turn: less than it takes to count as silent
constexpr int kMaxGapCdeg = 400;                ///< 20 Hz turn 0.8 deg a block; a lost block doubles it
constexpr int kMaxBackCdeg = 100;               ///< a standing rotor's azimuth trembles
constexpr double kCircleCdeg = 36'000.0;
constexpr std::int64_t kLongestTurnUs = 250'000;  ///< 5 Hz is the slowest; its motor may lag a little
constexpr double kShortestStepUs = 1200.0;        ///< of a VLP-16 in single return mode
constexpr std::size_t kPointsToExpect = 30'000;

struct Trigonometry {
  std::array<float, kChannels> cos{}, sin{};
};
const Trigonometry& elevation() {
  static const Trigonometry table = [] {
    Trigonometry t;
    for (std::size_t c = 0; c < kChannels; ++c) {
      t.cos[c] = static_cast<float>(kMetresPerUnit * std::cos(to_rad(kElevationsDeg[c])));
      t.sin[c] = static_cast<float>(kMetresPerUnit * std::sin(to_rad(kElevationsDeg[c])));
    }
    return t;
  }();
  return table;
}

/// Azimuths of one block's 32 returns: exact at the start, then turned by small angles (error below 1e-9).
struct Directions {
  std::array<float, kReturns> cos, sin;

  Directions(double azimuth_cdeg, double gap_cdeg) {
    const double start = to_rad(azimuth_cdeg / 100.0);
    const double cos_start = std::cos(start), sin_start = std::sin(start);
    const double rad_per_us = to_rad(gap_cdeg / 100.0) / (2.0 * kFiringUs);
    for (std::size_t i = 0; i < kReturns; ++i) {
      const double a = rad_per_us * time_offset_us(ReturnMode::Strongest, 0, i);
      const double c = 1.0 - a * a / 2.0 + a * a * a * a / 24.0;
      const double s = a - a * a * a / 6.0;
      cos[i] = static_cast<float>(cos_start * c - sin_start * s);
      sin[i] = static_cast<float>(sin_start * c + cos_start * s);
    }
  }
};

}  // namespace

Assembler::Assembler(FrameSink sink, AssemblerOptions options) : sink_(std::move(sink)), options_(options) {
  frame_.cloud.points.reserve(kPointsToExpect);
}

PushVerdict Assembler::push(std::span<const std::uint8_t> packet, Stamp received) {
  if (decode(packet, packet_) != PacketFault::None || !find_gaps())
    return ++counters_.refused, PushVerdict::Refused;
  if (!foreign_sensor_.empty() && stays_foreign()) return ++counters_.refused, PushVerdict::ForeignSensor;
  const PushVerdict verdict = check_order(received);
  if (verdict != PushVerdict::Taken) return verdict;
  ++counters_.packets;
  for (std::size_t b = 0; b < kBlocks; ++b) add_block(b);
  return PushVerdict::Taken;
}

PushVerdict Assembler::check_order(Stamp received) {
  if (!started_) {
    packet_us_ = packet_.time_us;
  } else {
    const std::int64_t step_us = since(packet_us_);
    const bool jumped = step_us <= -kLateUs || step_us > kSilenceUs;
    if (!jumped) doubt_.reset();
    if (step_us == 0) return ++counters_.duplicates, PushVerdict::Duplicate;
    if (step_us < 0 && !jumped) return ++counters_.late, PushVerdict::Late;
    if (jumped && !is_new_time(received)) return ++counters_.late, PushVerdict::Late;
    if (jumped) {
      restart(step_us);
    } else {
      if (is_too_fast()) return ++counters_.refused, PushVerdict::ForeignSensor;
      const double steps = static_cast<double>(step_us) / packet_us(packet_.mode);
      counters_.lost += static_cast<std::uint64_t>(std::max(0LL, std::llround(steps) - 1));
      const bool turn_is_missing =
          gap_cdeg_[0] * static_cast<double>(step_us) > kCircleCdeg * 2.0 * kFiringUs;
      if (turn_is_missing) finish_frame();
      packet_us_ += step_us;
    }
    if (packet_.mode != mode_) finish_frame();
  }
  started_ = true;
  taken_ = received;
  seen_us_ = packet_us_;
  mode_ = packet_.mode;
  clock_.observe(packet_us_ + std::llround(packet_us(packet_.mode)), received);
  return PushVerdict::Taken;
}

/// From an unwrapped time to this packet, the shorter way round the hour.
std::int64_t Assembler::since(std::int64_t time_us) const {
  constexpr std::int64_t kHour = kMicrosecondsPerHour;
  const std::int64_t step_us = static_cast<std::int64_t>(packet_.time_us) - time_us % kHour;
  if (step_us < -kHour / 2) return step_us + kHour;
  return step_us > kHour / 2 ? step_us - kHour : step_us;
}

/// Whether a packet of another time tells that the sensor was silent or its clock was set. What a network has
/// kept, or sends twice, lies between packets of the right time or comes faster than it was measured: a clock
/// that was set is believed after a turn of the new time alone.
bool Assembler::is_new_time(Stamp received) {
  if (received - taken_ > std::chrono::microseconds(kSilenceUs)) return true;
  const std::int64_t step_us = doubt_ ? since(doubt_->last_us) : 0;
  if (step_us <= 0 || step_us > kSilenceUs) {
    doubt_ = Doubt{packet_.time_us, packet_.time_us, received};
    return false;
  }
  doubt_->last_us = packet_.time_us;
  const std::int64_t measured_us = since(doubt_->first_us);
  return measured_us >= kDoubtUs && received - doubt_->begun >= std::chrono::microseconds(measured_us / 2);
}

/// The sensor was silent, or its clock was set: what was gathered ends here.
void Assembler::restart(std::int64_t step_us) {
  finish_frame();
  clock_.reset();
  doubt_.reset();
  ++counters_.silences;
  packet_us_ = step_us < 0 ? packet_.time_us : packet_us_ + step_us;
  impossible_steps_ = 0;
}

/// A VLP-16 needs 1327 us (663 us dual) for a packet and cannot send earlier; its brothers of more lasers do,
/// in packets that look the same. One early packet is thrown away, a second one gives them their name.
bool Assembler::is_too_fast() {
  const double scale = packet_.mode == ReturnMode::Dual ? 2.0 : 1.0;
  const std::int64_t step_us = since(seen_us_);
  if (step_us <= 0) return true;
  seen_us_ += step_us;
  const double single_us = scale * static_cast<double>(step_us);
  if (single_us >= kShortestStepUs && scale * static_cast<double>(since(packet_us_)) >= kShortestStepUs) {
    impossible_steps_ = 0;
    return false;
  }
  if (++impossible_steps_ < 3) return true;
  if (std::abs(single_us - 553.0) < 8.0)
    foreign_sensor_ = "HDL-32E";
  else if (std::abs(single_us - 663.5) < 8.0)
    foreign_sensor_ = "VLP-32C";
  else
    foreign_sensor_ = "sensor that sends faster than a VLP-16";
  drop_frame();
  return true;
}

/// Until packets have come for a second as a VLP-16 sends them.
bool Assembler::stays_foreign() {
  constexpr int kPossibleSteps = 750;
  const double scale = packet_.mode == ReturnMode::Dual ? 2.0 : 1.0;
  const std::int64_t step_us = since(seen_us_);
  seen_us_ += step_us;
  const double single_us = scale * static_cast<double>(step_us);
  possible_steps_ = single_us >= kShortestStepUs && step_us <= kSilenceUs ? possible_steps_ + 1 : 0;
  if (possible_steps_ < kPossibleSteps) return true;
  begin_anew();
  return false;
}

void Assembler::begin_anew() {
  started_ = false;
  doubt_.reset();
  foreign_sensor_.clear();
  impossible_steps_ = possible_steps_ = 0;
  rotor_stands_ = false;
  drop_frame();
  clock_.reset();
}

/// The azimuth that passes in each block: to the next one, in dual mode to the next pair; the packet's last
/// takes its forerunner's.
bool Assembler::find_gaps() {
  const std::size_t stride = packet_.mode == ReturnMode::Dual ? 2 : 1;
  for (std::size_t b = 0; b + stride < kBlocks; ++b) {
    int gap = (36'000 + packet_.blocks[b + stride].azimuth_cdeg - packet_.blocks[b].azimuth_cdeg) % 36'000;
    if (gap >= 36'000 - kMaxBackCdeg) gap = 0;
    if (gap > kMaxGapCdeg) return false;
    gap_cdeg_[b] = gap;
  }
  for (std::size_t b = kBlocks - stride; b < kBlocks; ++b) gap_cdeg_[b] = gap_cdeg_[b - stride];
  return true;
}

void Assembler::cut_before(std::uint16_t azimuth_cdeg) {
  const int back = last_azimuth_cdeg_ - azimuth_cdeg;
  if (last_azimuth_cdeg_ >= 0 && back > kMaxBackCdeg) {
    rotor_stands_ = false;
    finish_frame();
  }
  if (back <= 0 || back > kMaxBackCdeg) last_azimuth_cdeg_ = azimuth_cdeg;
}

void Assembler::add_block(std::size_t block) {
  const Block& b = packet_.blocks[block];
  const auto firing_us = packet_us_ + static_cast<std::int64_t>(time_offset_us(packet_.mode, block, 0));
  cut_before(b.azimuth_cdeg);
  if (frame_.blocks > 0 && firing_us - frame_.first_firing_us > kLongestTurnUs) {
    rotor_stands_ = true;
    drop_frame();
  }
  const bool dual = packet_.mode == ReturnMode::Dual;
  const bool is_last = dual && block % 2 == 0;
  if (frame_.blocks++ == 0) frame_.first_firing_us = firing_us;
  if (is_last && options_.dual_return == DualReturn::Strongest) return;
  if (dual && !is_last && options_.dual_return == DualReturn::Last) return;
  const Block* twin =
      is_last && options_.dual_return == DualReturn::Both ? &packet_.blocks[block + 1] : nullptr;
  const Directions direction(b.azimuth_cdeg, gap_cdeg_[block]);
  const auto block_us = static_cast<double>(packet_us_ - frame_.first_firing_us);
  std::array<CloudPoint, kReturns> points;
  std::size_t used = 0;
  for (std::size_t i = 0; i < kReturns; ++i) {
    const Return& r = b.returns[i];
    if (r.distance == 0 || (twin != nullptr && twin->returns[i].distance == r.distance)) continue;
    const std::size_t channel = i % kChannels;
    const float flat_m = static_cast<float>(r.distance) * elevation().cos[channel];
    points[used++] = {flat_m * direction.cos[i],
                      -flat_m * direction.sin[i],
                      static_cast<float>(r.distance) * elevation().sin[channel],
                      static_cast<float>((block_us + time_offset_us(packet_.mode, block, i)) * 1e-6),
                      r.reflectivity,
                      ring_of(channel)};
  }
  frame_.cloud.points.insert(frame_.cloud.points.end(), points.begin(), points.begin() + used);
}

void Assembler::finish_frame() {
  last_azimuth_cdeg_ = -1;
  if (frame_.blocks == 0) return;
  frame_.cloud.stamp = clock_.stamp_of(frame_.first_firing_us);
  ++counters_.frames;
  sink_(frame_);
  frame_.cloud.points.clear();
  frame_.cloud.points.reserve(kPointsToExpect);
  frame_.blocks = 0;
}

void Assembler::drop_frame() {
  last_azimuth_cdeg_ = -1;
  frame_.cloud.points.clear();
  frame_.blocks = 0;
}

void Assembler::flush() {
  finish_frame();
}

}  // namespace madori::sensors::vlp16
