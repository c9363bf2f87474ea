#include "localization/global/view_search.hpp"

#include <algorithm>
#include <array>

#include "localization/global/circular_match.hpp"
#include "localization/particle_filter/sensor_kernel.hpp"
#include "localization/pose_axes.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// A place and a turn of the index.
struct Cell {
  std::uint32_t place;
  std::uint32_t turn;
};

/// About `wanted` cells of the lowest costs, each the best or second-best (not adjacent) turn of its place.
std::vector<Cell> cheapest(const std::vector<std::uint16_t>& costs, std::size_t places, std::size_t wanted) {
  constexpr int kTurns = PlaceIndex::kSections;
  std::vector<std::pair<std::uint16_t, Cell>> best;
  best.reserve(2 * places);
  for (std::size_t p = 0; p < places; ++p) {
    const std::uint16_t* row = costs.data() + p * kTurns;
    const auto first = static_cast<int>(std::min_element(row, row + kTurns) - row);
    int second = -1;
    for (int t = 0; t < kTurns; ++t) {
      const int apart = std::min((t - first + kTurns) % kTurns, (first - t + kTurns) % kTurns);
      if (apart > 2 && (second < 0 || row[t] < row[second])) second = t;
    }
    for (const int turn : {first, second})
      best.push_back({row[turn], {static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(turn)}});
  }
  const std::size_t kept = std::min(wanted, best.size());
  const auto by_cost = [](const auto& a, const auto& b) { return a.first < b.first; };
  std::nth_element(best.begin(), best.begin() + static_cast<std::ptrdiff_t>(kept), best.end(), by_cost);
  std::vector<Cell> cells(kept);
  for (std::size_t i = 0; i < kept; ++i) cells[i] = best[i].second;
  return cells;
}

constexpr std::array kSides{-1.0, 0.0, 1.0};
constexpr std::size_t kAround = kSides.size() * kSides.size() * kSides.size();

/// Poses in the neighbourhood of every cell, kAround a cell.
Particles around(const PlaceIndex& index, const std::vector<Cell>& cells) {
  const double section = 2.0 * kPi / PlaceIndex::kSections;
  const double step = index.options().spacing_m / 3.0;
  Particles poses;
  poses.origin = index.places().front();
  for (const auto& [place, turn] : cells)
    for (const double turned : kSides)
      for (const double up : kSides)
        for (const double right : kSides) {
          const Point2<Map>& p = index.places()[place];
          poses.add({p.x_m + right * step, p.y_m + up * step, turn * section + turned * section / 3.0});
        }
  return poses;
}

/// The best pose of every cell by falling sums, none like one before, `wanted` at most.
std::vector<Pose> largest_distinct(const Particles& poses, const std::vector<std::uint32_t>& sums,
                                   std::size_t wanted, double same_m, double same_rad) {
  std::vector<std::size_t> best(poses.size() / kAround);
  for (std::size_t cell = 0; cell < best.size(); ++cell) {
    const auto first = sums.begin() + static_cast<std::ptrdiff_t>(cell * kAround);
    best[cell] = static_cast<std::size_t>(std::max_element(first, first + kAround) - sums.begin());
  }
  std::sort(best.begin(), best.end(), [&](std::size_t a, std::size_t b) { return sums[a] > sums[b]; });
  std::vector<Pose> chosen;
  for (const std::size_t i : best) {
    const Pose pose = poses.pose(i);
    const bool known = std::any_of(chosen.begin(), chosen.end(),
                                   [&](const Pose& c) { return same_place(c, pose, same_m, same_rad); });
    if (!known) chosen.push_back(pose);
    if (chosen.size() == wanted) break;
  }
  return chosen;
}

/// Of every place and turn, kSections a place.
std::vector<std::uint16_t> costs_of_all(const ScanPoints& points, const PlaceIndex& index) {
  const PlaceIndex::View view = index.view(points);
  std::vector<std::uint16_t> costs(index.size() * PlaceIndex::kSections);
  const auto most = static_cast<std::uint8_t>(index.options().unlike_m / index.m_per_count());
  circular_match(view.data(), index.views().data(), index.size(), most, costs.data());
  return costs;
}

}  // namespace

std::vector<Pose> search_views(const ScanPoints& points, const PlaceIndex& index,
                               const LikelihoodField& coarse, std::size_t cells, std::size_t wanted) {
  constexpr std::size_t kBeams = 96;
  constexpr double kApart = 0.25;  // candidates nearer than this register to the same place anyhow
  constexpr double kApartRad = 0.15;
  if (index.size() == 0 || points.empty()) return {};
  const Particles poses = around(index, cheapest(costs_of_all(points, index), index.size(), cells));
  std::vector<std::uint32_t> sums(poses.size());
  sum_counts(poses, BeamBlocks(points, coarse, kBeams), coarse, sums);
  return largest_distinct(poses, sums, wanted, kApart, kApartRad);
}

}  // namespace madori::localization
