#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace madori::mapping {

/// "1,2.5,-3" as finite numbers; nothing where any field is none.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace madori::mapping
