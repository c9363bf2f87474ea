#pragma once

#include <filesystem>
#include <optional>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// Renders an SVG by librsvg on white. Without `dpi` the longer side has about 5000 pixels. Throws Error.
[[nodiscard]] GrayImage load_svg(const std::filesystem::path& file, std::optional<double> dpi);

}  // namespace madori::mapping
