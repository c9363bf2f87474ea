#include "sensors/lms1xx/scan_data.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "core/angle.hpp"

namespace madori::sensors::lms1xx {
namespace {

constexpr std::size_t kMaxValues = 4096, kMaxChannels = 10, kMaxEncoders = 4;
constexpr std::uint16_t kFirstRange = 16;  ///< smaller values are codes: dazzle, no echo, ...
constexpr double kDegPerUnit = 1e-4;

/// Big-endian fields; after the first one that does not fit everything is zero.
class BinaryReader {
 public:
  explicit BinaryReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}
  template <class Unsigned>
  Unsigned number() {
    if (rest_.size() < sizeof(Unsigned)) return fail(), Unsigned{0};
    Unsigned value = 0;
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
      value = static_cast<Unsigned>((static_cast<std::uint64_t>(value) << 8U) | rest_[i]);
    rest_ = rest_.subspan(sizeof(Unsigned));
    return value;
  }
  std::array<char, 5> name() {
    std::array<char, 5> text{};
    if (rest_.size() < text.size()) return fail(), text;
    std::transform(rest_.begin(), rest_.begin() + text.size(), text.begin(),
                   [](auto b) { return static_cast<char>(b); });
    rest_ = rest_.subspan(text.size());
    return text;
  }
  [[nodiscard]] bool good() const { return good_; }
  void fail() { good_ = false; }

 private:
  std::span<const std::uint8_t> rest_;
  bool good_ = true;
};

/// Space-separated hexadecimal words; "+12" and "-12" are decimal.
class TextReader {
 public:
  explicit TextReader(std::span<const std::uint8_t> bytes)
      : rest_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}
  template <class Unsigned>
  Unsigned number() {
    std::string_view text = word();
    const bool minus = text.starts_with('-'), decimal = minus || text.starts_with('+');
    if (decimal) text.remove_prefix(1);
    std::uint32_t value = 0;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), value, decimal ? 10 : 16);
    if (error != std::errc() || end != text.data() + text.size()) return fail(), Unsigned{0};
    if (value > std::numeric_limits<Unsigned>::max()) return fail(), Unsigned{0};
    return static_cast<Unsigned>(minus ? 0U - value : value);
  }
  std::array<char, 5> name() {
    std::array<char, 5> text{};
    const std::string_view found = word();
    if (found.size() != text.size()) return fail(), text;
    std::copy(found.begin(), found.end(), text.begin());
    return text;
  }
  [[nodiscard]] bool good() const { return good_; }
  void fail() { good_ = false; }

 private:
  std::string_view word() {
    const std::size_t start = std::min(rest_.find_first_not_of(' '), rest_.size());
    const std::size_t end = std::min(rest_.find(' ', start), rest_.size());
    const std::string_view found = rest_.substr(start, end - start);
    rest_.remove_prefix(end);
    return found;
  }
  std::string_view rest_;
  bool good_ = true;
};

/// A count that must stay within `most`.
template <class Reader>
std::size_t count(Reader& in, std::size_t most) {
  const std::size_t found = in.template number<std::uint16_t>();
  if (found > most) in.fail();
  return in.good() ? found : 0;
}

template <class Value, class Reader>
void read_channels(Reader& in, std::vector<Channel<Value>>& channels) {
  channels.resize(count(in, kMaxChannels));
  for (Channel<Value>& channel : channels) {
    channel.name = in.name();
    channel.scale = std::bit_cast<float>(in.template number<std::uint32_t>());
    channel.offset = std::bit_cast<float>(in.template number<std::uint32_t>());
    channel.start_angle = static_cast<std::int32_t>(in.template number<std::uint32_t>());
    channel.angle_step = in.template number<std::uint16_t>();
    channel.values.resize(count(in, kMaxValues));
    for (Value& value : channel.values) value = in.template number<Value>();
    if (!in.good()) return;
  }
}

