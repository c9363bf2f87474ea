#include "localization/memory/score_grid.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace madori::localization {
namespace {

constexpr int kReach = 4;             // cells that a point is smeared over
constexpr double kSigmaM = 0.07;      // of the smear: range noise plus the grid's own rounding
constexpr int kMargin = kReach + 16;  // so that windows may look over the border
/// Against a score of 0..1. The penalty grows with the logarithm: wheels that slipped are far off at once.
constexpr double kPenaltyWeight = 0.03;

constexpr std::size_t kKernelSide = 2 * kReach + 1;
constexpr std::size_t kStride = 16;  // of the kernel's rows, the rest zero: one vector each
static_assert(kKernelSide <= kStride && kMargin >= static_cast<int>(kStride));
using Kernel = std::array<std::uint8_t, kKernelSide * kStride>;

Kernel smear_kernel() {
  Kernel kernel{};
  for (int y = -kReach; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      const double d = std::hypot(x, y) * ScoreGrid::kResolutionM / kSigmaM;
      kernel[static_cast<std::size_t>(y + kReach) * kStride + static_cast<std::size_t>(x + kReach)] =
          static_cast<std::uint8_t>(std::lround(255.0 * std::exp(-0.5 * d * d)));
    }
  }
  return kernel;
}

/// Of points by their weight, in 256ths.
const std::vector<Kernel>& smear_kernels() {
  static const std::vector<Kernel> kernels = [] {
    std::vector<Kernel> all(257, smear_kernel());
    for (unsigned weight = 0; weight <= 256; ++weight)
      for (std::uint8_t& value : all[weight]) value = static_cast<std::uint8_t>(value * weight >> 8U);
    return all;
  }();
  return kernels;
}

}  // namespace

void ScoreGrid::build(const std::vector<Mark>& marks) {
  width_ = height_ = 0;
  if (marks.empty()) {
    return;
  }
  Point2<Map> low = marks.front().point;
  Point2<Map> high = low;
  for (const auto& [p, weight] : marks) {
    low = {std::min(low.x_m, p.x_m), std::min(low.y_m, p.y_m)};
    high = {std::max(high.x_m, p.x_m), std::max(high.y_m, p.y_m)};
  }
  origin_ = {low.x_m - kMargin * kResolutionM, low.y_m - kMargin * kResolutionM};
  width_ = static_cast<int>((high.x_m - low.x_m) / kResolutionM) + 2 * kMargin + 1;
  height_ = static_cast<int>((high.y_m - low.y_m) / kResolutionM) + 2 * kMargin + 1;
  smear(marks);
  for (int level = 1; level < kLevels; ++level) {
    pool(level);
  }
}

void ScoreGrid::smear(const std::vector<Mark>& marks) {
  const std::vector<Kernel>& kernels = smear_kernels();
  Level& grid = levels_[0];
  grid.assign(static_cast<std::size_t>(width_) * height_, 0);
  for (const auto& [p, weight] : marks) {
    const int cx = static_cast<int>((p.x_m - origin_.x_m) / kResolutionM);
    const int cy = static_cast<int>((p.y_m - origin_.y_m) / kResolutionM);
    const std::uint8_t* from = kernels[static_cast<std::size_t>(std::lround(256.0 * weight))].data();
    for (int y = cy - kReach; y <= cy + kReach; ++y, from += kStride) {
      std::uint8_t* to = grid.data() + static_cast<std::size_t>(y) * width_ + cx - kReach;
#pragma omp simd
      for (std::size_t x = 0; x < kStride; ++x) to[x] = std::max(to[x], from[x]);
    }
  }
}

/// Level n at (x, y) is the maximum over the 2^n cells right of and above (x, y).
void ScoreGrid::pool(int level) {
  const int half = 1 << (level - 1);
  const Level& fine = levels_[static_cast<std::size_t>(level - 1)];
  Level& out = levels_[static_cast<std::size_t>(level)];
  out.resize(fine.size());
  row_.resize(static_cast<std::size_t>(width_));
  const int pairs = std::max(0, width_ - half);
  for (int y = 0; y < height_; ++y) {
    const std::uint8_t* low = fine.data() + static_cast<std::size_t>(y) * width_;
    const std::uint8_t* high = y + half < height_ ? low + static_cast<std::ptrdiff_t>(half) * width_ : low;
    std::uint8_t* up = row_.data();
    std::uint8_t* to = out.data() + static_cast<std::size_t>(y) * width_;
#pragma omp simd
    for (int x = 0; x < width_; ++x) up[x] = std::max(low[x], high[x]);
#pragma omp simd
    for (int x = 0; x < pairs; ++x) to[x] = std::max(up[x], up[x + half]);
    std::copy(up + pairs, up + width_, to + pairs);
  }
}

/// One search: the scan's cells per rotation, and the depth-first descent through the levels.
class BranchAndBound {
 public:
  BranchAndBound(const ScoreGrid& grid, const SurfaceScan& scan, const Transform2<Map, Base>& prediction,
                 const SearchWindow& window)
      : grid_(grid), scan_(scan), prediction_(prediction), window_(window), room_(grid.room_) {}

