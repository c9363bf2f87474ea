#pragma once
// The score of a wall map by length, as the acceptance of the drawings defines it: a stretch is right when a
// wall of the other set passes within the tolerance in about the same direction.

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"

namespace madori::test {

struct WallScore {
  double precision = 0, recall = 0, detected_px = 0, truth_px = 0;
  [[nodiscard]] double f1() const {
    return precision + recall > 0 ? 2 * precision * recall / (precision + recall) : 0;
  }
};

inline bool passes_near(const mapping::PixelSegment& s, double u, double v, double tolerance) {
  const double length = s.length_px(), du = (s.u2 - s.u1) / length, dv = (s.v2 - s.v1) / length;
  const double along = std::clamp((u - s.u1) * du + (v - s.v1) * dv, 0.0, length);
  return std::hypot(s.u1 + along * du - u, s.v1 + along * dv - v) <= tolerance;
}

/// The share of the length of `of` that has a wall of `in` beside it.
inline double matched_share(const std::vector<mapping::PixelSegment>& of,
                            const std::vector<mapping::PixelSegment>& in, double tolerance_px,
                            double& total) {
  const double sine = std::sin(10 * std::numbers::pi / 180);
  double right = 0;
  total = 0;
  for (const auto& s : of) {
    const double length = s.length_px();
    std::vector<mapping::PixelSegment> parallel;
    for (const auto& o : in)
      if (std::abs((s.u2 - s.u1) * (o.v2 - o.v1) - (s.v2 - s.v1) * (o.u2 - o.u1)) <=
              sine * length * o.length_px() &&
          o.length_px() > 0)
        parallel.push_back(o);
    const int steps = std::max(1, static_cast<int>(std::ceil(length / (tolerance_px / 4))));
    int hits = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) / steps, u = std::lerp(s.u1, s.u2, t), v = std::lerp(s.v1, s.v2, t);
      hits += std::any_of(parallel.begin(), parallel.end(),
                          [&](const auto& o) { return passes_near(o, u, v, tolerance_px); });
    }
    right += length * hits / steps;
    total += length;
  }
  return total > 0 ? right / total : 0;
}

inline WallScore score_walls(const std::vector<mapping::PixelSegment>& detected,
                             const std::vector<mapping::PixelSegment>& truth, double tolerance_px) {
  WallScore score;
  score.precision = matched_share(detected, truth, tolerance_px, score.detected_px);
  score.recall = matched_share(truth, detected, tolerance_px, score.truth_px);
  return score;
}

/// Rows `u1,v1,u2,v2` after a header.
inline std::vector<mapping::PixelSegment> read_true_walls(const std::string& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  std::vector<mapping::PixelSegment> walls;
  while (std::getline(stream, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream row(line);
    mapping::PixelSegment s;
    if (row >> s.u1 >> s.v1 >> s.u2 >> s.v2 && s.length_px() > 0) walls.push_back(s);
  }
  return walls;
}

}  // namespace madori::test
