#include "tests/bench/movers/mover_score.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tests/bench/movers/mover_match.hpp"

namespace madori::bench {
namespace {

constexpr double kSearchGapS = 0.5;    ///< who was hidden for so long is sought anew
constexpr double kShortSearchS = 1.0;  ///< nobody is blamed for not having found in a shorter time

void append(std::vector<double>& to, const std::vector<double>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::optional<std::size_t> range_of(double away_m) {
  const auto* end = std::upper_bound(kRangesM.begin(), kRangesM.end(), away_m);
  if (end == kRangesM.end()) return std::nullopt;
  return static_cast<std::size_t>(std::distance(kRangesM.begin(), end));
}

void MoverScore::add(Stamp stamp, const std::vector<ToldMover>& told, const std::vector<TrueMover>& truths,
                     const Point2<Building>& lidar) {
  const Match match = match_movers(told, truths);
  for (std::size_t i = 0; i < told.size(); ++i) {
    const auto range = range_of(distance_m(told[i].at, lidar));
    if (!range) continue;
    ++told_[*range].told;
    told_[*range].right += match.verdicts[i] == Verdict::Right;
    told_[*range].neither += match.verdicts[i] == Verdict::Neither;
  }
  for (std::size_t k = 0; k < truths.size(); ++k) {
    const auto range = range_of(truths[k].range_m);
    if (!truths[k].asked || !range) continue;
    FoundCounts& counts = counts_of(truths[k].kind, *range);
    const bool found = match.told_of[k] != Match::kNone;
    ++counts.asked;
    if (found) note_found(counts, told[static_cast<std::size_t>(match.told_of[k])], truths[k]);
    note_search(stamp, truths[k], *range, found);
  }
}

void MoverScore::note_found(FoundCounts& counts, const ToldMover& told, const TrueMover& truth) {
  const double dx = told.vx_mps - truth.vx_mps, dy = told.vy_mps - truth.vy_mps;
  const double speed = std::hypot(truth.vx_mps, truth.vy_mps);
  ++counts.found;
  counts.outline_m.push_back(distance_to(truth.body, told.at));
  counts.centre_m.push_back(distance_m(truth.body.centre, told.at));
  counts.velocity_mps.push_back(std::hypot(dx, dy));
  if (speed > 0.0) counts.along_mps.push_back((dx * truth.vx_mps + dy * truth.vy_mps) / speed);
}

void MoverScore::note_search(Stamp stamp, const TrueMover& truth, std::size_t range, bool found) {
  const Search begun{stamp, stamp, {}, truth.kind, range};
  Search& search = searches_.try_emplace(truth.name, begun).first->second;
  if (to_seconds(stamp - search.last) > kSearchGapS) {
    end_search(search);
    search = begun;
  }
  search.last = stamp;
  if (found && !search.found_after_s) search.found_after_s = to_seconds(stamp - search.begun);
}

void MoverScore::end_search(const Search& search) {
  if (to_seconds(search.last - search.begun) < kShortSearchS) return;
  FoundCounts& counts = counts_of(search.kind, search.range);
  if (search.found_after_s)
    counts.first_after_s.push_back(*search.found_after_s);
  else
    ++counts.never;
}

void MoverScore::end() {
  for (const auto& [name, search] : searches_) end_search(search);
  searches_.clear();
}

void MoverScore::merge(const MoverScore& other) {
  for (std::size_t r = 0; r < kRanges; ++r) {
    told_[r].told += other.told_[r].told;
    told_[r].right += other.told_[r].right;
    told_[r].neither += other.told_[r].neither;
    for (std::size_t k = 0; k < kKinds; ++k) {
      FoundCounts& to = found_[k][r];
      const FoundCounts& from = other.found_[k][r];
      to.asked += from.asked;
      to.found += from.found;
      to.never += from.never;
      append(to.outline_m, from.outline_m);
      append(to.centre_m, from.centre_m);
      append(to.velocity_mps, from.velocity_mps);
      append(to.along_mps, from.along_mps);
      append(to.first_after_s, from.first_after_s);
    }
  }
}

double f1_score(const MoverScore& score) {
  constexpr double kWithinM = 8.0;
  long told = 0, right = 0, asked = 0, found = 0;
  for (std::size_t r = 0; r < kRanges && kRangesM[r] <= kWithinM; ++r) {
    told += score.told(r).told - score.told(r).neither;
    right += score.told(r).right;
    for (const Traffic kind : {Traffic::Person, Traffic::Truck}) {
      asked += score.found(kind, r).asked;
      found += score.found(kind, r).found;
    }
  }
  if (right == 0 || found == 0) return 0.0;
  const double precision = static_cast<double>(right) / static_cast<double>(told);
  const double recall = static_cast<double>(found) / static_cast<double>(asked);
  return 2.0 * precision * recall / (precision + recall);
}

}  // namespace madori::bench