  SearchResult run() {
    best_ = {prediction_, -1.0};
    reach_ = static_cast<int>(std::ceil(window_.half_m / ScoreGrid::kResolutionM));
    make_rotations();
    constexpr int kTop = ScoreGrid::kLevels - 1;
    auto& top = room_.top;
    top.clear();
    for (std::size_t r = 0; r + 1 < room_.rotations.size(); ++r) {
      for (int y = -reach_; y <= reach_; y += 1 << kTop) {
        for (int x = -reach_; x <= reach_; x += 1 << kTop) {
          top.push_back({r, x, y, bound(r, x, y, kTop), top.size()});
        }
      }
    }
    descend(top, kTop);
    return best_;
  }

 private:
  using Candidate = ScoreGrid::Candidate;

  /// The angle by which three quarters of the points move by less than two cells.
  [[nodiscard]] double step_rad() const {
    double far = 1.0;
    auto& ranges = room_.ranges;
    ranges.clear();
    for (const SurfacePoint& p : scan_.points) {
      ranges.push_back(std::hypot(p.x_m, p.y_m));
    }
    if (!ranges.empty()) {
      std::nth_element(ranges.begin(), ranges.begin() + static_cast<long>(ranges.size() * 3 / 4),
                       ranges.end());
      far = std::max(far, ranges[ranges.size() * 3 / 4]);
    }
    return std::clamp(1.5 * ScoreGrid::kResolutionM / far, 0.005, 0.035);
  }

  void make_rotations() {
    const double step = step_rad();
    const int count = static_cast<int>(std::ceil(window_.half_rad / step));
    room_.rotations.clear();
    room_.inside.clear();
    room_.outside.clear();
    for (int i = -count; i <= count; ++i) {
      room_.rotations.push_back({i * step, room_.inside.size(), room_.outside.size()});
      const Transform2<Map, Base> pose(prediction_.x_m(), prediction_.y_m(),
                                       prediction_.yaw_rad() + i * step);
      for (const SurfacePoint& p : scan_.points) add(pose * Point2<Base>{p.x_m, p.y_m});
    }
    room_.rotations.push_back({0.0, room_.inside.size(), room_.outside.size()});  // where the last one ends
  }

  void add(const Point2<Map>& q) {
    const int x = static_cast<int>(std::floor((q.x_m - grid_.origin_.x_m) / ScoreGrid::kResolutionM));
    const int y = static_cast<int>(std::floor((q.y_m - grid_.origin_.y_m) / ScoreGrid::kResolutionM));
    if (x >= reach_ && x + reach_ < grid_.width_ && y >= reach_ && y + reach_ < grid_.height_)
      room_.inside.push_back(y * grid_.width_ + x);
    else
      room_.outside.push_back({x, y});
  }

  /// Least penalty of any offset within the window of 2^level cells that starts at (x, y).
  double penalty(std::size_t r, int x, int y, int level) const {
    const int width = (1 << level) - 1;
    const auto nearest = [width](int v) { return v > 0 ? v : std::min(0, v + width); };
    const double d = std::hypot(nearest(x), nearest(y)) * ScoreGrid::kResolutionM / window_.sigma_m;
    const double a = room_.rotations[r].offset_rad / window_.sigma_rad;
    return kPenaltyWeight * std::log1p(d * d + a * a);
  }

  double bound(std::size_t r, int x, int y, int level) const {
    const ScoreGrid::Rotation& from = room_.rotations[r];
    const ScoreGrid::Rotation& to = room_.rotations[r + 1];
    const ScoreGrid::Level& values = grid_.levels_[static_cast<std::size_t>(level)];
    const int shift = y * grid_.width_ + x;
    unsigned sum = 0;
    for (std::size_t i = from.first_inside; i < to.first_inside; ++i)
      sum += values[static_cast<std::size_t>(room_.inside[i] + shift)];
    for (std::size_t i = from.first_outside; i < to.first_outside; ++i)
      sum += grid_.at(level, room_.outside[i][0] + x, room_.outside[i][1] + y);
    const std::size_t points = scan_.points.size();
    const double mean = points == 0 ? 0.0 : sum / (255.0 * static_cast<double>(points));
    return mean - penalty(r, x, y, level);
  }

  void descend(std::span<Candidate> candidates, int level) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
      return a.bound != b.bound ? a.bound > b.bound : a.order < b.order;
    });
    for (const Candidate& c : candidates) {
      if (c.bound <= best_.score) {
        return;
      }
      if (level == 0) {
        const double cell = ScoreGrid::kResolutionM;
        best_ = {Transform2<Map, Base>(prediction_.x_m() + c.x * cell, prediction_.y_m() + c.y * cell,
                                       prediction_.yaw_rad() + room_.rotations[c.rotation].offset_rad),
                 c.bound};
        continue;
      }
      const int half = 1 << (level - 1);
      std::array<Candidate, 4> children;
      std::size_t count = 0;
      for (int y = c.y; y <= std::min(reach_, c.y + half); y += half) {
        for (int x = c.x; x <= std::min(reach_, c.x + half); x += half) {
          children[count] = {c.rotation, x, y, bound(c.rotation, x, y, level - 1), count};
          ++count;
        }
      }
      descend(std::span(children.data(), count), level - 1);
    }
  }

  const ScoreGrid& grid_;
  const SurfaceScan& scan_;
  Transform2<Map, Base> prediction_;
  SearchWindow window_;
  ScoreGrid::SearchRoom& room_;
  int reach_ = 0;  ///< of the window, in cells
  SearchResult best_;
};

SearchResult ScoreGrid::search(const SurfaceScan& scan, const Transform2<Map, Base>& prediction,
                               const SearchWindow& window) const {
  return BranchAndBound(*this, scan, prediction, window).run();
}

}  // namespace madori::localization
