#include "localization/global/evidence.hpp"

#include <algorithm>

#include "localization/particle_filter/beam_path.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

BeamModel coarse_model(BeamModel model) {
  model.hit_sigma_m = std::max(0.25, model.hit_sigma_m);
  return model;
}

constexpr double kBeamsThatErrTogether = 12.0;

/// Neighbouring beams err together: a scan of few is worth fewer than the model's.
double effective_beams(const BeamBlocks& beams, const LikelihoodField& field) {
  return std::min(field.model().effective_beams, static_cast<double>(beams.beams()) / kBeamsThatErrTogether);
}

/// Log-likelihood of one summed count, tempered to as many beams as the scan is worth.
double nats_per_count(const BeamBlocks& beams, const LikelihoodField& field) {
  return log_likelihood_per_count(beams, field) * effective_beams(beams, field) /
         field.model().effective_beams;
}

/// The pose itself, first, and those beside it.
Particles grid_around(const Pose& map_from_base) {
  constexpr int kSteps = 6;  // of a third of a metre: within the coarse field's reach
  constexpr double kStepM = 0.33;
  constexpr int kTurns = 3;
  constexpr double kTurnRad = 0.07;
  Particles poses;
  poses.origin = map_from_base.translation();
  poses.add(map_from_base);
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; ++j)
      for (int k = -kTurns; k <= kTurns; ++k)
        poses.add({map_from_base.x_m() + i * kStepM, map_from_base.y_m() + j * kStepM,
                   map_from_base.yaw_rad() + k * kTurnRad});
  return poses;
}

}  // namespace

WallTables::WallTables(const mapping::Walls& walls, const BeamModel& model)
    : distance(walls), grid(walls), coarse(walls, coarse_model(model), 0.1), fine(walls, model) {}

void weigh(const ScanPoints& points, double noise_m, const WallTables& tables, double through_wall_nats,
           std::vector<Hypothesis>& hypotheses) {
  const LikelihoodField& field = noise_m > tables.fine.model().hit_sigma_m ? tables.coarse : tables.fine;
  Particles poses;
  poses.origin = hypotheses.front().fit.map_from_base.translation();
  for (const Hypothesis& h : hypotheses) poses.add(h.fit.map_from_base);
  const BeamBlocks beams(points, field);
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, beams, field, sums);
  const double effective = effective_beams(beams, field);
  const double per_count = nats_per_count(beams, field);
  BeamPathOptions path;
  path.end_margin_m = std::max(path.end_margin_m, 3.0 * noise_m);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    Hypothesis& h = hypotheses[i];
    h.through_walls = share_through_walls(points, tables.distance, h.fit.map_from_base, path);
    h.log_likelihood = per_count * sums[i] - through_wall_nats * effective * h.through_walls;
  }
}

double lead_of_nearby(const ScanPoints& points, const LikelihoodField& coarse, const Pose& map_from_base) {
  constexpr std::size_t kBeams = 96;
  const Particles poses = grid_around(map_from_base);
  const BeamBlocks beams(points, coarse, kBeams);
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, beams, coarse, sums);
  const std::uint32_t best = *std::max_element(sums.begin(), sums.end());
  return nats_per_count(beams, coarse) * (best - sums.front());
}

}  // namespace madori::localization
