#include "sensors/s300/telegram.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/angle.hpp"
#include "core/crc16.hpp"
#include "sensors/little_endian.hpp"

namespace madori::sensors::s300 {
namespace {

constexpr std::size_t kHeader = 22;  ///< up to and with the content's mark
constexpr std::size_t kMaxBytes = kHeader + 2 + 2 * kMaxValues + 2;
constexpr float kRangeMaxM = 30.0F;
constexpr double kStepDeg = 0.5;

using Span = std::span<const std::uint8_t>;

std::uint32_t big_endian(Span bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = (value << 8U) | bytes[at + i];
  return value;
}

bool crc_fits(Span bytes, std::size_t total) {
  return crc16(bytes.data() + 4, total - 6) == get_u16_le(bytes.data() + total - 2);
}

bool looks_like_header(Span bytes) {
  const bool zeros = std::all_of(bytes.begin(), bytes.begin() + 6, [](auto b) { return b == 0; });
  const std::uint32_t version = big_endian(bytes, 10, 2);
  const std::uint32_t content = big_endian(bytes, 20, 2);
  return zeros && bytes[8] == 0xFF && (bytes[9] == 0x07 || bytes[9] == 0x08) &&
         (version == 0x0201 || version == 0x0301) &&
         (content == 0xAAAA || content == 0xBBBB || content == 0xCCCC);
}

std::optional<Telegram> read(Span bytes, std::size_t total, Variant variant) {
  Telegram telegram;
  telegram.variant = variant;
  telegram.device_address = bytes[9];
  telegram.status = static_cast<std::uint16_t>(big_endian(bytes, 12, 2));
  telegram.scan_number = big_endian(bytes, 14, 4);
  telegram.telegram_number = static_cast<std::uint16_t>(big_endian(bytes, 18, 2));
  telegram.content = static_cast<Content>(big_endian(bytes, 20, 2));
  std::size_t at = kHeader;
  if (telegram.content == Content::InputsOutputs) {
    telegram.field = 0;
  } else {
    if (total < kHeader + 4) return std::nullopt;
    telegram.field = static_cast<std::uint16_t>(big_endian(bytes, at, 2));
    if (telegram.field % 0x1111 != 0 || telegram.field == 0 || telegram.field > 0x5555) return std::nullopt;
    at += 2;
  }
  telegram.values.reserve((total - 2 - at) / 2);
  for (; at + 2 < total; at += 2) telegram.values.push_back(get_u16_le(bytes.data() + at));
  return telegram;
}

}  // namespace

void Stream::push(Span bytes) {
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
  std::size_t start = 0;
  while (buffer_.size() - start >= kHeader) {
    std::size_t used = 1;
    const Outcome outcome = take_one(Span(buffer_).subspan(start), used);
    if (outcome == Outcome::NeedMore) break;
    if (outcome == Outcome::Skip) ++counters_.skipped_bytes;
    start += used;
  }
  buffer_.erase(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(start));
}

Stream::Outcome Stream::take_one(Span bytes, std::size_t& used) {
  if (!looks_like_header(bytes)) return Outcome::Skip;
  const std::size_t stated = 2 * std::size_t{big_endian(bytes, 6, 2)};
  const std::array<std::pair<Variant, std::size_t>, 3> candidates{
      {{Variant::V0201, stated + 4}, {Variant::V0301, stated + 8}, {Variant::V0301WithFields, stated + 14}}};
  const bool old = bytes[10] == 0x02;
  for (const auto& [variant, total] : candidates) {
    if ((variant == Variant::V0201) != old || total < kHeader + 2 || total > kMaxBytes) continue;
    if (bytes.size() < total) return Outcome::NeedMore;
    if (!crc_fits(bytes, total)) continue;
    std::optional<Telegram> telegram = read(bytes, total, variant);
    if (!telegram) break;
    used = total;
    deliver(*telegram);
    return Outcome::Taken;
  }
  ++counters_.damaged;
  return Outcome::Skip;
}

void Stream::deliver(Telegram& telegram) {
  ++counters_.telegrams;
  const std::uint32_t step = telegram.scan_number - last_scan_;
  if (started_ && step > 1 && step < 10'000) counters_.lost += step - 1;
  last_scan_ = telegram.scan_number;
  started_ = true;
  sink_(telegram);
}

Fields fields_of(const Telegram& telegram) {
  Fields fields;
  fields.lockout = telegram.status != 0;
  if (telegram.content != Content::Distances) return fields;
  std::uint16_t any = 0;
  for (const std::uint16_t value : telegram.values) any = static_cast<std::uint16_t>(any | value);
  fields.protective = (any & kProtectiveField) != 0;
  fields.warning = (any & kWarningField) != 0;
  fields.standby = !telegram.values.empty() && std::all_of(telegram.values.begin(), telegram.values.end(),
                                                           [](auto v) { return v == kStandbyValue; });
  return fields;
}

LaserScan to_laser_scan(const Telegram& telegram) {
  LaserScan scan;
  if (telegram.content != Content::Distances) return scan;
  const bool standby = fields_of(telegram).standby;
  scan.angle_step_rad = to_rad(kStepDeg);
  scan.angle_min_rad = to_rad(-135.0);
  scan.range_max_m = kRangeMaxM;
  scan.beam_period = duration_from_seconds(kScanPeriodS * kStepDeg / 360.0);
  scan.ranges_m.reserve(telegram.values.size());
  for (const std::uint16_t value : telegram.values) {
    const float range_m = 0.01F * static_cast<float>(value & kDistanceMask);
    scan.ranges_m.push_back(standby || range_m <= 0.0F || range_m >= kRangeMaxM ? LaserScan::kNoReturn
                                                                                : range_m);
  }
  return scan;
}

}  // namespace madori::sensors::s300
