#pragma once

#include <vector>

#include "localization/global/place_index.hpp"
#include "localization/particle_filter/likelihood_field.hpp"

namespace madori::localization {

/// The first, coarse step of Algorithm 2 (Kis, Csemesz, Csáji 2021): all places and turns of `index` are
/// compared with the scan by their views at once; about `cells` of the likest are looked at closer, each at
/// 27 poses around it, by the likelihood field. At most `wanted` poses, base in Map, likeliest first, no two
/// so near that they would register to the same place. Empty where the index or the scan is.
[[nodiscard]] std::vector<Transform2<Map, Base>> search_views(const ScanPoints& points,
                                                              const PlaceIndex& index,
                                                              const LikelihoodField& coarse,
                                                              std::size_t cells, std::size_t wanted);

}  // namespace madori::localization
