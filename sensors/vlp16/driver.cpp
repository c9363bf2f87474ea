#include "sensors/vlp16/driver.hpp"

#include <utility>

#include "core/angle.hpp"
#include "sensors/vlp16/receiver.hpp"

namespace madori::sensors::vlp16 {
namespace {

/// By the data sheet: 16 lasers from -15 to 15 deg; 10 Hz, as it leaves the factory.
LidarModel model(const LidarSettings& settings) {
  settings.refuse_others({"position_port", "rate_hz"});
  const double rate_hz = settings.number_or("rate_hz", 10.0, 5.0, 20.0);
  LidarModel m;
  m.name = settings.name;
  m.type = "vlp16";
  m.kind = LidarKind::Spinning;
  m.mounting = settings.mounting;
  m.from_rad = -kPi;
  m.to_rad = kPi;
  m.step_rad = to_rad(0.02 * rate_hz);
  m.min_elevation_rad = to_rad(-15.0);
  m.max_elevation_rad = to_rad(15.0);
  m.ring_step_rad = to_rad(2.0);
  m.period_s = 1.0 / rate_hz;
  m.range_max_m = 100.0;
  m.sigma_m = 0.03;
  m.bias_m = 0.03;
  m.beam_m = 0.0095;
  m.beam_spread_rad = 0.003;
  return m;
}

LidarSweep sweep_of(Frame& frame) {
  return {std::move(frame.cloud), frame.first_firing_us, ""};
}

class Decoder final : public LidarDecoder {
 public:
  Decoder(const LidarSettings& /*settings*/, SweepSink sink)
      : sink_(std::move(sink)), assembler_([this](Frame& frame) {
          LidarSweep sweep = sweep_of(frame);
          sink_(sweep);
        }) {}

  void push(std::span<const std::uint8_t> bytes, Stamp received) override {
    (void)assembler_.push(bytes, received);
  }
  [[nodiscard]] LidarCounters counters() const override {
    const auto& c = assembler_.counters();
    return {c.frames, c.lost, c.refused};
  }

 private:
  SweepSink sink_;
  Assembler assembler_;
};

class Driver final : public LidarDriver {
 public:
  Driver(const LidarSettings& settings, SweepSink sink, BytesTap tap)
      : sink_(std::move(sink)),
        receiver_(
            options(settings),
            [this](Frame& frame) {
              LidarSweep sweep = sweep_of(frame);
              sink_(sweep);
            },
            std::move(tap)) {}

  [[nodiscard]] LidarHealth health() const override {
    const auto counters = receiver_.counters();
    LidarHealth health{receiver_.silence(), {counters.frames, counters.lost, counters.refused}, "", ""};
    if (const auto foreign = receiver_.foreign_sensor(); !foreign.empty())
      health.problem = "a " + foreign + " sends here, not a VLP-16";
    else if (const auto other = receiver_.stranger(); !other.empty())
      health.problem = other + " sends to its port too and is ignored: switch that one off";
    else if (health.silence > std::chrono::seconds(1) && receiver_.hears_others())
      health.problem = "what sends to " + place() + " is no VLP-16: check its address and its kind";
    else if (health.silence > std::chrono::seconds(1))
      health.problem = "no packets on " + place();
    else if (receiver_.rotor_stands())
      health.problem = "its packets come, but its rotor does not turn: look at its motor and its rpm setting";
    return health;
  }
  [[nodiscard]] std::string place() const override { return "UDP " + std::to_string(receiver_.data_port()); }
  [[nodiscard]] std::uint16_t port() const override { return receiver_.data_port(); }

 private:
  static ReceiverOptions options(const LidarSettings& settings) {
    const auto at = host_and_port(settings.address, {"0.0.0.0", kDataPort});
    const double position = settings.number_or("position_port", kPositionPort, 0.0, 65'535.0);
    return {at.host, at.port, static_cast<std::uint16_t>(position)};
  }

  SweepSink sink_;
  Receiver receiver_;  ///< last: its threads use all of the above
};

}  // namespace

LidarRow row() {
  return {"vlp16", "VLP-16", LidarLink::Udp,  "0.0.0.0:2368", false,
          true,    model,    made<Decoder>(), made<Driver>()};
}

}  // namespace madori::sensors::vlp16
