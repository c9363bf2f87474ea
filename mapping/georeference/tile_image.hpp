#pragma once

#include <string>
#include <string_view>

namespace madori::mapping {

/// Why these bytes are no tile (a square JPEG or PNG of 256 or 512 pixels that decodes to its end); empty
/// when they are one.
[[nodiscard]] std::string tile_image_fault(std::string_view bytes);

}  // namespace madori::mapping
