#pragma once

#include <array>
#include <string>

#include "app/cycle/notice.hpp"
#include "core/clock.hpp"

namespace madori::app {

/// What the computer's clocks can do, for the log and the panel's events.
inline constexpr std::array kClockEvents{
    CatalogueEntry{
        "event.clock-set-forward",
        "the computer's time of day was set forward by {seconds} s; driving does not depend on it"},
    CatalogueEntry{"event.clock-set-back",
                   "the computer's time of day was set back by {seconds} s; driving does not depend on it"},
    CatalogueEntry{
        "event.clock-fast",
        "the computer's time of day runs fast: it gained {seconds} s; driving does not depend on it - "
        "check its time service"},
    CatalogueEntry{
        "event.clock-slow",
        "the computer's time of day runs slow: it lost {seconds} s; driving does not depend on it - "
        "check its time service"},
    CatalogueEntry{"event.clock-went-back",
                   "the computer's monotonic clock went back by {seconds} s, which it never may; the program "
                   "went on counting - check the computer"},
};

[[nodiscard]] std::string in_words(const ClockJump& jump);

}  // namespace madori::app
