#pragma once

#include <optional>
#include <string>

#include "mapping/georeference/scale_estimate.hpp"

namespace madori::mapping {

/// The drawing laid over an aerial photograph by eye, as the layout-map paper's interface does
/// (section 3.2.3).
struct Overlay {
  int zoom = 0;
  LatLon place;              ///< of the photograph
  double layout_zoom = 0.0;  ///< `Z_m`, 1 = 100 %
  double photo_zoom = 0.0;   ///< `Z_p`
  double tile_pixels = kTilePixels;
  double rotation_deg = 0.0;  ///< of the drawing over the photograph, counter-clockwise
  double east_m = 0.0;        ///< from `place` to the anchor
  double north_m = 0.0;
  std::optional<double> u;  ///< the anchor in the drawing; its middle where absent
  std::optional<double> v;
  bool placed = false;  ///< rotation or offset was given, so that the place on Earth is known too
};

/// "zoom=Z,lat=..,lon=..,layout=ZM,photo=ZP[,rotation_deg=..][,east_m=..][,north_m=..][,u=..][,v=..][,tile=512]".
/// Throws Error on unknown or missing keys and values out of range.
[[nodiscard]] Overlay parse_overlay(const std::string& text);

/// Eq. (9) with the tile side on Web Mercator's sphere, as published; what the ellipsoid says is a note. Good
/// to 5 % at best: the published case was 5 m off in 74 m.
[[nodiscard]] ScaleEstimate fit_overlay(const Overlay& overlay, int width_px, int height_px);

}  // namespace madori::mapping
