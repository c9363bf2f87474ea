#include "sensors/s300/receiver.hpp"

#include <cmath>

#include "core/clock.hpp"

namespace madori::sensors::s300 {
namespace {

/// From the first beam to the last byte: the 270 deg that are seen, then 1108 bytes of ten bits.
std::int64_t delay_us(const Telegram& telegram) {
  const auto values = static_cast<double>(telegram.values.size());
  const double sweep_s = kScanPeriodS * values * 0.5 / 360.0;
  return std::llround((sweep_s + (26.0 + 2.0 * values) * 10.0 / kBitsPerSecond) * 1e6);
}

}  // namespace

Receiver::Receiver(const ReceiverOptions& options, Sink sink)
    : options_(options),
      sink_(std::move(sink)),
      stream_([this](const Telegram& telegram) { take(telegram); }) {
  io::LinkEvents events;
  events.bytes = [this](std::span<const std::uint8_t> bytes, Stamp received) {
    received_ = received;
    stream_.push(bytes);
    const std::lock_guard lock(mutex_);
    counters_ = stream_.counters();
  };
  events.closed = [this](const std::string&) {
    const std::lock_guard lock(mutex_);
    any_ = false;
    clock_.reset();
  };
  link_ = io::StreamLink::serial(options.device, options.baud, std::move(events));
  link_->start();
}

void Receiver::take(const Telegram& telegram) {
  if (telegram.content != Content::Distances) return;
  LaserScan scan = to_laser_scan(telegram);
  const Fields fields = fields_of(telegram);
  {
    const std::lock_guard lock(mutex_);
    const std::int64_t scan_us = std::int64_t{telegram.scan_number} * std::llround(kScanPeriodS * 1e6);
    clock_.observe(scan_us + delay_us(telegram), received_);
    scan.stamp = clock_.stamp_of(scan_us);
    fields_ = fields;
    heard_ = clock_now();
    any_ = true;
  }
  if (sink_) sink_(scan, fields);
}

std::string Receiver::stop_reason() const {
  const std::lock_guard lock(mutex_);
  if (!any_ || clock_now() - heard_ > options_.stale_after)
    return "the safety scanner on " + options_.device + " is silent";
  if (fields_.lockout) return "the safety scanner is locked out: reset it";
  if (fields_.standby) return "the safety scanner is in standby";
  return fields_.protective ? "something stands in the protective field" : "";
}

bool Receiver::must_stop() const {
  return !stop_reason().empty();
}

StreamCounters Receiver::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace madori::sensors::s300
