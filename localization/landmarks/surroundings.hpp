#pragma once

#include "localization/landmarks/descriptor.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization::landmarks {

/// What a scan says of the place: its descriptor, the corridor's width, and how many ways lead on.
struct Surroundings {
  Descriptor descriptor;
  double corridor_width_m = 0.0;
  int openings = 0;
};

/// From the returns of one scan, Base frame. In a corridor of half width h a quarter of all beams end within
/// 1.08 h: that gives the width. A way leads on where no return is nearer than 3 h over a gap at least h
/// wide.
[[nodiscard]] Surroundings look_around(const ScanPoints& points);

}  // namespace madori::localization::landmarks
