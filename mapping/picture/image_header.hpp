#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace madori::mapping {

enum class ImageFormat { Png, Jpeg, Tiff, Bmp };

/// What the first bytes of an image file state; read so that a monster is refused before it is decoded.
struct ImageHeader {
  ImageFormat format = ImageFormat::Png;
  std::int64_t width_px = 0;  ///< 0 where the header does not say
  std::int64_t height_px = 0;
  double dpi = 0;        ///< along u; 0 = not stated, or not that of a drawing (below 1, above 100,000)
  int bytes_per_px = 1;  ///< of the decoded picture: channels times bytes of a sample
  double dpi_v = 0;      ///< along v: a fax has 204 x 196 or 204 x 98; as along u where none is stated
  int bits = 8, samples = 1, orientation = 1;  ///< of a TIFF, as it states them (tags 258, 277 and 274)
};

/// The header, or nothing where the bytes are none of these formats. Never reads outside `bytes`.
/// (PNG 1.2 sections 5 and 11.2; JPEG ITU-T T.81 annex B with JFIF 1.02; TIFF 6.0 section 2;
/// BITMAPINFOHEADER.)
[[nodiscard]] std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

}  // namespace madori::mapping
