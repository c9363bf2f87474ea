#pragma once

#include <optional>
#include <vector>

#include "app/cycle/cycle.hpp"

namespace madori::app {

/// Plays the operator of an unattended run, who looks around for a while and then confirms a fault: a busy
/// machine may silence the virtual drive for longer than the cycle allows. Emergency stops are left alone.
class PlayedOperator {
 public:
  explicit PlayedOperator(double looks_around_s = 3.0) : looks_around_s_(looks_around_s) {}

  /// What the operator says now; empty most of the time.
  std::vector<OperatorWord> look(Mode mode, Stamp now) {
    if (mode != Mode::Fault) {
      since_.reset();
      return {};
    }
    if (!since_) since_ = now;
    if (to_seconds(now - *since_) < looks_around_s_) return {};
    since_ = now;  // where the cause has not gone, once more
    ++confirmed_;
    return {OperatorWord::Confirm, OperatorWord::Resume};
  }
  [[nodiscard]] int confirmed() const { return confirmed_; }

 private:
  double looks_around_s_;
  std::optional<Stamp> since_;
  int confirmed_ = 0;
};

}  // namespace madori::app
