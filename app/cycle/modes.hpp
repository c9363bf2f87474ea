#pragma once

#include <array>
#include <optional>

namespace madori::app {

/// What the vehicle is about. docs/reference/states.md holds the same table; a test compares them.
enum class Mode { Idle, Localizing, Driving, Detouring, Waiting, Paused, Manual, EmergencyStop, Fault };

enum class ModeEvent {
  OrderGiven,
  Localized,
  Lost,
  Blocked,
  Cleared,
  DetourFound,
  BackOnRoute,
  OrderEnded,
  Pause,
  Resume,
  ManualOn,
  ManualOff,
  EmergencyOn,
  FaultOn,
  Confirmed,
};

struct Transition {
  Mode from;
  ModeEvent event;
  Mode to;
};

inline constexpr std::array kModes{Mode::Idle,      Mode::Localizing,    Mode::Driving,
                                   Mode::Detouring, Mode::Waiting,       Mode::Paused,
                                   Mode::Manual,    Mode::EmergencyStop, Mode::Fault};
inline constexpr std::array kModeEvents{ModeEvent::OrderGiven,  ModeEvent::Localized,  ModeEvent::Lost,
                                        ModeEvent::Blocked,     ModeEvent::Cleared,    ModeEvent::DetourFound,
                                        ModeEvent::BackOnRoute, ModeEvent::OrderEnded, ModeEvent::Pause,
                                        ModeEvent::Resume,      ModeEvent::ManualOn,   ModeEvent::ManualOff,
                                        ModeEvent::EmergencyOn, ModeEvent::FaultOn,    ModeEvent::Confirmed};

/// The modes in which the vehicle may move by itself.
[[nodiscard]] constexpr bool drives(Mode mode) {
  return mode == Mode::Driving || mode == Mode::Detouring;
}
/// Modes that only an operator ends.
[[nodiscard]] constexpr bool is_held(Mode mode) {
  return mode == Mode::Paused || mode == Mode::Manual || mode == Mode::EmergencyStop || mode == Mode::Fault;
}

/// Something happened that a person looks at and confirms before anything goes on.
[[nodiscard]] constexpr bool is_to_be_confirmed(Mode mode) {
  return mode == Mode::EmergencyStop || mode == Mode::Fault;
}

[[nodiscard]] const char* to_string(Mode mode);
[[nodiscard]] const char* to_string(ModeEvent event);
/// The mode after an event; nothing where the event means nothing in that mode.
[[nodiscard]] std::optional<Mode> next_mode(Mode mode, ModeEvent event);

}  // namespace madori::app
