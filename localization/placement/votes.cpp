#include "localization/placement/votes.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "localization/drawing_fit/wall_hits.hpp"
#include "localization/placement/wall_piece.hpp"

namespace madori::localization {
namespace {

/// How often a vote is right has the density q^(kTruthful - 1) between a half and one: walls mostly stand
/// where they are drawn.
constexpr double kTruthful = 3.0;
/// Two places may be built alike, so that the votes are the drawing's errors and fall either way.
constexpr double kTwins = 0.2;

/// A piece that fits both places alike has no vote; on an exact drawing it can tell more than on a sketch.
double vote(double nats) {
  return 0.5 * nats;
}

}  // namespace

WallPieces wall_pieces(const MemoryCloud& cloud) {
  WallPieces pieces;
  std::unordered_map<std::uint64_t, int> known;
  for (const CloudSurface& p : cloud) {
    const std::uint64_t key = wall_piece_of(p.x_m, p.y_m) << 2U |
                              static_cast<std::uint64_t>(p.direction % (WallIndex::kDirections / 2) / 2);
    pieces.of_surface.push_back(known.try_emplace(key, static_cast<int>(known.size())).first->second);
  }
  pieces.count = known.size();
  return pieces;
}

Votes votes_at(const WallIndex& index, const MemoryCloud& cloud, const WallPieces& pieces,
               const Transform2<Map, Map>& correction, const WallMixture& mixture) {
  Votes votes;
  votes.nats.assign(pieces.count, 0.0);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const CloudSurface& p = cloud[i];
    const Point2<Map> q = correction * Point2<Map>{p.x_m, p.y_m};
    const WallIndex::Hit hit = index.nearest(q.x_m, q.y_m, turned_direction(p, correction));
    if (hit.wall >= 0 && hit.beyond_m <= kBeyondM)
      votes.nats[static_cast<std::size_t>(pieces.of_surface[i])] +=
          p.weight * kShareOfObservation * std::log1p(mixture.odds(hit));
  }
  return votes;
}

double log_odds(const Votes& a, const Votes& b) {
  double for_a = vote(b.crossed_nats);
  double for_b = vote(a.crossed_nats);
  for (std::size_t i = 0; i < std::min(a.nats.size(), b.nats.size()); ++i) {
    const double v = vote(a.nats[i] - b.nats[i]);
    (v > 0.0 ? for_a : for_b) += std::abs(v);
  }
  static const double all = boost::math::betac(kTruthful, 1.0, 0.5);
  const double by_chance = kTwins * std::exp2(-for_a - for_b);
  const auto evidence = [&](double more, double less) {  // q is integrated out
    return by_chance + (1.0 - kTwins) / all * boost::math::betac(kTruthful + more, 1.0 + less, 0.5);
  };
  constexpr double kLeast = 1e-300;  // no number of votes makes the logarithm infinite
  return std::log(std::max(kLeast, evidence(for_a, for_b))) -
         std::log(std::max(kLeast, evidence(for_b, for_a)));
}

}  // namespace madori::localization
