#include "localization/landmarks/descriptor_match.hpp"

#include "localization/landmarks/bare_math.hpp"

namespace madori::localization::landmarks {
namespace {

constexpr int kLeastPoints = 3;  // of a cell
/// The smaller eigenvalue of a cell is raised to this share of the larger: flat walls have none.
constexpr double kFlattest = 0.02;
constexpr int kLevels = 3;

double larger(double a, double b) {
  return a > b ? a : b;
}
double size_of(double a) {
  return a < 0.0 ? -a : a;
}

/// Newton's method on one level, downhill by construction: the Hessian is Gauss and Newton's.
Displacement refined(const DescriptorField& field, const DescriptorPoints& scan, Displacement pose,
                     double cell_m) {
  constexpr int kMostSteps = 25;
  for (int step = 0; step < kMostSteps; ++step) {
    const DescriptorField::Terms t = field.terms(scan, pose);
    const double damping = 1e-6 * (t.hessian(0, 0) + t.hessian(1, 1) + t.hessian(2, 2)) + 1e-9;
    const Vector3 by =
        -1.0 * (inverse(t.hessian + Matrix3::diagonal(damping, damping, damping)) * t.gradient);
    const double length =
        larger(larger(size_of(by[0]), size_of(by[1])) / (0.25 * cell_m), size_of(by[2]) / 0.1);
    const double share = length > 1.0 ? 1.0 / length : 1.0;
    pose = {pose.x_m + share * by[0], pose.y_m + share * by[1], wrapped(pose.yaw_rad + share * by[2])};
    if (length < 1e-3) break;
  }
  return pose;
}

/// The best starts of the window, best first.
struct Starts {
  static constexpr int kMost = 6;
  Displacement pose[kMost];
  double score[kMost] = {};
  int size = 0;

