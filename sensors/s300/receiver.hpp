#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "core/laser_scan.hpp"
#include "io/stream_link.hpp"
#include "sensors/s300/scan_clock.hpp"
#include "sensors/s300/telegram.hpp"

namespace madori::sensors::s300 {

struct ReceiverOptions {
  std::string device;        ///< /dev/ttyUSB1, or a pseudo-terminal
  std::size_t values = 541;  ///< distances of a scan; one with others is of a changed field of view
  unsigned baud = 500'000;
  Duration stale_after = std::chrono::milliseconds(200);  ///< five scans
};

/// An S300 on a serial port. Anything but fresh telegrams that say "free" stops the vehicle.
class Receiver {
 public:
  using Sink = std::function<void(const LaserScan& scan, const Fields& fields)>;
  /// `sink` is called from the receiver's thread for every scan of distances.
  explicit Receiver(const ReceiverOptions& options, Sink sink = {});

  /// The last fields; lock-out, standby, silence and a closed port count as an occupied protective field.
  [[nodiscard]] bool must_stop() const;
  /// Why the vehicle must stop, in an operator's words; empty when it need not.
  [[nodiscard]] std::string stop_reason() const;
  [[nodiscard]] StreamCounters counters() const;
  /// Since the last telegram of distances; a large number before the first.
  [[nodiscard]] Duration silence() const;

 private:
  void take(const Telegram& telegram);
  [[nodiscard]] bool is_silent() const;

  ReceiverOptions options_;
  Sink sink_;
  mutable std::mutex mutex_;
  ScanClock clock_;
  Stream stream_;
  Stamp received_{};
  Fields fields_;
  StreamCounters counters_;
  Stamp heard_{};
  Stamp bytes_at_{};              ///< when anything came
  std::size_t other_values_ = 0;  ///< of the last scan, where that was refused
  bool any_ = false;
  std::unique_ptr<io::StreamLink> link_;  ///< last: its thread uses all of the above
};

}  // namespace madori::sensors::s300
