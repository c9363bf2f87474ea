#include "simulation/sensor_suite.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/lms1xx/encode.hpp"
#include "sensors/s300/encode.hpp"
#include "sensors/vlp16/encode.hpp"

namespace madori::simulation {
namespace {

namespace lms1xx = sensors::lms1xx;
namespace s300 = sensors::s300;

constexpr Duration kS300Period = std::chrono::milliseconds(40);
constexpr Duration kHour = std::chrono::hours(1);
constexpr std::uint64_t kLmsStream = 0x1115, kS300Stream = 0x300, kBiasStream = 0xB1A5'0000;
constexpr std::size_t kRaysABeam = 5;

const char* type_of(Device device) {
  return device == Device::Drive ? "" : to_string(device);
}

/// A whole number among a sensor's settings.
int setting(const mapping::SensorRecord& record, const char* key, int otherwise) {
  const auto found = record.settings.find(key);
  return found == record.settings.end() ? otherwise : std::stoi(found->second);
}

bool is_binary(const mapping::SensorRecord& record) {
  const auto found = record.settings.find("cola");
  return found == record.settings.end() || found->second != "A";
}

/// Of a telegram of all distances, ten bits a byte.
Duration on_the_line(const mapping::SensorRecord& record, std::size_t bytes) {
  return duration_from_seconds(10.0 * static_cast<double>(bytes) / setting(record, "baud", 500'000));
}

std::uint16_t rssi(const Echo& echo) {
  return echo.range_m == Hit::kNothing ? std::uint16_t{0} : reflectivity(echo.material);
}

}  // namespace

std::vector<mapping::SensorRecord> default_sensors(const mapping::VehicleRecord& vehicle) {
  const double front = vehicle.length_m - vehicle.base_to_rear_m;
  const S300Spec field;
  return {{"top", "vlp16", front / 2.0, 0.0, 1.2, 0.0},
          {"front", "lms1xx", front - 0.05, 0.0, 0.18, 0.0},
          {"safety", "s300", front - 0.02, 0.0, 0.15, 0.0, field.protective_m, {}, {}, field.side_m}};
}

SensorSuite::SensorSuite(const Scenario& scenario, const mapping::VehicleRecord& vehicle,
                         const std::vector<mapping::SensorRecord>& sensors, std::uint64_t seed, Stamp epoch)
    : scenario_(scenario), vehicle_(vehicle), sensors_(sensors.empty() ? default_sensors(vehicle) : sensors) {
  const Duration hour_offset = epoch.time_since_epoch() % kHour;
  for (const Device device : {Device::Vlp16, Device::Lms1xx, Device::S300}) {
    std::size_t unit = 0;
    for (auto& sensor : sensors_) {
      if (sensor.type != type_of(device)) continue;
      if (device == Device::Lms1xx) sensor.settings.try_emplace("cola", scenario.lms1xx.binary ? "B" : "A");
      add(device, sensor, unit++, seed, hour_offset);
    }
  }
}

void SensorSuite::add(Device device, const mapping::SensorRecord& record, std::size_t unit,
                      std::uint64_t seed, Duration hour_offset) {
  constexpr std::uint64_t kNextUnit = 0x10000;
  if (device == Device::Vlp16)
    return void(vlp16_.emplace_back(record, scenario_.vlp16, seed + unit * kNextUnit, hour_offset));
  const bool lms = device == Device::Lms1xx;
  const LidarErrors& errors = lms ? static_cast<const LidarErrors&>(scenario_.lms1xx) : scenario_.s300;
  const double range_max_m = lms ? scenario_.lms1xx.range_max_m : scenario_.s300.range_max_m;
  PlaneScannerOptions options;
  options.period = kS300Period;
  options.every = setting(record, "every", 1);
  options.echo = {static_cast<float>(errors.noise_m), errors.dropout, errors.rain, 0.05F,
                  static_cast<float>(range_max_m)};
  options.spot = BeamSpot(errors.beam_m, errors.beam_spread_rad, kRaysABeam);
  options.lean = {errors.pitch_deg, errors.roll_deg};
  options.stream = (lms ? kLmsStream : kS300Stream) + unit * kNextUnit;
  Random of_device(seed, options.stream + kBiasStream, 0);
  options.bias = RangeBias(errors.bias_m, of_device);
  if (lms) {
    const int rate_hz = setting(record, "rate_hz", 50);
    options.period = Duration(std::chrono::seconds(1)) / rate_hz;
    options.beams_a_degree = 100 / rate_hz;
  }
  (lms ? lms_ : s300_).push_back({record, unit, PlaneScanner(record, options, seed), {}});
}

std::optional<mapping::SensorRecord> SensorSuite::mounting(Device device) const {
  const auto found = std::find_if(sensors_.begin(), sensors_.end(),
                                  [&](const auto& s) { return s.type == type_of(device); });
  return found == sensors_.end() ? std::nullopt : std::optional(*found);
}

void SensorSuite::measure_until(Duration now, const View& view, Mailbox& out) {
  for (std::size_t unit = 0; unit < vlp16_.size(); ++unit)
    while (vlp16_[unit].next_complete() <= now) {
      const Duration due = vlp16_[unit].next_complete();
      const auto bytes = sensors::vlp16::encode(vlp16_[unit].measure(view));
      out.send(Device::Vlp16, {bytes.begin(), bytes.end()}, due, unit);
    }
  for (Scanner& lms : lms_)
    while (lms.scanner.next_complete() <= now) {
      const Duration start = lms.scanner.next_start(), due = lms.scanner.next_complete();
      out.send(Device::Lms1xx, lms_telegram(lms, lms.scanner.measure(view), start, due), due, lms.unit);
    }
  for (Scanner& s300 : s300_)
    while (s300.scanner.next_complete() <= now) {
      const Duration due = s300.scanner.next_complete();
      const bool standby = out.active(FaultKind::Standby, Device::S300, to_seconds(due)) != nullptr;
      auto bytes = s300_telegram(s300, s300.scanner.measure(view), standby);
      const Duration heard = due + on_the_line(s300.record, bytes.size());
      out.send(Device::S300, std::move(bytes), heard, s300.unit);
    }
}

std::vector<std::uint8_t> SensorSuite::lms_telegram(const Scanner& lms, const std::vector<Echo>& echoes,
                                                    Duration start, Duration now) {
  lms1xx::ScanData data;
  const std::uint64_t number = lms.scanner.scans();
  const auto step = static_cast<std::uint16_t>(270.0 * 1e4 / static_cast<double>(lms.scanner.beams() - 1));
  data.telegram_counter = data.scan_counter = static_cast<std::uint16_t>(number);
  data.scan_time_us = static_cast<std::uint32_t>(start.count() / 1000);
  data.transmit_time_us = static_cast<std::uint32_t>(now.count() / 1000);
  lms1xx::Channel<std::uint16_t> distance{{'D', 'I', 'S', 'T', '1'}, 1.0F, 0.0F, -450'000, step, {}};
  lms1xx::Channel<std::uint8_t> strength{{'R', 'S', 'S', 'I', '1'}, 1.0F, 0.0F, -450'000, step, {}};
  for (const Echo& echo : echoes) {
    const bool seen = echo.range_m != Hit::kNothing;
    distance.values.push_back(seen ? static_cast<std::uint16_t>(std::lround(echo.range_m * 1000.0F))
                                   : std::uint16_t{0});
    strength.values.push_back(static_cast<std::uint8_t>(rssi(echo)));
  }
  data.channels16.push_back(std::move(distance));
  data.channels8.push_back(std::move(strength));
  return lms1xx::encode(is_binary(lms.record) ? lms1xx::Dialect::B : lms1xx::Dialect::A, data);
}

std::uint16_t SensorSuite::field_bits(const mapping::SensorRecord& at, float range_m,
                                      double angle_rad) const {
  const Transform2<Base, Lidar> base_from_lidar(at.x_m, at.y_m, to_rad(at.yaw_deg));
  const Point2<Base> p =
      base_from_lidar * Point2<Lidar>{range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)};
  const double front = vehicle_.length_m - vehicle_.base_to_rear_m;
  if (std::abs(p.y_m) > vehicle_.width_m / 2.0 + scenario_.s300.side_m || p.x_m < front - 0.1) return 0;
  std::uint16_t bits = 0;
  if (p.x_m < front + scenario_.s300.protective_m) bits |= s300::kProtectiveField;
  if (p.x_m < front + scenario_.s300.warning_m) bits |= s300::kWarningField;
  return bits;
}

/// A field is entered where two scans in a row say so (the device's multiple sampling as delivered): a single
/// wrong point stops nobody. The scans between those that are sent were sampled by the device itself.
std::vector<std::uint16_t> SensorSuite::sampled_fields(Scanner& s300, const std::vector<Echo>& echoes) const {
  constexpr std::size_t kTurnsBy = 2;  // beams, between two scans of a vehicle that turns
  std::vector<std::uint16_t> now(echoes.size());
  for (std::size_t i = 0; i < echoes.size(); ++i)
    if (echoes[i].range_m != Hit::kNothing)
      now[i] = field_bits(s300.record, echoes[i].range_m, s300.scanner.angle_rad(i));
  if (setting(s300.record, "every", 1) > 1) return now;
  std::vector<std::uint16_t> sampled(now.size());
  for (std::size_t i = 0; i < now.size() && !s300.in_fields.empty(); ++i) {
    std::uint16_t before = 0;
    for (std::size_t k = i - std::min(i, kTurnsBy); k <= std::min(i + kTurnsBy, now.size() - 1); ++k)
      before = static_cast<std::uint16_t>(before | s300.in_fields[k]);
    sampled[i] = now[i] & before;
  }
  s300.in_fields = std::move(now);
  return sampled;
}

std::vector<std::uint8_t> SensorSuite::s300_telegram(Scanner& s300, const std::vector<Echo>& echoes,
                                                     bool standby) {
  s300::Telegram telegram;
  telegram.scan_number = static_cast<std::uint32_t>(s300.scanner.turns());
  telegram.telegram_number = static_cast<std::uint16_t>(s300.scanner.scans());
  const auto fields = sampled_fields(s300, echoes);
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    const float range_m = echoes[i].range_m;
    std::uint16_t value = s300::kDistanceMask;  // 81.91 m: nothing seen
    if (range_m != Hit::kNothing)
      value =
          static_cast<std::uint16_t>(static_cast<std::uint16_t>(std::lround(range_m * 100.0F)) | fields[i]);
    telegram.values.push_back(standby ? s300::kStandbyValue : value);
  }
  return s300::encode(telegram);
}

}  // namespace madori::simulation
