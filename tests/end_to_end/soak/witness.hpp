#pragma once

#include <optional>
#include <utility>

#include "app/cycle/cycle.hpp"
#include "simulation/factory.hpp"
#include "tests/end_to_end/soak/figures.hpp"

namespace madori::soak {

/// Sees every step of the cycle beside what is true, and keeps the figures.
class Witness {
 public:
  /// Between the two times of `trace_s` (seconds as printed) every revolution is told of in detail.
  Witness(simulation::Factory& factory, Figures& figures, bool verbose, std::pair<double, double> trace_s)
      : factory_(factory), figures_(figures), verbose_(verbose), trace_s_(trace_s) {}

  void observe(const app::CycleInput& input, const app::CycleOutput& output, const app::CycleState& state);
  void kidnapped();
  /// Whether the vehicle has not found itself since it was carried away.
  [[nodiscard]] bool searching() const { return kidnapped_at_.has_value(); }

 private:
  [[nodiscard]] double time_s() const;
  void compare_pose(const app::CycleState& state);
  void count_events(const app::CycleOutput& output);
  void look_for_contact();
  void tell_of_standstill(const app::CycleState& state) const;
  void trace(const app::CycleOutput& output, const app::CycleState& state) const;

  simulation::Factory& factory_;
  Figures& figures_;
  bool verbose_;
  std::pair<double, double> trace_s_;
  bool near_ = false;
  int stood_ = 0;  ///< steps in a row of waiting
  std::size_t collisions_ = 0;
  std::optional<Stamp> kidnapped_at_;
  std::optional<Stamp> last_kidnapping_;
};

/// Least distance between the vehicle's outline and what moves or was put down, at its height, metres.
[[nodiscard]] double clearance_m(const simulation::Factory& factory);

}  // namespace madori::soak