  void offer(const Displacement& p, double s) {
    int at = size < kMost ? size++ : kMost;
    for (; at > 0 && score[at - 1] < s; --at)
      if (at < kMost) pose[at] = pose[at - 1], score[at] = score[at - 1];
    if (at < kMost) pose[at] = p, score[at] = s;
  }
};

void sweep(const DescriptorField& field, const DescriptorPoints& scan, const MatchWindow& window,
           double cell_m, Starts& starts) {
  constexpr double kTurnStep_rad = 15.0 / 180.0 * kHalfTurn_rad;
  constexpr int kStride = 4;
  const double reach_rad = window.reach_rad < kHalfTurn_rad ? window.reach_rad : kHalfTurn_rad;
  const int side = whole_below(window.reach_m / (0.5 * cell_m) + 0.5);
  const int turns = whole_below(reach_rad / kTurnStep_rad + 0.5);
  for (int i = -side; i <= side; ++i)
    for (int j = -side; j <= side; ++j)
      for (int k = -turns; k <= turns; ++k) {
        const Displacement start{window.centre.x_m + 0.5 * cell_m * i, window.centre.y_m + 0.5 * cell_m * j,
                                 wrapped(window.centre.yaw_rad + kTurnStep_rad * k)};
        starts.offer(start, field.score(scan, start, kStride));
      }
}

bool same_place(const Displacement& a, const Displacement& b, double cell_m) {
  return size_of(a.x_m - b.x_m) < 0.5 * cell_m && size_of(a.y_m - b.y_m) < 0.5 * cell_m &&
         size_of(wrapped(a.yaw_rad - b.yaw_rad)) < 0.2;
}

}  // namespace

DescriptorPoints::DescriptorPoints(const Descriptor& descriptor) : size(descriptor.size()) {
  for (int i = 0; i < size; ++i) {
    double s = 0.0, c = 1.0;
    sine_cosine(descriptor.angle_rad(i), s, c);
    x_m[i] = static_cast<float>(descriptor.range_m(i) * c);
    y_m[i] = static_cast<float>(descriptor.range_m(i) * s);
  }
}

DescriptorField::DescriptorField(const DescriptorPoints& points, double cell_m) : cell_m_(cell_m) {
  for (int grid = 0; grid < 4; ++grid) fill(grid, points);
}

int32_t DescriptorField::key_of(int grid, double x, double y) const {
  const int column = whole_below(x / cell_m_ + 0.5 * (grid & 1));
  const int row = whole_below(y / cell_m_ + 0.5 * (grid >> 1));
  return (row + 16384) * 32768 + column + 16384;
}

void DescriptorField::fill(int grid, const DescriptorPoints& points) {
  int32_t keys[Descriptor::kMost];
  int16_t order[Descriptor::kMost];
  for (int i = 0; i < points.size; ++i) {  // insertion sort: neighbours of a scan mostly share a cell
    const int32_t key = key_of(grid, points.x_m[i], points.y_m[i]);
    int at = i;
    for (; at > 0 && keys[at - 1] > key; --at) keys[at] = keys[at - 1], order[at] = order[at - 1];
    keys[at] = key;
    order[at] = static_cast<int16_t>(i);
  }
  for (int begin = 0, end = 0; begin < points.size; begin = end) {
    while (end < points.size && keys[end] == keys[begin]) ++end;
    const int n = end - begin;
    if (n < kLeastPoints) continue;
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (int i = begin; i < end; ++i) x += points.x_m[order[i]], y += points.y_m[order[i]];
    x /= n, y /= n;
    for (int i = begin; i < end; ++i) {
      const double dx = points.x_m[order[i]] - x, dy = points.y_m[order[i]] - y;
      xx += dx * dx / n, xy += dx * dy / n, yy += dy * dy / n;
    }
    const double half = 0.5 * (xx - yy);
    const double spread = square_root(half * half + xy * xy);
    const double large = 0.5 * (xx + yy) + spread;
    if (!(large > 0.0)) continue;
    const double small = larger(0.5 * (xx + yy) - spread, kFlattest * large);
    double s = 0.0, c = 1.0;
    sine_cosine(0.5 * arctangent(2.0 * xy, xx - yy), s, c);
    const double p = 1.0 / large, q = 1.0 / small;
    cells_[grid][counts_[grid]++] = {keys[begin],
                                     static_cast<float>(x),
                                     static_cast<float>(y),
                                     static_cast<float>(c * c * p + s * s * q),
                                     static_cast<float>(c * s * (p - q)),
                                     static_cast<float>(s * s * p + c * c * q)};
  }
}

const DescriptorField::Cell* DescriptorField::find(int grid, double x, double y) const {
  const int32_t key = key_of(grid, x, y);
  int low = 0, high = counts_[grid];
  while (low < high) {
    const int middle = (low + high) / 2;
    if (cells_[grid][middle].key < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low < counts_[grid] && cells_[grid][low].key == key ? &cells_[grid][low] : nullptr;
}

DescriptorField::Terms DescriptorField::terms(const DescriptorPoints& points,
                                              const Displacement& pose) const {
  Terms sum;
  double s = 0.0, c = 1.0;
  sine_cosine(pose.yaw_rad, s, c);
  for (int i = 0; i < points.size; ++i) {
    const double rx = c * points.x_m[i] - s * points.y_m[i];
    const double ry = s * points.x_m[i] + c * points.y_m[i];
    for (int grid = 0; grid < 4; ++grid) {
      const Cell* cell = find(grid, rx + pose.x_m, ry + pose.y_m);
      if (cell == nullptr) continue;
      const double a = cell->a, b = cell->b, d = cell->c;
      const double qx = rx + pose.x_m - cell->mean_x, qy = ry + pose.y_m - cell->mean_y;
      const double cx = a * qx + b * qy, cy = b * qx + d * qy;
      const double e = 0.25 * exponential(-0.5 * (qx * cx + qy * cy));
      const double tx = b * rx - a * ry, ty = d * rx - b * ry;
      const double yaw[3] = {tx, ty, rx * ty - ry * tx};
      sum.score += e / points.size;
      sum.gradient = sum.gradient + Vector3{{e * cx, e * cy, e * (rx * cy - ry * cx)}};
      sum.hessian = sum.hessian + Matrix3{{{e * a, e * b, e * yaw[0]},
                                           {e * b, e * d, e * yaw[1]},
                                           {e * yaw[0], e * yaw[1], e * yaw[2]}}};
    }
  }
  return sum;
}

double DescriptorField::score(const DescriptorPoints& points, const Displacement& pose, int stride) const {
  double sum = 0.0, s = 0.0, c = 1.0;
  int count = 0;
  sine_cosine(pose.yaw_rad, s, c);
  for (int i = 0; i < points.size; i += stride, ++count) {
    const double x = c * points.x_m[i] - s * points.y_m[i] + pose.x_m;
    const double y = s * points.x_m[i] + c * points.y_m[i] + pose.y_m;
    for (int grid = 0; grid < 4; ++grid)
      if (const Cell* cell = find(grid, x, y)) {
        const double qx = x - cell->mean_x, qy = y - cell->mean_y;
        sum += 0.25 * exponential(-0.5 * (cell->a * qx * qx + 2.0 * cell->b * qx * qy + cell->c * qy * qy));
      }
  }
  return count > 0 ? sum / count : 0.0;
}

DescriptorMatch match_descriptor(const Descriptor& landmark, const Descriptor& scan,
                                 const MatchWindow& window) {
  DescriptorMatch best;
  best.uncertainty = FullUncertainty::unknown();
  if (landmark.size() < kLeastPoints || scan.size() < kLeastPoints) return best;
  const DescriptorPoints known(landmark), seen(scan);
  double cell_m = landmark.median_range_m();
  Starts starts;
  for (int level = 0; level < kLevels; ++level, cell_m *= 0.5) {
    const DescriptorField field(known, cell_m);
    if (level == 0) sweep(field, seen, window, cell_m, starts);
    for (int i = 0; i < starts.size; ++i) starts.pose[i] = refined(field, seen, starts.pose[i], cell_m);
    if (level + 1 < kLevels) continue;
    const double itself = field.score(known, {});
    int winner = 0;
    for (int i = 0; i < starts.size; ++i) {
      starts.score[i] = field.score(seen, starts.pose[i]) / itself;
      if (starts.score[i] > starts.score[winner]) winner = i;
    }
    best.landmark_from_scan = starts.pose[winner];
    best.quality = starts.score[winner];
    for (int i = 0; i < starts.size; ++i)
      if (!same_place(starts.pose[i], starts.pose[winner], cell_m))
        best.rival_quality = larger(best.rival_quality, starts.score[i]);
    constexpr double kUnseen = 1e-4;  // 1 / (100 m)^2: a direction that the scan does not see
    best.uncertainty.covariance = symmetric(inverse(field.terms(seen, starts.pose[winner]).hessian +
                                                    Matrix3::diagonal(kUnseen, kUnseen, kUnseen)));
  }
  return best;
}

}  // namespace madori::localization::landmarks
