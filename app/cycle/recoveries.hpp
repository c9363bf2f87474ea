#pragma once

#include <span>

#include "app/cycle/notice.hpp"

namespace madori::app {

struct CycleConfig;
struct CycleInput;
struct CycleOutput;
struct CycleState;

/// What the vehicle does where its way is not free.
struct Recovery {
  const char* name;
  const char *condition, *action, *limit;  ///< in words, with the table of docs/explanation/narrow-places.md
  bool (*due)(const CycleState&, const CycleInput&, const CycleConfig&);
  /// The speed that it leaves the vehicle, m/s; null where it is no question of speed.
  double (*most_mps)(const CycleState&, const CycleConfig&);
  /// What it does once it is due; null where the speed is all.
  void (*act)(CycleState&, const CycleInput&, const CycleConfig&, CycleOutput&);
};

/// All of them, in their order: each is tried only where those before it have not helped.
[[nodiscard]] std::span<const Recovery> recoveries();

/// Carries out whatever is due in this step, in the table's order.
void recover(CycleState& state, const CycleInput& input, const CycleConfig& config, CycleOutput& output);

/// The greatest speed that the recoveries leave the vehicle, m/s.
[[nodiscard]] double allowed_mps(const CycleState& state, const CycleInput& input, const CycleConfig& config);

/// What a person is told, and asked for, while the vehicle waits on its way.
struct Ask {
  CatalogueEntry cause, remedy;
  bool (*holds)(const CycleState&, const CycleConfig&);
};
/// In their order: the first that holds is said.
[[nodiscard]] std::span<const Ask> asks();

}  // namespace madori::app
