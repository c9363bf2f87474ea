#include "sensors/lms1xx/driver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <utility>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "sensors/lms1xx/client.hpp"

namespace madori::sensors::lms1xx {
namespace {

Dialect dialect_of(const LidarSettings& settings) {
  const auto found = settings.values.find("cola");
  if (found == settings.values.end())
    return host_and_port(settings.address, {"", kPortB}).port == kPortA ? Dialect::A : Dialect::B;
  if (found->second == "A") return Dialect::A;
  if (found->second == "B") return Dialect::B;
  throw Error("sensor " + settings.name, "cola: \"" + found->second + "\" is not known", "write A or B");
}

/// How often a scan is asked for; 0: the scanner sends them by itself.
double poll_hz_of(const LidarSettings& settings) {
  return settings.values.contains("poll_hz") ? settings.number_or("poll_hz", 0.0, 0.3, 25.0) : 0.0;
}

/// LMS111 by its data sheet: 270 deg at 50 Hz and 0.5 deg, or 25 Hz and 0.25 deg.
LidarModel model(const LidarSettings& settings) {
  settings.refuse_others({"cola", "poll_hz", "rate_hz"});
  const double rate_hz = settings.number_or("rate_hz", 50.0, 25.0, 50.0);
  if (rate_hz != 25.0 && rate_hz != 50.0)
    throw Error("sensor " + settings.name, "measures at no such rate", "write rate_hz: 25 or rate_hz: 50");
  (void)dialect_of(settings);
  const double poll_hz = poll_hz_of(settings);
  LidarModel m;
  m.name = settings.name;
  m.type = "lms1xx";
  m.kind = LidarKind::Planar;
  m.mounting = settings.mounting;
  m.from_rad = to_rad(-135.0);
  m.to_rad = to_rad(135.0);
  m.step_rad = to_rad(rate_hz / 100.0);
  m.min_elevation_rad = m.max_elevation_rad = m.ring_step_rad = 0.0;
  m.period_s = 1.0 / (poll_hz > 0.0 ? poll_hz : rate_hz);
  m.range_max_m = 20.0;
  m.sigma_m = 0.015;
  m.bias_m = 0.03;
  m.beam_m = 0.008;
  m.beam_spread_rad = 0.015;
  return m;
}

std::string degrees(double rad) {
  char text[24];
  std::snprintf(text, sizeof text, "%.2f", to_deg(rad));
  return text;
}

/// Why a scan is not the one that the site describes; empty where it is.
std::string differs(const LaserScan& scan, const LidarModel& model) {
  constexpr double kSame = 1e-4;
  if (std::abs(scan.angle_step_rad - model.step_rad) > kSame)
    return "the scanner measures every " + degrees(scan.angle_step_rad) + " deg, the site says every " +
           degrees(model.step_rad) + " deg: set rate_hz, or configure the scanner";
  const double last_rad = scan.angle_rad(scan.ranges_m.empty() ? 0 : scan.ranges_m.size() - 1);
  if (std::abs(scan.angle_min_rad - model.from_rad) > model.step_rad ||
      std::abs(last_rad - model.to_rad) > model.step_rad)
    return "the scanner sees from " + degrees(scan.angle_min_rad) + " to " + degrees(last_rad) +
           " deg instead of " + degrees(model.from_rad) + " to " + degrees(model.to_rad) +
           " deg: configure its whole field of view";
  return "";
}

class Decoder final : public LidarDecoder {
 public:
  Decoder(const LidarSettings& settings, SweepSink sink)
      : model_(model(settings)),
        dialect_(dialect_of(settings)),
        poll_every_us_(polled(settings) ? std::llround(model_.period_s * 1e6) : 0),
        sink_(std::move(sink)),
        splitter_(dialect_),
        clock_(polled(settings)) {}

  void push(std::span<const std::uint8_t> bytes, Stamp received) override {
    splitter_.push(bytes);
    while (const auto payload = splitter_.next()) {
      const auto head = head_of(*payload);
      if (!head || head->name != "LMDscandata" || (head->kind != "sSN" && head->kind != "sRA")) continue;
      take(*payload, received);
    }
  }
  [[nodiscard]] LidarCounters counters() const override {
    return {sweeps_, clock_.lost(), refused_ + splitter_.damaged()};
  }

