#pragma once

#include <string>
#include <vector>

#include "app/cycle/cycle.hpp"
#include "control/braking/measured_stop.hpp"

namespace madori::app {

/// Why a braking test ended before its last stop; {placeholders} as in notice.hpp.
enum class BrakingTrouble {
  None,
  NoLidar,
  NoRoom,         ///< {needs} metres, {free} of them free
  SomethingCame,  ///< while it drove
  Ended,          ///< by a person, or by what stops the vehicle in every mode
  NeverFast,      ///< it did not reach {speed}
  NotUnderstood,  ///< the wheels' way is no stop
};
[[nodiscard]] const CatalogueEntry& entry(BrakingTrouble trouble);

struct BrakingPlan {
  double speed_mps = 0.0;
  int stops = 3;
};

/// The straight way that a braking test needs before the vehicle, metres: to reach the speed, to keep it for
/// a moment, and to stop even if the brakes are half as good as the record says.
[[nodiscard]] double braking_test_way_m(double speed_mps, const CycleConfig& config);

/// How far the vehicle could go straight ahead, or back, until something seen stands before it; beside it the
/// margin of a path is kept.
[[nodiscard]] double free_straight_m(const CycleState& state, const CycleConfig& config, bool ahead);

/// Drives, stops and measures, several times at one place: up to the speed straight ahead, a stop, slowly
/// back. It looks on at the cycle and speaks as a person does who drives by hand, so that all that holds such
/// a vehicle holds this one, and a recording replays. What forbids a vehicle to drive by itself ends it, and
/// so does Stop at any panel: a person watches it.
class BrakingTest {
 public:
  explicit BrakingTest(const BrakingPlan& plan) : plan_(plan) {}

  /// After each step of the cycle: what to say to it now.
  [[nodiscard]] std::vector<OperatorCommand> after_step(const CycleInput& input, const CycleState& state,
                                                        const CycleConfig& config);

  [[nodiscard]] bool ended() const { return phase_ == Phase::Ended; }
  /// Empty while nothing is wrong.
  [[nodiscard]] const Notice& trouble() const { return trouble_; }
  [[nodiscard]] const std::vector<control::MeasuredStop>& stops() const { return stops_; }

 private:
  enum class Phase { Begins, Drives, Brakes, Returns, Ended };
  using Words = std::vector<OperatorCommand>;

  void record(const CycleState& state);
  [[nodiscard]] Words begin(const CycleInput& input, const CycleState& state, const CycleConfig& config);
  [[nodiscard]] Words drive(const CycleState& state, const CycleConfig& config);
  [[nodiscard]] Words brake(const CycleInput& input, const CycleState& state);
  [[nodiscard]] Words go_back(const CycleState& state, const CycleConfig& config);
  [[nodiscard]] static Words go_on();
  [[nodiscard]] Words fail(BrakingTrouble why, std::map<std::string, std::string> values = {});
  [[nodiscard]] OperatorCommand straight(double speed_mps, const CycleState& state) const;

  BrakingPlan plan_;
  Phase phase_ = Phase::Begins;
  Notice trouble_;
  std::vector<control::MeasuredStop> stops_;
  std::vector<control::Rolled> track_;  ///< since this way began
  Transform2<Odom, Base> last_;
  double begun_yaw_rad_ = 0.0;
  Stamp begun_{};
  std::optional<Stamp> even_since_;  ///< the speed is reached
  std::optional<Stamp> told_;        ///< to stop
};

}  // namespace madori::app
