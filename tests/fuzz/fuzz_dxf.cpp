// A whole DXF import up to the walls: reading by GDAL, units, layers, rendering.
#include "mapping/drawing/vector/load_dxf.hpp"
#include "tests/fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  static const madori::fuzz::MemoryFile file(".dxf");
  std::string text(reinterpret_cast<const char*>(data), size);
  if (size % 8 != 0) text += "\n  0\nEOF\n";  // without this end a file is refused at once
  file.write(text);
  try {
    const auto plan = madori::mapping::load_dxf(file.path(), {});
    madori::fuzz::check(plan.picture);
    for (const auto& wall : plan.vectors->walls)
      madori::fuzz::require(std::isfinite(wall.u1 + wall.v1 + wall.u2 + wall.v2));
    if (plan.m_per_px) madori::fuzz::require(*plan.m_per_px > 0.0 && std::isfinite(*plan.m_per_px));
  } catch (const madori::Error&) {
  }
  return 0;
}
