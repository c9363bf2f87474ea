#include "localization/warp/place_by_clearances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/angle.hpp"
#include "core/beam_to_segment.hpp"
#include "core/segment_distance.hpp"
#include "localization/warp/seen_clearances.hpp"

namespace madori::localization {
namespace {

constexpr double kNearbyM = 4.0;  ///< walls farther away say nothing of the place in the room
constexpr int kAxes = 8;          ///< directions come in pairs
constexpr double kGridM = 0.05;
/// Standard deviation of the vehicle about its place: arrival, and the memory's surfaces.
constexpr double kStandsM = 0.05;
constexpr double kExactM = 0.1;  ///< ... of a distance, as drawn and as the memory has it (half a voxel)
/// That a beam meets what is drawn against anything else within 2.4 m, where it fits exactly.
constexpr double kPeak = 20.0;
constexpr double kObservation = 0.5;  ///< of a beam: its neighbour mostly meets the same wall
/// Standard deviation of the nearest clearance's logarithm, where it is less than it should be at least.
constexpr double kNearer = 0.2;
constexpr double kUnknown = std::numeric_limits<double>::infinity();

constexpr int kToRim = static_cast<int>(kPlacesReachM / kGridM);
constexpr int kAcross = 2 * kToRim + 1;

double cast(const mapping::Walls& walls, const Point2<Map>& from, double direction_rad) {
  const double dx = std::cos(direction_rad), dy = std::sin(direction_rad);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const mapping::Wall& wall : walls)
    nearest_m = std::min(nearest_m, beam_meets_m(wall.segment, from, dx, dy));
  return nearest_m;
}

double drawn_clearance(const mapping::Walls& walls, const Point2<Map>& from, double direction_rad) {
  const double ahead_m = cast(walls, from, direction_rad);
  const double left_m = cast(walls, from, direction_rad + kBesideRad);
  const double right_m = cast(walls, from, direction_rad - kBesideRad);
  return ahead_m <= kNearbyM && is_of_one_wall(ahead_m, left_m, right_m) ? ahead_m : kUnknown;
}

/// What a beam so far off says for a place; nothing where something else stands in its way.
double nats(double off_m) {
  constexpr double kBinM = 0.005;
  static const auto table = [] {
    std::array<double, 100> made{};
    for (std::size_t k = 0; k < made.size(); ++k) {
      const double z = static_cast<double>(k) * kBinM / kExactM;
      made[k] = kObservation * std::log1p(kPeak * std::exp(-0.5 * z * z));
    }
    return made;
  }();
  const double bin = off_m / kBinM + 0.5;
  return bin < static_cast<double>(table.size()) ? table[static_cast<std::size_t>(bin)] : 0.0;
}

/// How well the distances both ways are those that are drawn, in nats.
double nats(const Both& drawn_m, const Both& seen_m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!std::isfinite(drawn_m[i]) || !std::isfinite(seen_m[i])) continue;
    double off_m = std::abs(seen_m[i] - drawn_m[i]);
    if (std::isfinite(drawn_m[1 - i]) && std::isfinite(seen_m[1 - i]))
      off_m = std::min(
          off_m, std::abs(seen_m[i] - (seen_m[0] + seen_m[1]) * drawn_m[i] / (drawn_m[0] + drawn_m[1])));
    sum += nats(off_m);
  }
  return sum;
}

/// Whoever loads there stands between the vehicle and the nearest wall: what is nearer than it should be at
/// least counts by its share.
double nearest_nats(double least_m, double seen_m) {
  if (seen_m >= least_m) return 0.0;
  const double z = std::log(std::max(0.01, seen_m / least_m)) / kNearer;
  return -0.5 * z * z;
}

/// Row by row of places about the expected one.
using Grid = std::array<double, static_cast<std::size_t>(kAcross) * kAcross>;

/// Where the i-th of them lies beside the expected one, metres.
std::array<double, 2> beside(std::size_t i) {
  const auto k = static_cast<int>(i);
  return {(k % kAcross - kToRim) * kGridM, (k / kAcross - kToRim) * kGridM};
}

Grid where_expected(double sigma_m) {
  Grid grid;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const auto [x, y] = beside(i);
    grid[i] = -0.5 * (x * x + y * y) / (sigma_m * sigma_m);
  }
  return grid;
}

