#pragma once

#include <string>
#include <vector>

#include "localization/registration/registration_result.hpp"

namespace madori::localization {

/// A place where the vehicle may be.
struct Hypothesis {
  RegistrationResult fit;
  double log_likelihood = 0.0;  ///< over clutter, tempered to the effective beams
  double through_walls = 0.0;   ///< share of the beams
  double probability = 0.0;     ///< among the hypotheses
};

enum class GlobalState { Found, Ambiguous, Nowhere };
[[nodiscard]] const char* to_string(GlobalState state);

/// The answer to "where am I?" without history: the hypotheses, likeliest first, and whether the first is to
/// be believed.
struct GlobalAnswer {
  GlobalState state = GlobalState::Nowhere;
  std::string reason;  ///< in an operator's words; empty when found
  std::vector<Hypothesis> hypotheses;
};

/// The decision: sorts the hypotheses by likelihood, fills in their probabilities and says whether the first
/// is to be believed, else why not.
[[nodiscard]] GlobalAnswer decide(std::vector<Hypothesis> hypotheses);

/// The hypotheses by falling likelihood, none at the same place as one before.
[[nodiscard]] std::vector<Hypothesis> distinct(std::vector<Hypothesis> all, double same_m, double same_rad);

}  // namespace madori::localization
