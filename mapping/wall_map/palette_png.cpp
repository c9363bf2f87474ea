#include "mapping/wall_map/palette_png.hpp"

#include <png.h>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

[[noreturn]] void fail(png_structp, png_const_charp message) {
  throw Error("import.png", message, "");
}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  auto& out = *static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  out.insert(out.end(), bytes, bytes + count);
}

/// Ends libpng's state however the function is left.
struct Writer {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail, nullptr);
  png_infop info = png_create_info_struct(png);
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

}  // namespace

std::vector<std::uint8_t> palette_png(int width, int height, std::span<const std::uint8_t> indices,
                                      std::span<const PaletteColour> colours) {
  std::vector<std::uint8_t> out;
  Writer w;
  png_set_write_fn(w.png, &out, append, nullptr);
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 8,
               PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  std::vector<png_color> palette;
  for (const auto& c : colours) palette.push_back({c[0], c[1], c[2]});
  png_set_PLTE(w.png, w.info, palette.data(), static_cast<int>(palette.size()));
  png_set_filter(w.png, 0, PNG_FILTER_NONE);
  png_set_compression_level(w.png, 1);
  png_write_info(w.png, w.info);
  for (int v = 0; v < height; ++v)
    png_write_row(w.png, indices.data() + static_cast<std::ptrdiff_t>(v) * width);
  png_write_end(w.png, nullptr);
  return out;
}

}  // namespace madori::mapping
