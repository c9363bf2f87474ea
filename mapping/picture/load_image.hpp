#pragma once

#include <filesystem>

#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// Larger pictures are refused before they are decoded.
constexpr double kMaxImageMegapixels = 300;
constexpr double kMaxDecodedMb = 600;  ///< 200 megapixels of 8-bit colour, 75 of 16-bit colour with alpha
/// The longer side that a drawing without pixels is given, where nobody asks for another resolution.
constexpr double kWantedPx = 5000;

/// Reads PNG (grey, colour, palette, alpha; 1 to 16 bit), JPEG (its EXIF orientation applied), TIFF and BMP.
/// Transparent becomes white; pixels that are not square (a fax of 204 x 196 dots per inch) become so. Throws
/// Error naming the file and the mend: no regular file, not readable, not an image, truncated, empty, too
/// large.
[[nodiscard]] GrayImage load_image(const std::filesystem::path& file);

}  // namespace madori::mapping
