#pragma once

#include "localization/global/global_answer.hpp"

namespace madori::localization {

/// Whether two answers to "where am I?" are one: nearer than 0.3 m and 0.1 rad.
[[nodiscard]] inline bool is_same_place(const Transform2<Map, Base>& a, const Transform2<Map, Base>& b) {
  constexpr double kSamePlaceM = 0.3;
  constexpr double kSamePlaceRad = 0.1;
  return same_place(a, b, kSamePlaceM, kSamePlaceRad);
}

}  // namespace madori::localization
