#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "mapping/georeference/scale_estimate.hpp"
#include "mapping/site/site_transaction.hpp"

namespace madori::mapping {

/// Stages what another room keeps in the site, with its lengths multiplied by `factor` (the routes).
using StageScaled = std::function<void(SiteTransaction& change, double factor)>;

/// Gives the site this scale: site.yaml, walls.csv, other_lines.csv, walls.pcd, map.pgm, map.yaml, import.png
/// (its scale bar) and what `others` stages, in one atomic step (SiteTransaction): a power failure leaves the
/// old site or the new one. The Map origin stays the lower-left corner of the drawing, so every length is
/// multiplied by one factor; where the estimate names no place on Earth, the drawing's middle keeps its own.
/// `date` is ISO 8601 UTC. Returns the factor. Throws Error with the site as it was.
double apply_scale(const std::filesystem::path& site, const ScaleEstimate& estimate, const std::string& date,
                   const StageScaled& others);

}  // namespace madori::mapping
