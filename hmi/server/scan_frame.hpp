#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "core/frames.hpp"
#include "core/point2.hpp"
#include "core/transform2.hpp"

namespace madori::hmi {

/// A scan on the wire, little-endian: "MDS2", u32 count, f64 x, y, yaw of map_from_base at the scan, f32 unit
/// in metres, then count pairs of i16 (x, y), Base frame, in units. The unit is 1 cm, or coarser where a
/// point lies more than 327 m away. Points that are not finite are left out.
[[nodiscard]] std::string scan_frame(std::span<const Point2<Base>> scan, const Transform2<Map, Base>& pose);

/// The same frame with at most `most` points, evenly chosen; a frame of another form becomes an empty scan.
[[nodiscard]] std::string thinned_scan_frame(const std::string& frame, std::size_t most);

}  // namespace madori::hmi
