#pragma once

#include <optional>
#include <utility>

#include "simulation/random.hpp"
#include "tests/support/localization_trial.hpp"

namespace madori::test {

/// What happened after a vehicle was carried away.
struct Kidnapping {
  int kind = 0;  ///< 0: by 1 m; 1: by 1 to 5 m, turned; 2: by 5 to 50 m; 3: to a place that looks alike
  bool drives = false;
  double by_m = 0.0;
  Transform2<Map, Base> from, to;
  double lost_after_s = -1.0;   ///< negative: never
  double found_after_s = -1.0;  ///< LOCALIZED and within 0.2 m of the truth again; negative: not in time
  /// Right at the new place within half a second, without ever being LOST: the next scans told it.
  [[nodiscard]] bool followed() const {
    return lost_after_s < 0.0 && found_after_s >= 0.0 && found_after_s <= 0.5;
  }
  double believed_wrong_s = 0.0;  ///< LOCALIZED while more than 0.5 m off
};

/// Carries the vehicle of a trial away again and again.
class Kidnapper {
 public:
  Kidnapper(LocalizationTrial& trial, std::uint64_t seed) : trial_(trial), random_(seed, 0x41D, 0) {}

  /// The `number`-th one: kinds and standing or driving take turns. Puts the vehicle to a fair place first.
  Kidnapping carry_out(int number);

 private:
  using Pose = Transform2<Map, Base>;

  [[nodiscard]] bool is_free(const Pose& pose) const;
  [[nodiscard]] Pose anywhere();
  [[nodiscard]] std::optional<Pose> shifted(const Pose& from, int kind);
  [[nodiscard]] std::optional<std::pair<Pose, Pose>> alike();
  [[nodiscard]] std::pair<Pose, Pose> choose(int kind);
  [[nodiscard]] bool settle(const Pose& at, bool drives);
  void watch(Kidnapping& k);

  LocalizationTrial& trial_;
  simulation::Random random_;
};

}  // namespace madori::test
