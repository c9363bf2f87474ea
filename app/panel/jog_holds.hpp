#pragma once

#include <map>
#include <mutex>

#include "core/stamp.hpp"

namespace madori::app {

/// Whose button is held to drive by hand. The first panel that holds one has the vehicle until it lets go or
/// falls silent. A button that was refused, or held while somebody pressed Stop, drives only once that very
/// panel has let it go: a held one repeats itself every 80 ms, and would start the vehicle by itself.
class JogHolds {
 public:
  enum class Answer { Drives, Stopped, Taken, LetGo };

  /// `who` holds its button at `now`.
  [[nodiscard]] Answer hold(const void* who, Stamp now) {
    const std::scoped_lock lock(mutex_);
    Answer& answer = holds_[who];
    if (answer == Answer::Drives && driver_ != who && is_driven(now)) answer = Answer::Taken;
    if (answer == Answer::Taken && !is_driven(now)) answer = Answer::LetGo;
    if (answer != Answer::Drives) return answer;
    driver_ = who;
    heard_ = now;
    return answer;
  }
  /// `who` lets its button go, or has gone. True where it had the vehicle.
  bool let_go(const void* who) {
    const std::scoped_lock lock(mutex_);
    holds_.erase(who);
    return leave(who);
  }
  /// `who` holds its button where nobody may drive by hand.
  void refuse(const void* who) {
    const std::scoped_lock lock(mutex_);
    Answer& answer = holds_[who];
    if (answer != Answer::Stopped) answer = Answer::LetGo;
    leave(who);
  }
  /// Somebody pressed Stop.
  void stop() {
    const std::scoped_lock lock(mutex_);
    for (auto& [who, answer] : holds_) answer = Answer::Stopped;
    driver_ = nullptr;
  }
  [[nodiscard]] bool has(const void* who) const {
    const std::scoped_lock lock(mutex_);
    return driver_ == who;
  }
  /// Whether somebody has the vehicle at `now`.
  [[nodiscard]] bool is_held(Stamp now) const {
    const std::scoped_lock lock(mutex_);
    return is_driven(now);
  }

 private:
  static constexpr double kSilent_s = 0.5;

  [[nodiscard]] bool is_driven(Stamp now) const {
    return driver_ != nullptr && to_seconds(now - heard_) < kSilent_s;
  }
  bool leave(const void* who) {
    if (driver_ != who) return false;
    driver_ = nullptr;
    return true;
  }

  mutable std::mutex mutex_;
  std::map<const void*, Answer> holds_;  ///< of each panel whose button is held
  const void* driver_ = nullptr;
  Stamp heard_{};  ///< when it last held
};

}  // namespace madori::app
