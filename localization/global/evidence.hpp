#pragma once

#include <vector>

#include "localization/global/global_answer.hpp"
#include "localization/particle_filter/likelihood_field.hpp"
#include "localization/registration/segment_grid.hpp"
#include "localization/scan_points.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::localization {

/// What poses are judged by: tables of the drawn walls, made once a site (seconds for a large one).
struct WallTables {
  WallTables(const mapping::Walls& walls, const BeamModel& model);

  mapping::DistanceField distance;
  SegmentGrid grid;
  LikelihoodField coarse;  ///< forgives what half a grid spacing and half a section put a pose off
  LikelihoodField fine;
};

/// Judges every hypothesis by the whole scan: fills in its log-likelihood (nats, points on walls speak for
/// it, each effective beam through a wall takes `through_wall_nats`) and its share of beams through walls.
/// `noise_m` is the scan's own. At least one hypothesis.
void weigh(const ScanPoints& points, double noise_m, const WallTables& tables, double through_wall_nats,
           std::vector<Hypothesis>& hypotheses);

/// By how many nats the best of the poses within 2 m and 12 degrees explains the points better, by the coarse
/// field: near zero where the pose is right.
[[nodiscard]] double lead_of_nearby(const ScanPoints& points, const LikelihoodField& coarse,
                                    const Transform2<Map, Base>& map_from_base);

}  // namespace madori::localization
