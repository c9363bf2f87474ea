#include "mapping/drawing/raster/arcs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

namespace madori::mapping {
namespace {

constexpr double kLargestRadius = 25;  // wall thicknesses: about the leaf of a gate
constexpr double kLeastTurn = 0.6;     // radians
constexpr double kPairedShare = 0.5;

/// The turn of a chain from piece to piece, when all turns go one way; 0 for anything else.
double turn_of(const DrawnLines& lines, const std::vector<std::size_t>& pieces) {
  double left = 0, right = 0;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const PixelSegment &a = lines[pieces[i - 1]].segment, &b = lines[pieces[i]].segment;
    const double au = a.u2 - a.u1, av = a.v2 - a.v1, bu = b.u2 - b.u1, bv = b.v2 - b.v1;
    const double turn = std::atan2(au * bv - av * bu, au * bu + av * bv);
    if (std::abs(turn) > 1.0) return 0;  // a corner
    (turn > 0 ? left : right) += std::abs(turn);
  }
  return std::min(left, right) > 0.15 * (left + right) ? 0 : left + right;
}

}  // namespace

void reject_arcs(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style) {
  std::map<int, std::vector<std::size_t>> chains;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].chain >= 0 && !lines[i].rejected) chains[lines[i].chain].push_back(i);
  for (const auto& [chain, pieces] : chains) {
    if (pieces.size() < 3) continue;
    double length = 0, paired = 0;
    for (const std::size_t i : pieces) {
      length += lines[i].length_px();
      paired += std::min(evidence[i].paired_px, lines[i].length_px());
    }
    const double turn = turn_of(lines, pieces);
    if (turn < kLeastTurn || paired > kPairedShare * length) continue;
    if (length / turn > kLargestRadius * style.thickness_px) continue;
    const auto reason = turn > 1.2 * std::numbers::pi ? RejectReason::Furniture : RejectReason::DoorArc;
    for (const std::size_t i : pieces) lines[i].rejected = reason;
  }
}

}  // namespace madori::mapping
