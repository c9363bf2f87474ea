#pragma once

#include <filesystem>
#include <optional>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// Renders one page (1 is the first) of a PDF by poppler. Without `dpi` the resolution is chosen so that the
/// longer side has about 5000 pixels, 72 to 600 dpi. Throws Error: no PDF, password, page out of range, too
/// large.
[[nodiscard]] GrayImage load_pdf(const std::filesystem::path& file, int page, std::optional<double> dpi);

}  // namespace madori::mapping
