#include "tests/bench/movers/mover_match.hpp"

#include <algorithm>
#include <tuple>

#include "tests/support/outline_distance.hpp"

namespace madori::bench {

double distance_to(const simulation::Body& body, const Point2<Building>& at) {
  return test::distance_to(simulation::outline(body), at);
}

Match match_movers(const std::vector<ToldMover>& told, const std::vector<TrueMover>& truths) {
  Match match{std::vector<int>(truths.size(), Match::kNone),
              std::vector<Verdict>(told.size(), Verdict::Wrong)};
  std::vector<std::tuple<double, double, std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < told.size(); ++i)
    for (std::size_t k = 0; k < truths.size(); ++k) {
      const double away_m = distance_to(truths[k].body, told[i].at);
      if (away_m > kGateM) continue;
      if (truths[k].moves)
        match.verdicts[i] = Verdict::Right;
      else if (match.verdicts[i] == Verdict::Wrong)
        match.verdicts[i] = Verdict::Neither;
      if (truths[k].moves) pairs.emplace_back(away_m, distance_m(truths[k].body.centre, told[i].at), i, k);
    }
  std::sort(pairs.begin(), pairs.end());
  std::vector<bool> taken(told.size(), false);
  for (const auto& [away_m, from_centre_m, i, k] : pairs) {
    if (taken[i] || match.told_of[k] != Match::kNone) continue;
    taken[i] = true;
    match.told_of[k] = static_cast<int>(i);
  }
  return match;
}

}  // namespace madori::bench
