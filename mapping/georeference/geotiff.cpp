#include "mapping/georeference/geotiff.hpp"

#include <cpl_vsi.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::mapping {
namespace {

/// East and north, or Map x and y, of column and row: GDAL's six numbers.
std::array<double, 6> geo_transform(const MapRaster& raster, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const double left = raster.origin.x_m;
  const double top = raster.origin.y_m + raster.height * raster.cell_m;
  const double step = raster.cell_m;
  return {c * left - s * top, c * step, s * step, s * left + c * top, s * step, -c * step};
}

std::string reference_system(const GeoreferenceRecord& g) {
  OGRSpatialReference plane;
  plane.SetProjCS("plane of the site");
  plane.SetWellKnownGeogCS("WGS84");
  plane.SetAE(g.latitude_deg, g.longitude_deg, 0.0, 0.0);
  char* text = nullptr;
  plane.exportToWkt(&text);
  std::string wkt(text == nullptr ? "" : text);
  CPLFree(text);
  return wkt;
}

}  // namespace

std::string geotiff(const MapRaster& raster, const std::optional<GeoreferenceRecord>& georeference) {
  static std::atomic<int> number = 0;
  GDALAllRegister();
  const auto refuse = [] {
    return Error("the GeoTIFF", "cannot be made", "is GDAL's GTiff driver installed?");
  };
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) throw refuse();
  const std::string name = "/vsimem/madori-" + std::to_string(++number) + ".tif";
  std::array<char, 20> deflate{"COMPRESS=DEFLATE"};
  std::array<char*, 2> options{deflate.data(), nullptr};
  std::unique_ptr<GDALDataset> tiff(
      driver->Create(name.c_str(), raster.width, raster.height, 1, GDT_Byte, options.data()));
  if (!tiff) throw refuse();
  auto transform = geo_transform(raster, georeference ? to_rad(georeference->enu_from_map_yaw_deg) : 0.0);
  bool good = tiff->SetGeoTransform(transform.data()) == CE_None;
  if (georeference) good = good && tiff->SetProjection(reference_system(*georeference).c_str()) == CE_None;
  std::string row(static_cast<std::size_t>(raster.width), '\0');
  for (int y = 0; good && y < raster.height; ++y) {
    const auto from = raster.pixels.subspan(static_cast<std::size_t>(y) * raster.width, row.size());
    row.assign(from.begin(), from.end());
    good = tiff->GetRasterBand(1)->RasterIO(GF_Write, 0, y, raster.width, 1, row.data(), raster.width, 1,
                                            GDT_Byte, 0, 0) == CE_None;
  }
  tiff.reset();  // writes what is left
  vsi_l_offset size = 0;
  GByte* bytes = VSIGetMemFileBuffer(name.c_str(), &size, FALSE);
  std::string content;
  if (good && bytes != nullptr) content.assign(bytes, bytes + size);
  VSIUnlink(name.c_str());
  if (content.empty()) throw refuse();
  return content;
}

}  // namespace madori::mapping
