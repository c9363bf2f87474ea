#include "localization/particle_filter/likelihood_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/angle.hpp"
#include "core/result.hpp"

namespace madori::localization {
namespace {

/// Density of a return at `range_m` from something undrawn, per metre.
double clutter_density(const BeamModel& m, double range_m) {
  constexpr double kShortShare = 0.5;
  return m.clutter * (kShortShare / m.short_decay_m * std::exp(-range_m / m.short_decay_m) +
                      (1.0 - kShortShare) / m.range_max_m);
}

/// Log of the likelihood on a wall of the given reliability over that of clutter alone.
double contrast(const BeamModel& m, double reliability, double relative_density, double floor) {
  const double hit =
      (1.0 - m.clutter) * reliability * relative_density / (m.hit_sigma_m * std::sqrt(2.0 * kPi));
  return std::log1p(hit / floor);
}

}  // namespace

LikelihoodField::LikelihoodField(const mapping::Walls& walls, const BeamModel& model, double cell_m,
                                 const std::vector<double>& reliability)
    : model_(model) {
  const double radius = 3.5 * model.hit_sigma_m;
  frame_ =
      mapping::GridFrame::around(walls, radius + cell_m, cell_m);  // the outermost cells are clutter only
  if (frame_.width > std::numeric_limits<std::int16_t>::max())
    throw Error("wall map", "is too wide for the particle filter's table", "check the scale of the drawing");
  table_.assign(frame_.cells(), 0);
  const double floor = clutter_density(model, model.range_max_m);
  const double most = contrast(model, 1.0, 1.0, floor);
  nats_per_count_ = most / 255.0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const double sure = reliability.empty() ? 1.0 - model.missing : reliability[i];
    mapping::for_each_cell_near(frame_, walls[i].segment, radius, [&](std::size_t cell, double d2) {
      const double density = std::exp(-d2 / (2.0 * model.hit_sigma_m * model.hit_sigma_m));
      const double count = contrast(model, sure, density, floor) / nats_per_count_;
      std::uint8_t& at = table_[cell];
      at = std::max(at, static_cast<std::uint8_t>(std::lround(count)));
    });
  }
}

std::uint8_t LikelihoodField::counts(const Point2<Map>& p) const {
  const std::int64_t cell = frame_.find(p);
  if (cell < 0) return 0;
  return table_[static_cast<std::size_t>(cell)];
}

double LikelihoodField::information(double range_m) const {
  const double sure = 1.0 - model_.missing;
  return contrast(model_, sure, 1.0, clutter_density(model_, range_m)) /
         contrast(model_, sure, 1.0, clutter_density(model_, model_.range_max_m));
}

}  // namespace madori::localization
