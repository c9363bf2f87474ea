#pragma once

#include <array>
#include <optional>

#include "core/velocity_command.hpp"

namespace madori::control {

/// What is known of wheels that do what they are told. Speeds are those of the rim.
struct WheelWatchOptions {
  double half_separation_m = 0.25;
  double acceleration_mps2 = 0.8;  ///< the vehicle's, of which it surely brakes and starts
  double lag_s = 0.25;             ///< from the command to the wheel
  double share = 0.2;              ///< of what is asked: load, slopes, worn tyres
  double patience_s = 0.1;         ///< so long it must last: a single reading may be damaged
};

/// A wheel that turned faster or slower than it may have been asked to.
struct DisobedientWheel {
  bool left = false;
  double asked_mps = 0.0, turned_mps = 0.0;  ///< of the rim, positive drives forward
};

/// Compares what each wheel does with what it was told. A wheel that obeys lies between the bounds of what it
/// was asked, which follow the command no faster than the vehicle brakes and starts. A motor that does
/// nothing, a wheel that is held and an encoder that stands still leave them. Where both wheels lag, the
/// vehicle is held, and neither wheel is to blame.
class WheelWatch {
 public:
  /// After `step_s`. `asked` is nothing where the drive does not follow commands (it is not judged then, and
  /// the bounds begin where it is). The answer is given once; the wheel is then judged anew.
  [[nodiscard]] std::optional<DisobedientWheel> update(const std::optional<VelocityCommand>& asked,
                                                       const VelocityCommand& turned, double step_s,
                                                       const WheelWatchOptions& options);

 private:
  struct Wheel {
    double least_mps = 0.0, most_mps = 0.0;
    double outside_s = 0.0;

    void ask(double mps, double share, double step_mps);
    /// How far its speed lies beyond the bounds; negative where it lags behind them.
    [[nodiscard]] double beyond_mps(double turned_mps, double share) const;
  };
  std::array<Wheel, 2> wheels_;  // left, right
};

}  // namespace madori::control
