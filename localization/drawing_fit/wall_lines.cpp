#include "localization/drawing_fit/wall_lines.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/angle.hpp"

namespace madori::localization {
namespace {

constexpr int kTurns = 180;  // directed normals, 2 degrees a bin
constexpr double kTurnRad = 2.0 * kPi / kTurns;
constexpr int kSpread = 4;  // bins to each side that a surface's normal may be wrong by
constexpr double kRhoM = 0.06;
constexpr double kSameDirection = 0.85;  // cosine between a surface's normal and its line's

/// A line by its unit normal n and n . p = rho.
struct Line {
  double nx, ny, rho;
  [[nodiscard]] double off(const CloudSurface& p) const { return nx * p.x_m + ny * p.y_m - rho; }
  [[nodiscard]] double along(const CloudSurface& p) const { return -ny * p.x_m + nx * p.y_m; }
  [[nodiscard]] Point2<Map> at(double along) const { return {nx * rho - ny * along, ny * rho + nx * along}; }
  [[nodiscard]] bool has(const CloudSurface& p, double reach_m) const {
    return std::abs(off(p)) < reach_m && nx * p.normal_x + ny * p.normal_y > kSameDirection;
  }
};

/// Votes for lines by (direction of the normal, distance from the cloud's centre).
class Votes {
 public:
  explicit Votes(const MemoryCloud& cloud) {
    for (const CloudSurface& p : cloud) {
      cx_ += p.x_m / static_cast<double>(cloud.size());
      cy_ += p.y_m / static_cast<double>(cloud.size());
    }
    double far = 1.0;
    for (const CloudSurface& p : cloud) far = std::max(far, std::hypot(p.x_m - cx_, p.y_m - cy_));
    half_ = static_cast<int>(far / kRhoM) + 2;
    votes_.assign(static_cast<std::size_t>(kTurns) * (2 * half_ + 1), 0);
    for (const CloudSurface& p : cloud) add(p, 1);
  }

  void add(const CloudSurface& p, int sign) {
    const int centre = static_cast<int>(std::floor(std::atan2(p.normal_y, p.normal_x) / kTurnRad));
    for (int i = centre - kSpread; i <= centre + kSpread; ++i) {
      const int turn = (i % kTurns + kTurns) % kTurns;
      const Line line = line_at(turn, 0);
      const int rho = static_cast<int>(std::lround(line.off(p) / kRhoM));
      for (int r = rho - 1; r <= rho + 1; ++r) {  // one cell to each side: noise across the border
        if (std::abs(r) <= half_) votes_[index(turn, r)] += sign * (r == rho ? 2 : 1);
      }
    }
  }
  /// Looks for the strongest line that was not given up; its strength in surfaces.
  double find_best() {
    const auto at = std::max_element(votes_.begin(), votes_.end());
    best_ = static_cast<std::size_t>(at - votes_.begin());
    return 0.5 * *at;
  }
  [[nodiscard]] Line best() const {
    const auto row = 2 * static_cast<std::size_t>(half_) + 1;
    return line_at(static_cast<int>(best_ / row), static_cast<int>(best_ % row) - half_);
  }
  void give_up_best() { votes_[best_] = -1000000; }

 private:
  [[nodiscard]] std::size_t index(int turn, int rho) const {
    return static_cast<std::size_t>(turn) * (2 * half_ + 1) + static_cast<std::size_t>(rho + half_);
  }
  [[nodiscard]] Line line_at(int turn, int rho) const {
    const double angle = (turn + 0.5) * kTurnRad;
    const double nx = std::cos(angle);
    const double ny = std::sin(angle);
    return {nx, ny, nx * cx_ + ny * cy_ + rho * kRhoM};
  }

