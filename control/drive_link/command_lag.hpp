#pragma once

#include <array>
#include <cstdint>

#include "core/stamp.hpp"

namespace madori::control {

/// How far the drive is behind what it was told: each status names the last command that the controller took,
/// and when the next one was given is known here. A command that was overtaken on its way counts as well as
/// one that is still under way: the wheels turn by an older one either way.
class CommandLag {
 public:
  void told(std::uint16_t sequence, Stamp at) {
    told_[sequence % kMost] = at;
    newest_ = sequence;
    if (count_ < kMost) ++count_;
  }

  /// By a status that came at `now` and names `taken`. Zero where nothing is under way, and where `taken` is
  /// none of the last commands of this program: after its start, or of a controller that just started.
  [[nodiscard]] Duration behind(std::uint16_t taken, Stamp now) const {
    const auto under_way = static_cast<std::uint16_t>(newest_ - taken);
    if (under_way == 0 || under_way > count_) return {};
    return now - told_[static_cast<std::uint16_t>(taken + 1U) % kMost];
  }

 private:
  static constexpr std::size_t kMost = 256;  ///< five seconds of them
  std::array<Stamp, kMost> told_{};
  std::uint16_t newest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace madori::control
