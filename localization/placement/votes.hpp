#pragma once

#include <cstddef>
#include <vector>

#include "localization/drawing_fit/drawing_model.hpp"
#include "localization/drawing_fit/memory_cloud.hpp"

namespace madori::localization {

/// Which wall of two metres each surface of a cloud is part of: errors of a drawing persist along a wall for
/// about so long, so that each such piece has one vote.
struct WallPieces {
  std::vector<int> of_surface;
  std::size_t count = 0;
};
[[nodiscard]] WallPieces wall_pieces(const MemoryCloud& cloud);

/// What speaks for and against a place.
struct Votes {
  std::vector<double> nats;   ///< log likelihood of each remembered piece of wall there, over clutter
  double crossed_nats = 0.0;  ///< against it: of drawn walls that beams or ways pass through there
};
[[nodiscard]] Votes votes_at(const WallIndex& index, const MemoryCloud& cloud, const WallPieces& pieces,
                             const Transform2<Map, Map>& correction, const WallMixture& mixture);

/// Log odds of place `a` over `b`. A piece of wall that is likelier at one of them votes for it, by as much
/// as it can tell; how often such a vote is right depends on building and drawing and is not known: it is
/// integrated out. Or the places are twins and each vote is chance.
/// That is the sign test in Bayes' form (Jaynes 2003, ch. 6). Votes that contradict each other, as in
/// buildings that are their own mirror image drawn with errors, so decide nothing however many they are.
[[nodiscard]] double log_odds(const Votes& a, const Votes& b);

}  // namespace madori::localization
