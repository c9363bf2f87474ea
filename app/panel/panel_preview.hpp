#pragma once

#include "hmi/server/drawing_preview.hpp"

namespace madori::app {

/// What the panel shows of a new drawing before it becomes the site's.
[[nodiscard]] std::unique_ptr<hmi::DrawingPreview> preview_drawing(const mapping::ImportOptions& options,
                                                                   const mapping::Progress& progress);

}  // namespace madori::app
