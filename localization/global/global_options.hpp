#pragma once

#include <cstddef>

#include "localization/registration/segment_icp.hpp"

namespace madori::localization {

struct GlobalOptions {
  std::size_t candidates = 1000;   ///< views most like the scan's that are looked at closer
  std::size_t refined = 60;        ///< of these, as many are registered
  double certain = 0.9999;         ///< probability from which on the best is an answer
  double well_explained = 0.6;     ///< a best that puts less of the scan on walls must also ...
  double clear_nats = 25.0;        ///< ... lead by this log-likelihood: chance fits lead by up to 20
  double least_explained = 0.35;   ///< share of the scan's weight that an answer puts on walls
  double doubtful_through = 0.12;  ///< share of beams through drawn walls, above which a best must both ...
                                   ///< ... explain well and lead clearly
  double most_through = 0.25;      ///< share of the beams that an answer may lead through drawn walls
  double through_wall_nats = 3.0;  ///< against a pose, for each effective beam through a wall
  double same_m = 0.4;             ///< poses nearer than both are one hypothesis
  double same_rad = 0.15;
  SegmentIcpOptions icp = [] {
    SegmentIcpOptions near;  // candidates are near: a wide start would only draw them to the wall beside
    near.first_scale_m = 0.5;
    near.coarse_points = 180;
    return near;
  }();
};

}  // namespace madori::localization
