#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "mapping/drawing/plan.hpp"

namespace madori::mapping {

/// What reading one drawing may take. A floor takes less than a second and 100 MB.
struct LoadBudget {
  unsigned processor_s = 8;
  double wall_s = 15.0;
  std::size_t bytes = 800'000'000;
};

/// Runs `load` in a process of its own, because a few bytes of SVG, PDF or DXF can ask the libraries that
/// read them for any time and memory, and hands its plan over. Throws the Error that `load` throws, and one
/// that names what was spent where the budget did not suffice or the library broke down. Linux: fork,
/// RLIMIT_CPU, RLIMIT_DATA.
[[nodiscard]] Plan load_bounded(const std::filesystem::path& file, const std::function<Plan()>& load,
                                const LoadBudget& budget = {});

}  // namespace madori::mapping
