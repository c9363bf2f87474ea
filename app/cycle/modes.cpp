#include "app/cycle/modes.hpp"

#include <algorithm>

namespace madori::app {
namespace {

using enum Mode;
using enum ModeEvent;

constexpr std::array kTransitions{
    Transition{Idle, OrderGiven, Driving},         Transition{Idle, Lost, Localizing},
    Transition{Localizing, Localized, Idle},       Transition{Driving, Blocked, Waiting},
    Transition{Driving, DetourFound, Detouring},   Transition{Driving, OrderEnded, Idle},
    Transition{Driving, Lost, Localizing},         Transition{Detouring, Blocked, Waiting},
    Transition{Detouring, DetourFound, Detouring}, Transition{Detouring, BackOnRoute, Driving},
    Transition{Detouring, OrderEnded, Idle},       Transition{Detouring, Lost, Localizing},
    Transition{Waiting, Cleared, Driving},         Transition{Waiting, DetourFound, Detouring},
    Transition{Waiting, OrderEnded, Idle},         Transition{Waiting, Lost, Localizing},
    Transition{Paused, Resume, Localizing},        Transition{Manual, ManualOff, Paused},
    Transition{EmergencyStop, Confirmed, Paused},  Transition{Fault, Confirmed, Paused},
};

/// What holds in every mode but the one it leads to.
std::optional<Mode> from_anywhere(Mode mode, ModeEvent event) {
  if (event == EmergencyOn && mode != EmergencyStop) return EmergencyStop;
  if (event == FaultOn && mode != Fault && mode != EmergencyStop) return Fault;
  if (mode == EmergencyStop || mode == Fault) return std::nullopt;
  if (event == ManualOn && mode != Manual) return Manual;
  if (event == Pause && mode != Paused && mode != Manual) return Paused;
  return std::nullopt;
}

}  // namespace

const char* to_string(Mode mode) {
  switch (mode) {
    case Idle:
      return "idle";
    case Localizing:
      return "localizing";
    case Driving:
      return "driving";
    case Detouring:
      return "detouring";
    case Waiting:
      return "waiting";
    case Paused:
      return "paused";
    case Manual:
      return "manual";
    case EmergencyStop:
      return "emergency_stop";
    case Mode::Fault:
      return "fault";
  }
  return "fault";
}

const char* to_string(ModeEvent event) {
  constexpr std::array<const char*, kModeEvents.size()> kNames{
      "order given",  "localized",     "lost",         "blocked",  "cleared",
      "detour found", "back on route", "order ended",  "pause",    "resume",
      "manual on",    "manual off",    "emergency on", "fault on", "confirmed"};
  return kNames[static_cast<std::size_t>(event)];
}

std::optional<Mode> next_mode(Mode mode, ModeEvent event) {
  const auto* found = std::find_if(kTransitions.begin(), kTransitions.end(),
                                   [&](const Transition& t) { return t.from == mode && t.event == event; });
  if (found != kTransitions.end()) return found->to;
  return from_anywhere(mode, event);
}

}  // namespace madori::app
