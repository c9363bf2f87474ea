#include "app/runner/clock_words.hpp"

#include <cmath>

#include "core/fill_in.hpp"

namespace madori::app {

std::string in_words(const ClockJump& jump) {
  const bool forward = jump.by > Duration(0);
  std::size_t entry = 4;
  if (jump.kind == ClockJump::Kind::TimeOfDaySet) entry = forward ? 0 : 1;
  if (jump.kind == ClockJump::Kind::TimeOfDayRuns) entry = forward ? 2 : 3;
  return fill_in(kClockEvents.at(entry).english, {{"seconds", two_decimals(std::abs(to_seconds(jump.by)))}});
}

}  // namespace madori::app
