#include "localization/wall_reliability/wall_cells.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

constexpr double kBucketM = 4.0;

Point2<Map> between(const Segment2<Map>& s, double share) {
  return {s.a.x_m + share * (s.b.x_m - s.a.x_m), s.a.y_m + share * (s.b.y_m - s.a.y_m)};
}

}  // namespace

WallCells::WallCells(const mapping::Walls& walls, double length_m)
    : frame_(mapping::GridFrame::around(walls, length_m, kBucketM)), buckets_(frame_.cells()) {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Segment2<Map>& s = walls[i].segment;
    const double length = s.length_m();
    const int pieces = length > 0.0 ? std::max(1, static_cast<int>(std::lround(length / length_m))) : 0;
    first_.push_back(cells_.size());
    piece_length_m_.push_back(pieces > 0 ? length / pieces : 0.0);
    for (int k = 0; k < pieces; ++k)
      cells_.push_back(
          {i,
           walls[i].id,
           k,
           {between(s, static_cast<double>(k) / pieces), between(s, static_cast<double>(k + 1) / pieces)}});
  }
  first_.push_back(cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const std::int64_t bucket = frame_.find(between(cells_[c].segment, 0.5));
    if (bucket >= 0) buckets_[static_cast<std::size_t>(bucket)].push_back(static_cast<std::uint32_t>(c));
  }
}

std::size_t WallCells::at(std::size_t wall, double along_m) const {
  const auto last = static_cast<double>(first_[wall + 1] - first_[wall] - 1);
  return first_[wall] +
         static_cast<std::size_t>(std::clamp(std::floor(along_m / piece_length_m_[wall]), 0.0, last));
}

std::vector<std::uint32_t> WallCells::near(const Point2<Map>& place, double radius_m) const {
  const auto bound = [&](double offset_m, int limit) {
    return static_cast<int>(std::clamp(std::floor(offset_m / kBucketM), 0.0, static_cast<double>(limit)));
  };
  const double x = place.x_m - frame_.origin.x_m;
  const double y = place.y_m - frame_.origin.y_m;
  const int u2 = bound(x + radius_m, frame_.width - 1);
  const int v2 = bound(y + radius_m, frame_.height - 1);
  std::vector<std::uint32_t> found;
  for (int v = bound(y - radius_m, frame_.height - 1); v <= v2; ++v)
    for (int u = bound(x - radius_m, frame_.width - 1); u <= u2; ++u) {
      const auto& bucket = buckets_[frame_.index(u, v)];
      found.insert(found.end(), bucket.begin(), bucket.end());
    }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace madori::localization
