#pragma once

#include "mapping/drawing/plan.hpp"

namespace madori::mapping {

/// Renders one page (1 is the first) of a PDF by poppler, and says which where there are others. Without
/// `dpi` the resolution is chosen so that the longer side has about 5000 pixels, 72 to 600 dpi. Throws Error:
/// no PDF, password, page out of range, too large.
[[nodiscard]] Plan load_pdf(const std::filesystem::path& file, const PlanOptions& options);

}  // namespace madori::mapping
