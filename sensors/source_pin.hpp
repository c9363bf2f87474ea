#pragma once

#include <optional>

#include "core/stamp.hpp"
#include "io/udp_receiver.hpp"

namespace madori::sensors {

/// Whose packets are a device's, where anybody may send to its port: the first sender of a good one, until it
/// has sent none for a while. What others send is never mixed in.
class SourcePin {
 public:
  /// Whether a packet may be looked at. `fresh` tells that its sender is not the one before.
  struct Verdict {
    bool admitted = false;
    bool fresh = false;
  };
  [[nodiscard]] Verdict judge(const io::Sender& sender, Stamp now) {
    if (pinned_ && sender == *pinned_) return {true, false};
    if (pinned_ && now - good_ <= kExpires) {
      stranger_ = sender;
      stranger_heard_ = now;
      return {};
    }
    const bool fresh = !candidate_ || *candidate_ != sender;
    candidate_ = sender;
    return {true, fresh};
  }
  /// The packet that was admitted last was a good one.
  void good(const io::Sender& sender, Stamp now) {
    pinned_ = candidate_ = sender;
    good_ = now;
  }

  /// Whether a packet of another port comes from the same device.
  [[nodiscard]] bool is_host(const io::Sender& sender) const {
    return !pinned_ || sender.address == pinned_->address;
  }
  /// Who else sends here, while that goes on.
  [[nodiscard]] std::optional<io::Sender> stranger(Stamp now) const {
    return now - stranger_heard_ <= kTold ? stranger_ : std::nullopt;
  }

 private:
  /// A lidar that restarts needs longer; one whose cable is bad keeps its place.
  static constexpr Duration kExpires = std::chrono::seconds(1);
  static constexpr Duration kTold = std::chrono::seconds(5);

  std::optional<io::Sender> pinned_;
  std::optional<io::Sender> candidate_;  ///< whose packets were looked at last
  Stamp good_{};
  std::optional<io::Sender> stranger_;
  Stamp stranger_heard_{};
};

}  // namespace madori::sensors
