#include "sensors/s300/receiver.hpp"

#include <algorithm>

#include "core/clock.hpp"

namespace madori::sensors::s300 {

Receiver::Receiver(const ReceiverOptions& options, Sink sink)
    : options_(options),
      sink_(std::move(sink)),
      clock_(options.baud),
      stream_([this](const Telegram& telegram) { take(telegram); }) {
  io::LinkEvents events;
  events.bytes = [this](std::span<const std::uint8_t> bytes, Stamp received) {
    received_ = received;
    stream_.push(bytes);
    const std::lock_guard lock(mutex_);
    bytes_at_ = received;
    counters_ = stream_.counters();
  };
  events.closed = [this](const std::string&) {
    const std::lock_guard lock(mutex_);
    any_ = false;
    clock_.reset();
  };
  const Duration silence = std::max<Duration>(std::chrono::seconds(2), 2 * options.stale_after);
  link_ = io::StreamLink::serial(options.device, options.baud, std::move(events), {.silence = silence});
  link_->start();
}

void Receiver::take(const Telegram& telegram) {
  if (telegram.content != Content::Distances) return;
  LaserScan scan = to_laser_scan(telegram);
  const Fields fields = fields_of(telegram);
  {
    const std::lock_guard lock(mutex_);
    scan.stamp = clock_.stamp_of(telegram, received_);
    fields_ = fields;
    heard_ = clock_now();
    any_ = true;
    other_values_ = telegram.values.size() == options_.values ? 0 : telegram.values.size();
    if (other_values_ > 0) return;
  }
  if (sink_) sink_(scan, fields);
}

bool Receiver::is_silent() const {
  return !any_ || clock_now() - heard_ > options_.stale_after;
}

std::string Receiver::stop_reason() const {
  const std::lock_guard lock(mutex_);
  if (is_silent() && clock_now() - bytes_at_ < options_.stale_after)
    return "bytes come on " + options_.device +
           ", but no telegram of a safety scanner: check which device it is, and its baud rate";
  if (is_silent()) return "the safety scanner on " + options_.device + " is silent";
  if (other_values_ > 0)
    return "the safety scanner sends " + std::to_string(other_values_) + " distances instead of " +
           std::to_string(options_.values) + ": configure its whole field of view";
  if (fields_.lockout) return "the safety scanner is locked out: reset it";
  if (fields_.standby) return "the safety scanner is in standby";
  return fields_.protective ? "something stands in the protective field" : "";
}

bool Receiver::must_stop() const {
  return !stop_reason().empty();
}

Duration Receiver::silence() const {
  const std::lock_guard lock(mutex_);
  return clock_now() - heard_;
}

StreamCounters Receiver::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace madori::sensors::s300
