// The way of a raster drawing: its header, the decoder, the detection of walls on small ones, the picture.
#include "mapping/drawing/read_drawing.hpp"
#include "mapping/picture/image_header.hpp"
#include "mapping/picture/load_image.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "tests/fuzz/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  using namespace madori::mapping;
  // Honest headers of large pictures only cost time: the size limit has its own unit test.
  const auto header = read_image_header({data, size});
  if (header && static_cast<double>(header->width_px) * static_cast<double>(header->height_px) > 1e6)
    return 0;
  static const madori::fuzz::MemoryFile file(".png");
  file.write(data, size);
  try {
    const GrayImage image = load_image(file.path());
    madori::fuzz::check(image);
    if (image.pixels.size() > 40'000) return 0;  // keeps the runs many
    const DetectedWalls found = read_drawing(image, {});
    for (const auto& wall : found.walls)
      madori::fuzz::require(std::isfinite(wall.u1 + wall.v1 + wall.u2 + wall.v2));
    madori::fuzz::require(!import_picture(image, found.walls, found.rejected, 0.01).empty());
  } catch (const madori::Error&) {
  }
  return 0;
}
