#include "localization/wall_reliability/wall_weights.hpp"

#include <cmath>

namespace madori::localization {
namespace {

/// How one piece is to be taken.
struct Verdict {
  double weight = 1.0;  ///< 0: left out
  double offset_m = 0.0;

  friend bool operator==(const Verdict&, const Verdict&) = default;
};

constexpr double kSureLooks = 5.0;     ///< before a wall is left out or moved
constexpr double kSureShare = 0.7;     ///< of the looks that must agree
constexpr double kSureSigmaM = 0.1;    ///< a place beside that is less certain is not used
constexpr double kUnsure = 0.3;        ///< weight of a piece that is neither sure nor confirmed
constexpr double kOffsetStepM = 0.02;  // so that neighbours moved alike are one wall again

Verdict verdict(const WallReliability& reliability, std::size_t cell) {
  const WallBelief& b = reliability.beliefs()[cell];
  const auto sure = [&](double count) { return b.looks() >= kSureLooks && count >= kSureShare * b.looks(); };
  switch (reliability.state(cell)) {
    case WallState::Unseen:
    case WallState::Confirmed:
      return {};
    case WallState::Missing:
      return {sure(b.missed) ? 0.0 : kUnsure, 0.0};
    case WallState::Displaced:
      if (!sure(b.beside) || b.offset_sigma_m > kSureSigmaM) return {kUnsure, 0.0};
      return {1.0, kOffsetStepM * std::round(b.offset_m / kOffsetStepM)};
  }
  return {};
}

Segment2<Map> moved_aside(const Segment2<Map>& s, double offset_m) {
  const double length = s.length_m();
  if (offset_m == 0.0 || length <= 0.0) return s;
  const double dx = -(s.b.y_m - s.a.y_m) / length * offset_m;
  const double dy = (s.b.x_m - s.a.x_m) / length * offset_m;
  return {{s.a.x_m + dx, s.a.y_m + dy}, {s.b.x_m + dx, s.b.y_m + dy}};
}

}  // namespace

bool is_surely_missing(const WallReliability& reliability, std::size_t cell) {
  return verdict(reliability, cell).weight <= 0.0;
}

WallWeights wall_weights(const mapping::Walls& walls, const WallReliability& reliability) {
  WallWeights result;
  const WallCells& cells = reliability.cells();
  for (std::size_t wall = 0; wall < walls.size(); ++wall) {
    for (std::size_t c = cells.first(wall); c < cells.first(wall + 1);) {
      const Verdict first = verdict(reliability, c);
      const std::size_t begin = c;
      while (c < cells.first(wall + 1) && verdict(reliability, c) == first) ++c;
      if (first.weight <= 0.0) continue;
      const bool whole = begin == cells.first(wall) && c == cells.first(wall + 1);
      const Segment2<Map> piece =
          whole ? walls[wall].segment
                : Segment2<Map>{cells.all()[begin].segment.a, cells.all()[c - 1].segment.b};
      result.walls.push_back({walls[wall].id, moved_aside(piece, first.offset_m), walls[wall].probability});
      result.weights.push_back(first.weight);
    }
  }
  return result;
}

}  // namespace madori::localization
