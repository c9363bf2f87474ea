#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "core/laser_scan.hpp"
#include "io/stream_link.hpp"
#include "sensors/lms1xx/cola.hpp"
#include "sensors/lms1xx/scan_clock.hpp"
#include "sensors/lms1xx/scan_data.hpp"

namespace madori::sensors::lms1xx {

struct ClientOptions {
  std::string host = "192.168.0.1";
  std::uint16_t port = kPortB;
  Dialect dialect = Dialect::B;
  bool with_rssi = true;
  Duration poll_every{0};  ///< each scan is asked for, so often; 0: the scanner sends all by itself
  Duration silence = std::chrono::seconds(1);  ///< no bytes for so long: connected anew
  Duration reconnect_after = std::chrono::milliseconds(500);
};

enum class ClientState { Disconnected, Starting, Measuring };

struct ClientCounters {
  std::uint64_t connections = 0, scans = 0, lost = 0, damaged = 0, refused = 0;
};

/// An LMS1xx (or LMS5xx) on the network: start-up dialogue, scans, and all of it again after a loss. Scans
/// are sent by the device as it measures them, or asked for one by one.
class Client {
 public:
  using Sink = std::function<void(const LaserScan& scan, const ScanData& data)>;
  /// `sink` is called from the client's thread.
  Client(const ClientOptions& options, Sink sink);
  ~Client();
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  [[nodiscard]] ClientState state() const;
  [[nodiscard]] ClientCounters counters() const;
  /// What is wrong, in words: no connection, a refused command, the device's own error; empty when nothing
  /// is.
  [[nodiscard]] std::string problem() const;
  /// Since the last good scan; a large number before the first.
  [[nodiscard]] Duration silence() const;

 private:
  void opened();
  void receive(std::span<const std::uint8_t> bytes, Stamp received);
  void take_reply(const Head& head);
  void take_scan(std::span<const std::uint8_t> payload, Stamp received);
  void send_next();
  void poll(const std::stop_token& stop);
  [[nodiscard]] bool is_polled() const { return options_.poll_every > Duration(0); }
  /// Bytes came that make no telegram.
  [[nodiscard]] bool speaks_other() const;

  ClientOptions options_;
  Sink sink_;
  std::vector<Message> dialogue_;
  std::size_t step_ = 0;  ///< the command whose answer is awaited
  Splitter splitter_;
  bool any_head_ = false;             ///< of a telegram, since the link was opened
  std::uint64_t skipped_before_ = 0;  ///< bytes, when it was opened
  ScanClock clock_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  ClientState state_ = ClientState::Disconnected;
  ClientCounters counters_;
  std::string problem_ = "not connected yet";
  Stamp heard_{};
  std::unique_ptr<io::StreamLink> link_;  ///< its thread uses all of the above
  std::jthread poller_;                   ///< ... and this one the link
};

}  // namespace madori::sensors::lms1xx
