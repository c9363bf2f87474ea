#include "mapping/days/map_frame.hpp"

#include <fmt/format.h>

#include "core/fnv1a.hpp"

namespace madori::mapping {

std::string map_frame(const std::filesystem::path& folder, const Site& site) {
  const DrawingRecord& d = site.drawing;
  std::error_code missing;
  const auto bytes = std::filesystem::file_size(folder / d.file, missing);
  const std::string text = fmt::format("{} {} {} {} {} {:.12g}", d.file, missing ? 0 : bytes, d.width_px,
                                       d.height_px, d.page, site.scale ? site.scale->m_per_px : 0.0);
  return fmt::format("{:016x}", fnv1a(text));
}

}  // namespace madori::mapping
