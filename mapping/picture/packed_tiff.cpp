#include "mapping/picture/packed_tiff.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

namespace madori::mapping {
namespace {

using Values = std::vector<std::uint16_t>;

/// A file of GDAL's that is a buffer of ours.
struct MemoryFile {
  explicit MemoryFile(const std::vector<std::uint8_t>& bytes) {
    static std::atomic<int> number = 0;
    name = "/vsimem/madori-read-" + std::to_string(++number) + ".tif";
    // GDAL asks for bytes that it could write to; opened for reading it does not.
    VSILFILE* file =
        VSIFileFromMemBuffer(name.c_str(), const_cast<GByte*>(bytes.data()), bytes.size(), FALSE);
    if (file != nullptr) VSIFCloseL(file);
  }
  ~MemoryFile() { VSIUnlink(name.c_str()); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  std::string name;
};

/// The 8-bit value of each possible sample of a channel (0 blue, 1 green, 2 red).
std::vector<std::uint8_t> shades(GDALRasterBand& band, int channel, int bits, bool min_is_white) {
  const int most = (1 << bits) - 1;
  const GDALColorTable* palette = band.GetColorTable();
  std::vector<std::uint8_t> of(static_cast<std::size_t>(most) + 1);
  for (int i = 0; i <= most; ++i) {
    int shade = (255 * (min_is_white ? most - i : i) + most / 2) / most;
    if (const GDALColorEntry* entry = palette == nullptr ? nullptr : palette->GetColorEntry(i))
      shade = channel == 0 ? entry->c3 : channel == 1 ? entry->c2 : entry->c1;
    of[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(shade);
  }
  return of;
}

bool read_channel(GDALRasterBand& band, int channel, const std::vector<std::uint8_t>& shade,
                  cv::Mat& picture) {
  Values row(static_cast<std::size_t>(picture.cols));
  for (int v = 0; v < picture.rows; ++v) {
    if (band.RasterIO(GF_Read, 0, v, picture.cols, 1, row.data(), picture.cols, 1, GDT_UInt16, 0, 0,
                      nullptr) != CE_None)
      return false;
    auto* out = picture.ptr<cv::Vec4b>(v);
    for (std::size_t u = 0; u < row.size(); ++u)
      out[u][channel] = shade[std::min<std::size_t>(row[u], shade.size() - 1)];
  }
  return true;
}

/// As its orientation (tag 274) says: 2 to 8, of which 5 to 8 lie on their side.
cv::Mat upright(cv::Mat picture, int orientation) {
  if (orientation >= 5 && orientation <= 8) cv::transpose(picture, picture);
  const bool mirrored_u = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
  const bool mirrored_v = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
  if (mirrored_u) cv::flip(picture, picture, 1);
  if (mirrored_v) cv::flip(picture, picture, 0);
  return picture;
}

bool read_channels(GDALDataset& tiff, const ImageHeader& header, cv::Mat& picture) {
  const int bands = tiff.GetRasterCount();
  const char* white = tiff.GetRasterBand(1)->GetMetadataItem("MINISWHITE", "IMAGE_STRUCTURE");
  for (int channel = 0; channel < 3; ++channel) {
    GDALRasterBand& band = *tiff.GetRasterBand(bands >= 3 ? 3 - channel : 1);
    const auto shade = shades(band, channel, header.bits, white != nullptr);
    if (!read_channel(band, channel, shade, picture)) return false;
  }
  for (int i = 2; i <= bands; ++i) {
    GDALRasterBand& band = *tiff.GetRasterBand(i);
    if (band.GetColorInterpretation() != GCI_AlphaBand) continue;
    if (!read_channel(band, 3, shades(band, 3, header.bits, false), picture)) return false;
  }
  return true;
}

}  // namespace

bool is_packed_tiff(const ImageHeader& header) {
  return header.format == ImageFormat::Tiff &&
         (header.bits == 2 || header.bits == 4 ||
          (header.samples == 2 && header.bits >= 1 && header.bits <= 16));
}

cv::Mat decode_packed_tiff(const std::vector<std::uint8_t>& bytes, const ImageHeader& header) {
  GDALAllRegister();
  const MemoryFile file(bytes);
  const std::array<const char*, 2> drivers{"GTiff", nullptr};
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const std::unique_ptr<GDALDataset> tiff(
      GDALDataset::Open(file.name.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers.data()));
  cv::Mat picture;
  if (tiff && tiff->GetRasterXSize() == header.width_px && tiff->GetRasterYSize() == header.height_px) {
    picture = cv::Mat(tiff->GetRasterYSize(), tiff->GetRasterXSize(), CV_8UC4, cv::Scalar(0, 0, 0, 255));
    if (!read_channels(*tiff, header, picture)) picture.release();
  }
  CPLPopErrorHandler();
  return picture.empty() ? picture : upright(picture, header.orientation);
}

}  // namespace madori::mapping
