#pragma once

#include <string>
#include <string_view>

#include "mapping/drawing/plan.hpp"

namespace madori::mapping {

/// A plan on its way from one process of this program to another: the bytes of one build on one machine.
[[nodiscard]] std::string plan_bytes(const Plan& plan);
/// Precondition: `bytes` are plan_bytes() of the same program.
[[nodiscard]] Plan plan_of(std::string_view bytes);

}  // namespace madori::mapping
