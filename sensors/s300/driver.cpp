#include "sensors/s300/driver.hpp"

#include <utility>

#include "core/angle.hpp"
#include "sensors/s300/receiver.hpp"

namespace madori::sensors::s300 {
namespace {

constexpr std::size_t kValues = 541;  // of 270 deg in steps of 0.5 deg

unsigned baud_of(const LidarSettings& settings) {
  return static_cast<unsigned>(settings.number_or("baud", kBitsPerSecond, 1'200.0, 4'000'000.0));
}

/// By the data sheet: 270 deg in steps of 0.5 deg, every 40 ms; `every: 2` where the scanner was configured
/// to send each second scan.
LidarModel model(const LidarSettings& settings) {
  settings.refuse_others({"baud", "every"});
  (void)baud_of(settings);
  LidarModel m;
  m.name = settings.name;
  m.type = "s300";
  m.kind = LidarKind::Planar;
  m.mounting = settings.mounting;
  m.from_rad = to_rad(-135.0);
  m.to_rad = to_rad(135.0);
  m.step_rad = to_rad(0.5);
  m.min_elevation_rad = m.max_elevation_rad = m.ring_step_rad = 0.0;
  m.period_s = kScanPeriodS * settings.number_or("every", 1.0, 1.0, 100.0);
  m.range_max_m = 29.9;
  m.sigma_m = 0.02;
  m.bias_m = 0.03;
  m.beam_m = 0.008;
  m.beam_spread_rad = 0.015;
  return m;
}

/// Why the fields alone ask the vehicle to stand.
std::string stop_of(const Fields& fields) {
  if (fields.lockout) return "the safety scanner is locked out: reset it";
  if (fields.standby) return "the safety scanner is in standby";
  return fields.protective ? "something stands in the protective field" : "";
}

class Decoder final : public LidarDecoder {
 public:
  Decoder(const LidarSettings& settings, SweepSink sink)
      : sink_(std::move(sink)), clock_(baud_of(settings)), stream_([this](const Telegram& t) { take(t); }) {}

  void push(std::span<const std::uint8_t> bytes, Stamp received) override {
    received_ = received;
    stream_.push(bytes);
  }
  [[nodiscard]] LidarCounters counters() const override {
    const auto& c = stream_.counters();
    return {sweeps_, c.lost, c.damaged + refused_};
  }

 private:
  void take(const Telegram& telegram) {
    if (telegram.content != Content::Distances) return;
    if (telegram.values.size() != kValues) return void(++refused_);
    ++sweeps_;
    LidarSweep sweep{to_laser_scan(telegram), telegram.scan_number, stop_of(fields_of(telegram))};
    std::get<LaserScan>(sweep.seen).stamp = clock_.stamp_of(telegram, received_);
    sink_(sweep);
  }

  SweepSink sink_;
  ScanClock clock_;
  Stamp received_{};
  Stream stream_;
  std::uint64_t sweeps_ = 0, refused_ = 0;
};

class Driver final : public LidarDriver {
 public:
  Driver(const LidarSettings& settings, SweepSink sink, const BytesTap& /*tap*/)
      : device_(settings.address.empty() ? row().address : settings.address),
        sink_(std::move(sink)),
        receiver_({.device = device_,
                   .values = kValues,
                   .baud = baud_of(settings),
                   .stale_after = stale_after(settings)},
                  [this](const LaserScan& scan, const Fields& fields) {
                    LidarSweep sweep{scan, 0, stop_of(fields)};
                    sink_(sweep);
                  }) {}

  [[nodiscard]] LidarHealth health() const override {
    const auto counters = receiver_.counters();
    const std::string stop = receiver_.stop_reason();
    return {receiver_.silence(), {counters.telegrams, counters.lost, counters.damaged}, stop, stop};
  }
  [[nodiscard]] std::string place() const override { return device_; }

 private:
  /// Five scans.
  static Duration stale_after(const LidarSettings& settings) {
    return duration_from_seconds(5.0 * model(settings).period_s);
  }

  std::string device_;
  SweepSink sink_;
  Receiver receiver_;  ///< last: its thread uses all of the above
};

}  // namespace

LidarRow row() {
  return {"s300", "S300", LidarLink::Serial, "/dev/ttyUSB1", true,
          false,  model,  made<Decoder>(),   made<Driver>()};
}

}  // namespace madori::sensors::s300
