#include "localization/surroundings/recent_view.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace madori::localization {
namespace {

constexpr double kCellM = 0.5;  // at least the longest reach
constexpr std::size_t kFewestPoints = 20;
constexpr std::size_t kSectors = RecentView::kSectors;

std::uint64_t cell_at(double x_m, double y_m) {
  constexpr std::int64_t kMiddle = 1 << 20;  // negative places sort among the others
  const auto u = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(x_m / kCellM)) + kMiddle);
  const auto v = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(y_m / kCellM)) + kMiddle);
  return (v << 32) | u;
}

/// Within which a surface counts as the same: voxel and noise, and half the gap between two beams.
double same_within_m(const Point2<Base>& p) {
  return std::min(0.15 + 0.01 * std::hypot(p.x_m, p.y_m), kCellM);
}

std::size_t sector_of(const Point2<Base>& p) {
  const double turn = (std::atan2(p.y_m, p.x_m) + kPi) / (2.0 * kPi);
  return std::min(static_cast<std::size_t>(turn * kSectors), kSectors - 1);
}

}  // namespace

bool RecentView::Surfaces::has_near(const Point2<Base>& p, double within_m) const {
  for (int row = -1; row <= 1; ++row) {
    const std::uint64_t first = cell_at(p.x_m - kCellM, p.y_m + row * kCellM);
    auto s = std::lower_bound(points.begin(), points.end(), first,
                              [](const Point& a, std::uint64_t cell) { return a.cell < cell; });
    for (; s != points.end() && s->cell <= first + 2; ++s)
      if (distance_m({s->x_m, s->y_m}, p) < within_m) return true;
  }
  return false;
}

/// Whether nothing that this one saw stands before the place.
bool RecentView::Surfaces::could_see(const Point2<Base>& p) const {
  return std::hypot(p.x_m, p.y_m) < static_cast<double>(reach_m[sector_of(p)]) + same_within_m(p);
}

/// Between two directions from which something came back lies what came back from the nearer one.
void RecentView::Surfaces::fill_gaps() {
  constexpr std::size_t kWidest = 6;  // sectors; wider ones lie outside the field of view
  std::array<float, kSectors> filled = reach_m;
  for (std::size_t i = 0; i < kSectors; ++i) {
    if (reach_m[i] == 0.0F) continue;
    for (std::size_t gap = 1; gap <= kWidest; ++gap) {
      const float next = reach_m[(i + gap) % kSectors];
      if (next == 0.0F) continue;
      for (std::size_t k = 1; k < gap; ++k) filled[(i + k) % kSectors] = std::min(reach_m[i], next);
      break;
    }
  }
  reach_m = filled;
}

/// What lies outside the field of view of this one, or behind what it saw, says nothing: a scanner turned, or
/// the vehicle came through a door.
double RecentView::Surfaces::share_of(const Surfaces& others,
                                      const Transform2<Base, Base>& this_from_others) const {
  double total = 0.0;
  double near = 0.0;
  std::size_t comparable = 0;
  for (const Point& other : others.points) {
    const Point2<Base> p{other.x_m, other.y_m};
    const Point2<Base> here = this_from_others * p;
    if (!could_see(here)) continue;
    ++comparable;
    total += other.weight;
    if (has_near(here, same_within_m(p))) near += other.weight;
  }
  return comparable >= kFewestPoints && total > 0.0 ? near / total : 1.0;
}

void RecentView::take(Stamp stamp, const ScanPoints& points) {
  std::swap(before_, now_);
  now_.stamp = stamp;
  now_.points.clear();
  now_.reach_m.fill(0.0F);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point2<Base> p = points.point(i);
    if (!std::isfinite(p.x_m) || !std::isfinite(p.y_m)) continue;
    now_.points.push_back({cell_at(p.x_m, p.y_m), p.x_m, p.y_m, points.weight_of(i)});
    float& reach = now_.reach_m[sector_of(p)];
    reach = std::max(reach, static_cast<float>(std::hypot(p.x_m, p.y_m)));
  }
  now_.fill_gaps();
  std::sort(now_.points.begin(), now_.points.end(),
            [](const Surfaces::Point& a, const Surfaces::Point& b) { return a.cell < b.cell; });
}

double RecentView::kept(const Transform2<Base, Base>& before_from_now) const {
  if (std::min(before_.points.size(), now_.points.size()) < kFewestPoints ||
      now_.stamp - before_.stamp > kRecent)
    return 1.0;
  return 0.5 * (before_.share_of(now_, before_from_now) + now_.share_of(before_, before_from_now.inverse()));
}

void RecentView::learn(double kept) {
  constexpr int kMemory = 20;  // scans
  learned_ = std::min(learned_ + 1, kMemory);
  usual_ += (kept - usual_) / learned_;
}

}  // namespace madori::localization