  double cx_ = 0.0;
  double cy_ = 0.0;
  int half_ = 0;
  std::size_t best_ = 0;
  std::vector<int> votes_;
};

using Members = std::vector<const CloudSurface*>;

Members members_of(const Line& line, const MemoryCloud& cloud, const std::vector<char>& taken,
                   double reach_m) {
  Members members;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (taken[i] == 0 && line.has(cloud[i], reach_m)) members.push_back(&cloud[i]);
  }
  std::sort(members.begin(), members.end(), [&](const auto* a, const auto* b) {
    return std::pair(line.along(*a), line.off(*a)) < std::pair(line.along(*b), line.off(*b));
  });
  return members;
}

/// The longest run without a gap.
Members longest_run(const Line& line, const Members& members, double gap_m) {
  std::size_t best_first = 0;
  std::size_t best_end = 0;
  double best = -1.0;
  for (std::size_t first = 0, i = 1; i <= members.size(); ++i) {
    if (i < members.size() && line.along(*members[i]) - line.along(*members[i - 1]) < gap_m) continue;
    const double length = line.along(*members[i - 1]) - line.along(*members[first]);
    if (length > best) {
      best = length;
      best_first = first;
      best_end = i;
    }
    first = i;
  }
  return {members.begin() + static_cast<long>(best_first), members.begin() + static_cast<long>(best_end)};
}

/// Total least squares; the normal keeps its side.
Line fitted(const Line& line, const Members& members) {
  const double n = static_cast<double>(members.size());
  double mx = 0.0;
  double my = 0.0;
  for (const auto* p : members) {
    mx += p->x_m / n;
    my += p->y_m / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const auto* p : members) {
    xx += (p->x_m - mx) * (p->x_m - mx);
    xy += (p->x_m - mx) * (p->y_m - my);
    yy += (p->y_m - my) * (p->y_m - my);
  }
  const double direction = 0.5 * std::atan2(2.0 * xy, xx - yy);
  Line out{-std::sin(direction), std::cos(direction), 0.0};
  if (out.nx * line.nx + out.ny * line.ny < 0.0) out = {-out.nx, -out.ny, 0.0};
  out.rho = out.nx * mx + out.ny * my;
  return out;
}

MemoryCloud believed(const MemoryCloud& cloud, const WallLineOptions& options) {
  MemoryCloud kept;
  std::copy_if(cloud.begin(), cloud.end(), std::back_inserter(kept), [&](const CloudSurface& p) {
    return p.sightings >= options.least_sightings && p.standing >= options.least_standing;
  });
  return kept;
}

double mean_standing(const Members& members) {
  double sum = 0.0;
  for (const CloudSurface* p : members) sum += p->standing;
  return sum / static_cast<double>(members.size());
}

}  // namespace

mapping::Walls wall_lines(const MemoryCloud& all, const WallLineOptions& options) {
  const MemoryCloud cloud = believed(all, options);
  mapping::Walls walls;
  if (cloud.empty()) return walls;
  Votes votes(cloud);
  std::vector<char> taken(cloud.size(), 0);
  const double least_surfaces = 0.7 * options.least_length_m / kVoxelM;
  while (votes.find_best() > least_surfaces) {
    Line line = votes.best();
    Members run = longest_run(line, members_of(line, cloud, taken, options.reach_m), options.largest_gap_m);
    for (int i = 0; i < 2 && run.size() > 2; ++i) {
      line = fitted(line, run);
      run = longest_run(line, members_of(line, cloud, taken, options.reach_m), options.largest_gap_m);
    }
    const double from = run.empty() ? 0.0 : line.along(*run.front());
    const double to = run.empty() ? 0.0 : line.along(*run.back());
    const bool is_dense = static_cast<double>(run.size()) * kVoxelM > 0.5 * (to - from);
    if (to - from < options.least_length_m || !is_dense) {
      votes.give_up_best();
      continue;
    }
    walls.push_back({0, {line.at(from), line.at(to)}, mean_standing(run)});
    for (std::size_t i = 0; i < cloud.size(); ++i) {  // with what lies just beside: the same wall seen worse
      const double t = line.along(cloud[i]);
      if (taken[i] == 0 && t > from - 0.1 && t < to + 0.1 && line.has(cloud[i], 1.5 * options.reach_m)) {
        taken[i] = 1;
        votes.add(cloud[i], -1);
      }
    }
  }
  std::sort(walls.begin(), walls.end(), [](const mapping::Wall& a, const mapping::Wall& b) {
    return a.segment.length_m() > b.segment.length_m();
  });
  for (std::size_t i = 0; i < walls.size(); ++i) walls[i].id = static_cast<int>(i);
  return walls;
}

}  // namespace madori::localization
