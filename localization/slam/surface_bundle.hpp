#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/pose_graph.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

struct BundleOptions {
  double least_noise_m = 0.03;  ///< of a point from its surface at the least: real surfaces are no lines
  double length_m = 0.3;        ///< of a piece of surface at the least,
  double length_sigmas = 2.0;   ///< and in sigmas of the noise: what its points are averaged over
  double first_reach_m = 0.5;   ///< how far from its surface a point may start at the least
  double first_sigmas = 4.0;    ///< and in sigmas of the noise
  double last_sigmas = 2.5;     ///< the same in the end: scale of the Geman-McClure loss
  double shrink = 0.7;          ///< of that reach a round
  int rounds = 14;
  double most_spread = 1.2;    ///< of a piece's points about its line, in sigmas: wider is a corner
  double least_points = 8.0;   ///< of a piece of surface
  double beams_a_point = 0.2;  ///< neighbouring points share errors: a point tells as much as this many
};

/// Bundle adjustment of a drive: the poses of all scans at once, such that the scans agree on the surfaces
/// that they saw together (Liu and Zhang, BALM, RA-L 2021, with lines for planes). Pieces of surface are the
/// ridges of the cloud of all points, however thick noise makes it; each is a line that is eliminated from
/// the normal equations, so that no scan is held by a map that it made itself. `wheels` are motions between
/// scans; the first pose is held. `noise_m` is the sigma of the points. Returns the poses.
[[nodiscard]] std::vector<Transform2<Map, Base>> bundle_scans(const std::vector<ScanPoints>& scans,
                                                              std::vector<Transform2<Map, Base>> poses,
                                                              const std::vector<RelativeFactor>& wheels,
                                                              double noise_m,
                                                              const BundleOptions& options = {});

}  // namespace madori::localization
