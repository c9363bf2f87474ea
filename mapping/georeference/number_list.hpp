#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/site/site.hpp"

namespace madori::mapping {

/// "1,2.5,-3" as finite numbers; nothing where any field is none.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// Throws Error, naming `where`, on a pixel that lies off the drawing; a click on its border may miss by 1 %.
void require_on_drawing(const std::string& where, double u, double v, const DrawingRecord& drawing);

}  // namespace madori::mapping
