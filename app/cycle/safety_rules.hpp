#pragma once

#include <vector>

#include "app/cycle/notice.hpp"

namespace madori::app {

struct CycleConfig;
struct CycleInput;
struct CycleState;

/// Something that forbids every motion as long as it holds, whatever the order is. The vehicle goes on by
/// itself once no rule holds any more; what only a person may end is a mode (modes.hpp).
struct SafetyRule {
  CatalogueEntry cause, remedy;  ///< said while the vehicle waits; without {placeholders}, unless `said`
  bool by_hand;                  ///< it holds a vehicle that a person drives by hand, too
  /// Whether it holds in this step. Changes nothing, and reads no clock but CycleInput::now.
  bool (*holds)(const CycleState&, const CycleInput&, const CycleConfig&);
  /// The cause with what was measured, where that is told.
  Notice (*said)(const CycleState&, const CycleInput&, const CycleConfig&) = nullptr;
};

/// A safety scanner's protective field is interrupted. A person may drive the vehicle out of it by hand,
/// slowly: the scanner, which acts on the drive itself, must have been switched to let him.
[[nodiscard]] bool field_is_entered(const CycleState& state, const CycleInput& input,
                                    const CycleConfig& config);

/// Those of the product, in the order in which they are said (docs/how-to/add-a-safety-rule.md).
[[nodiscard]] std::vector<SafetyRule> standard_safety_rules();

/// The first rule of the configuration that holds now; null where the vehicle may move. While a person drives
/// by hand (`by_hand`) only those count that hold it then.
[[nodiscard]] const SafetyRule* forbidding_rule(const CycleState& state, const CycleInput& input,
                                                const CycleConfig& config, bool by_hand = false);

}  // namespace madori::app
