#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <string>

namespace madori::hmi {

/// The last 30 s as the panel showed them, also for a panel that is opened after something has happened.
/// All members may be called from any thread.
class Replay {
 public:
  static constexpr std::chrono::seconds kLength{30};
  static constexpr std::chrono::milliseconds kPeriod{200};
  static constexpr std::size_t kMostPoints = 2000;  ///< of a scan

  /// A Live of hmi/schema as JSON and a scan frame (may be null); ignored within kPeriod of the one before.
  void add(std::chrono::steady_clock::time_point now, const std::string& live,
           const std::shared_ptr<const std::string>& scan);
  /// Oldest first, each: u32 n, n bytes of JSON, u32 m, m bytes of scan frame (scan_frame.hpp);
  /// little-endian.
  [[nodiscard]] std::string bytes() const;

 private:
  struct Moment {
    std::chrono::steady_clock::time_point when;
    std::string live;
    std::string scan;
  };
  mutable std::mutex mutex_;
  std::deque<Moment> moments_;
};

}  // namespace madori::hmi