template <class Reader>
void read_header(Reader& in, ScanData& data) {
  data.version = in.template number<std::uint16_t>();
  data.device = in.template number<std::uint16_t>();
  data.serial = in.template number<std::uint32_t>();
  for (auto& byte : data.status) byte = in.template number<std::uint8_t>();
  data.telegram_counter = in.template number<std::uint16_t>();
  data.scan_counter = in.template number<std::uint16_t>();
  data.scan_time_us = in.template number<std::uint32_t>();
  data.transmit_time_us = in.template number<std::uint32_t>();
  for (auto& byte : data.inputs) byte = in.template number<std::uint8_t>();
  for (auto& byte : data.outputs) byte = in.template number<std::uint8_t>();
  data.layer = in.template number<std::uint16_t>();
  data.scan_frequency = in.template number<std::uint32_t>();
  data.measurement_frequency = in.template number<std::uint32_t>();
  data.encoders.resize(count(in, kMaxEncoders));
  for (EncoderReading& encoder : data.encoders) {
    encoder.position = in.template number<std::uint32_t>();
    encoder.speed = in.template number<std::uint16_t>();
  }
}

template <class Reader>
Result<ScanData> read_scan(Reader in) {
  ScanData data;
  read_header(in, data);
  if (!in.good()) return Result<ScanData>::failure("the header of the scan telegram is damaged");
  read_channels(in, data.channels16);
  if (!in.good()) return Result<ScanData>::failure("a 16-bit channel of the scan telegram is damaged");
  read_channels(in, data.channels8);
  if (!in.good()) return Result<ScanData>::failure("an 8-bit channel of the scan telegram is damaged");
  return data;
}

template <class Value>
const Channel<Value>* find(const std::vector<Channel<Value>>& channels, std::string_view name) {
  for (const auto& channel : channels)
    if (std::string_view(channel.name.data(), channel.name.size()) == name) return &channel;
  return nullptr;
}

template <class Value>
void add_intensities(const Channel<Value>* rssi, LaserScan& scan) {
  if (rssi == nullptr || rssi->values.size() != scan.ranges_m.size() || !std::isfinite(rssi->scale)) return;
  scan.intensities.reserve(rssi->values.size());
  for (const Value value : rssi->values) scan.intensities.push_back(rssi->scale * static_cast<float>(value));
}

/// Why a scanner says of itself that its scan is none; empty where it does not. An LMS5xx sets the error's
/// bit too when its screen is too dirty.
std::string fault_of(const ScanData& data) {
  if ((data.status[1] & 4U) != 0) return "the scanner's front screen is too dirty to measure: clean it";
  return (data.status[1] & 1U) != 0 ? "the scanner reports a device error" : "";
}

}  // namespace

Result<ScanData> decode_scan(Dialect dialect, std::span<const std::uint8_t> payload) {
  const auto head = head_of(payload);
  if (!head || head->name != "LMDscandata" || (head->kind != "sSN" && head->kind != "sRA"))
    return Result<ScanData>::failure("is no LMDscandata telegram");
  return dialect == Dialect::A ? read_scan(TextReader(head->rest)) : read_scan(BinaryReader(head->rest));
}

Result<LaserScan> to_laser_scan(const ScanData& data) {
  if (std::string fault = fault_of(data); !fault.empty()) return Result<LaserScan>::failure(std::move(fault));
  const auto* distances = find(data.channels16, "DIST1");
  if (distances == nullptr) distances = find(data.channels16, "DIST2");
  if (distances == nullptr) return Result<LaserScan>::failure("the telegram has no distance channel");
  const float scale = distances->scale, offset_mm = distances->offset;
  if (!std::isfinite(offset_mm) || !(scale > 0.0F && scale < 100.0F) || std::abs(offset_mm) > 1e5F ||
      distances->angle_step == 0)
    return Result<LaserScan>::failure("the distance channel has a nonsensical scale, offset or angle step");
  LaserScan scan;
  scan.angle_min_rad = to_rad(kDegPerUnit * distances->start_angle - 90.0);
  scan.angle_step_rad = to_rad(kDegPerUnit * distances->angle_step);
  scan.range_max_m = 65.535 * scale;
  const double turns_per_s = data.scan_frequency / 100.0;
  if (turns_per_s > 0.0)
    scan.beam_period = duration_from_seconds(scan.angle_step_rad / (2.0 * kPi) / turns_per_s);
  scan.ranges_m.reserve(distances->values.size());
  for (const std::uint16_t value : distances->values) {
    const float range_m = (scale * static_cast<float>(value) + offset_mm) * 1e-3F;
    scan.ranges_m.push_back(value < kFirstRange || range_m <= 0.0F ? LaserScan::kNoReturn : range_m);
  }
  add_intensities(find(data.channels8, "RSSI1"), scan);
  if (scan.intensities.empty()) add_intensities(find(data.channels16, "RSSI1"), scan);
  return scan;
}

}  // namespace madori::sensors::lms1xx
