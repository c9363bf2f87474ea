#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/pose_graph.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// Bundle adjustment of a drive: the poses of all scans at once, such that the scans agree on the surfaces
/// that they saw together (Liu and Zhang, BALM, RA-L 2021, with lines for planes). Pieces of surface are the
/// ridges of the cloud of all points, however thick noise makes it; each is a line that is eliminated from
/// the normal equations, so that no scan is held by a map that it made itself. `wheels` are motions between
/// scans; the first pose is held. `noise_m` is the sigma of the points. Returns the poses.
[[nodiscard]] std::vector<Transform2<Map, Base>> bundle_scans(const std::vector<ScanPoints>& scans,
                                                              std::vector<Transform2<Map, Base>> poses,
                                                              const std::vector<RelativeFactor>& wheels,
                                                              double noise_m);

}  // namespace madori::localization