/// How well the vehicle stands where it is sent to a place, in nats: it comes to stand near by.
Grid where_it_stands(Grid grid) {
  constexpr int kBeside = 3;
  const double most = *std::max_element(grid.begin(), grid.end());
  for (double& nats : grid) nats = std::exp(nats - most);
  for (const int step : {1, kAcross}) {
    const Grid before = grid;
    for (int i = 0; i < kAcross * kAcross; ++i) {
      const int k = i / step % kAcross;
      double weights = 0.0, weighed = 0.0;
      for (int d = std::max(-kBeside, -k); d <= std::min(kBeside, kAcross - 1 - k); ++d) {
        const double z = d * kGridM / kStandsM, weight = std::exp(-0.5 * z * z);
        weights += weight;
        weighed += weight * before[static_cast<std::size_t>(i + d * step)];
      }
      grid[static_cast<std::size_t>(i)] = weighed / weights;
    }
  }
  for (double& share : grid) share = std::log(share);
  return grid;
}

Point2<Map> highest(const Grid& grid, const Point2<Map>& expected) {
  const auto best = static_cast<int>(std::max_element(grid.begin(), grid.end()) - grid.begin());
  const int u = best % kAcross, v = best / kAcross;
  const auto [x_m, y_m] = beside(static_cast<std::size_t>(best));
  // Between the steps, by a parabola: the place does not jump as the memory grows.
  const auto between = [&](int step, int k) {
    if (k == 0 || k == kAcross - 1) return 0.0;
    const auto at = [&](int i) { return grid[static_cast<std::size_t>(best + i * step)]; };
    const double bend = at(-1) - 2.0 * at(0) + at(1);
    return bend < -1e-9 ? std::clamp(0.5 * (at(-1) - at(1)) / bend, -0.5, 0.5) : 0.0;
  };
  return {expected.x_m + x_m + between(1, u) * kGridM, expected.y_m + y_m + between(kAcross, v) * kGridM};
}

}  // namespace

Point2<Map> place_by_clearances(const mapping::Walls& drawn, const MemoryCloud& seen,
                                const Point2<Map>& place, const Point2<Map>& expected, double sigma_m) {
  mapping::Walls walls;
  for (const mapping::Wall& wall : drawn)
    if (distance_m(wall.segment, place) < kNearbyM + kEdgeM) walls.push_back(wall);
  MemoryCloud about;
  for (CloudSurface s : seen) {
    s.x_m -= expected.x_m, s.y_m -= expected.y_m;
    if (std::hypot(s.x_m, s.y_m) < kNearbyM + 2.0 * kPlacesReachM) about.push_back(s);
  }
  Grid grid = where_expected(sigma_m), nearest_m;
  nearest_m.fill(std::numeric_limits<double>::infinity());
  double drawn_nearest_m = kNearbyM;
  for (int k = 0; k < kAxes; ++k) {
    const double direction = kPi * k / kAxes;
    const Both drawn_m{drawn_clearance(walls, place, direction),
                       drawn_clearance(walls, place, direction + kPi)};
    drawn_nearest_m = std::min({drawn_nearest_m, drawn_m[0], drawn_m[1]});
    const SeenClearances seen_about(direction, about);
    for (std::size_t i = 0; i < grid.size(); ++i) {
      const auto [x, y] = beside(i);
      const Both seen_m = seen_about.nearest(x, y);
      nearest_m[i] = std::min({nearest_m[i], seen_m[0], seen_m[1]});
      if (std::isfinite(drawn_m[0]) || std::isfinite(drawn_m[1]))
        grid[i] += nats(drawn_m, seen_about.of_walls(seen_m, x, y));
    }
  }
  grid = where_it_stands(grid);
  // What is not drawn pushes nobody away from where it stood beside the expected place already.
  const double least_m = std::min(drawn_nearest_m, nearest_m[kToRim * kAcross + kToRim]);
  for (std::size_t i = 0; i < grid.size(); ++i) grid[i] += nearest_nats(least_m, nearest_m[i]);
  return highest(grid, expected);
}

}  // namespace madori::localization