 private:
  static bool polled(const LidarSettings& settings) { return poll_hz_of(settings) > 0.0; }
  /// Where nobody asks (bytes of a stream that is played): as often as one would be asked for.
  bool is_asked_for(const ScanData& data) {
    constexpr std::int32_t kLateUs = 5'000;
    const auto since_us = static_cast<std::int32_t>(data.scan_time_us - taken_us_);
    if (poll_every_us_ > 0 && any_ && since_us >= 0 && since_us + kLateUs < poll_every_us_) return false;
    taken_us_ = data.scan_time_us;
    any_ = true;
    return true;
  }
  void take(std::span<const std::uint8_t> payload, Stamp received) {
    const auto data = decode_scan(dialect_, payload);
    auto scan = data ? to_laser_scan(data.value()) : Result<LaserScan>::failure(data.reason());
    if (!scan || !differs(scan.value(), model_).empty() || clock_.is_repeated(data.value()))
      return void(++refused_);
    if (!is_asked_for(data.value())) return;
    ++sweeps_;
    LidarSweep sweep{std::move(scan).value(), data.value().scan_time_us, ""};
    std::get<LaserScan>(sweep.seen).stamp = clock_.stamp_of(data.value(), received);
    sink_(sweep);
  }

  LidarModel model_;
  Dialect dialect_;
  std::int64_t poll_every_us_;
  SweepSink sink_;
  Splitter splitter_;
  ScanClock clock_;
  std::uint32_t taken_us_ = 0;  ///< the device's time of the last scan
  bool any_ = false;
  std::uint64_t sweeps_ = 0, refused_ = 0;
};

class Driver final : public LidarDriver {
 public:
  Driver(const LidarSettings& settings, SweepSink sink, const BytesTap& /*tap*/)
      : model_(model(settings)),
        sink_(std::move(sink)),
        client_(options(settings), [this](auto& s, auto& d) { take(s, d); }) {}

  [[nodiscard]] LidarHealth health() const override {
    const auto counters = client_.counters();
    LidarHealth health{client_.silence(),
                       {counters.scans, counters.lost, counters.damaged + counters.refused},
                       client_.problem(),
                       ""};
    const std::scoped_lock lock(mutex_);
    if (health.problem.empty()) health.problem = differs_;
    if (health.problem.empty() && health.silence > silent_after())
      health.problem = "no scans come from " + place();
    return health;
  }
  [[nodiscard]] std::string place() const override {
    return "TCP " + where_.host + ":" + std::to_string(where_.port);
  }
  [[nodiscard]] std::uint16_t port() const override { return where_.port; }

 private:
  [[nodiscard]] Duration silent_after() const {
    return std::max<Duration>(std::chrono::seconds(1), duration_from_seconds(2.5 * model_.period_s));
  }

  ClientOptions options(const LidarSettings& settings) {
    ClientOptions options;
    options.dialect = dialect_of(settings);
    where_ = host_and_port(settings.address, {options.host, options.dialect == Dialect::A ? kPortA : kPortB});
    options.host = where_.host;
    options.port = where_.port;
    options.silence = silent_after();
    if (poll_hz_of(settings) > 0.0) options.poll_every = duration_from_seconds(model_.period_s);
    return options;
  }
  void take(const LaserScan& scan, const ScanData& data) {
    const std::string why = differs(scan, model_);
    {
      const std::scoped_lock lock(mutex_);
      differs_ = why;
    }
    if (!why.empty()) return;
    LidarSweep sweep{scan, data.scan_time_us, ""};
    sink_(sweep);
  }

  LidarModel model_;
  SweepSink sink_;
  HostAndPort where_{};
  mutable std::mutex mutex_;
  std::string differs_;
  Client client_;  ///< last: its thread uses all of the above
};

}  // namespace

LidarRow row() {
  return {"lms1xx", "LMS1xx", LidarLink::Tcp,  "192.168.0.1:2112", false,
          false,    model,    made<Decoder>(), made<Driver>()};
}

}  // namespace madori::sensors::lms1xx
