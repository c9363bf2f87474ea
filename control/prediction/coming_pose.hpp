#pragma once

#include "core/frames.hpp"
#include "core/ring.hpp"
#include "core/stamp.hpp"
#include "core/transform2.hpp"
#include "core/velocity_command.hpp"

namespace madori::control {

struct SentCommand {
  Stamp at{};
  VelocityCommand command;

  friend bool operator==(const SentCommand&, const SentCommand&) = default;
};

/// How wheels follow what they are told.
struct WheelResponse {
  double reaction_s = 0.25;  ///< from a command until they obey it
  double change_mps2 = 0.8;  ///< ... and then change their speed so fast
  double turn_change_radps2 = 1.5;
};

/// What the drive was told and has not obeyed yet. A command that is sent now meets the vehicle one reaction
/// later, and where it will be by then no command can change: who steers and who guards decides for there (a
/// Smith predictor: O. J. M. Smith, "Closer control of loops with dead time", 1957).
class SentCommands {
 public:
  /// `at` does not go back. What every wheel has obeyed by then is forgotten.
  void add(Stamp at, const VelocityCommand& command, const WheelResponse& response);
  void clear() { sent_.clear(); }

  /// The vehicle at `now` plus the reaction, seen from where it was measured at `measured` with that
  /// velocity.
  [[nodiscard]] Transform2<Base, Base> way_until_obeyed(Stamp measured, const VelocityCommand& velocity,
                                                        Stamp now, const WheelResponse& response) const;

  [[nodiscard]] const Ring<SentCommand>& sent() const { return sent_; }
  [[nodiscard]] Ring<SentCommand>& sent() { return sent_; }

 private:
  Ring<SentCommand> sent_;
};

}  // namespace madori::control
