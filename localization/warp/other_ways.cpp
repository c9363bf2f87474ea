#include "localization/warp/other_ways.hpp"

#include <algorithm>
#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <cstddef>
#include <utility>

#include "localization/drawing_fit/alignment.hpp"
#include "localization/drawing_fit/drawing_model.hpp"

namespace madori::localization {
namespace {

constexpr double kAroundM = 8.0;  ///< what is seen from one place, mostly
constexpr double kWindowM = 2.4;  ///< twice as far as a fit reaches by itself (WallSides::kReachM)
constexpr double kStepM = 0.2;
constexpr double kBlurM = 0.15;         ///< no peak lies between two steps
constexpr double kOwnM = 0.5;           ///< nearer, the fit finds it by itself
constexpr std::size_t kTried = 3;       ///< a fit each
constexpr double kAlmostFolded = 0.48;  ///< of a step between control points, by their spacing: nothing folds

/// What is seen around a place, where the warp has it on the drawing.
MemoryCloud surroundings(const MemoryCloud& cloud, const DrawingWarp& warp, const Point2<Building>& at) {
  MemoryCloud around;
  for (const CloudSurface& s : cloud) {
    if (std::hypot(s.x_m - at.x_m, s.y_m - at.y_m) > kAroundM) continue;
    const auto q = warp.map(Transform2<Building, Base>(s.x_m, s.y_m, std::atan2(s.normal_y, s.normal_x)));
    around.push_back(s);
    around.back().x_m = q.x_m(), around.back().y_m = q.y_m();
    around.back().normal_x = q.cos_yaw(), around.back().normal_y = q.sin_yaw();
  }
  return around;
}

struct Shift {
  double x_m, y_m, nats;
};

/// The peaks of the likelihood over shifts, highest first.
std::vector<Shift> peaks(const WallIndex& drawn, const MemoryCloud& around) {
  constexpr int kSteps = static_cast<int>(kWindowM / kStepM);
  constexpr int kWide = 2 * kSteps + 1;
  const WallMixture mixture(DrawingModel{}, kBlurM);
  std::vector<double> nats(kWide * kWide);
  const auto at = [&](int x, int y) -> double& {
    return nats[static_cast<std::size_t>((y + kSteps) * kWide + x + kSteps)];
  };
  for (int y = -kSteps; y <= kSteps; ++y)
    for (int x = -kSteps; x <= kSteps; ++x)
      at(x, y) = log_likelihood(drawn, around, {x * kStepM, y * kStepM, 0.0}, mixture);
  std::vector<Shift> found;
  for (int y = -kSteps + 1; y < kSteps; ++y)
    for (int x = -kSteps + 1; x < kSteps; ++x) {
      bool highest = std::hypot(x, y) * kStepM > kOwnM;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) highest = highest && at(x, y) >= at(x + i, y + j);
      if (highest) found.push_back({x * kStepM, y * kStepM, at(x, y)});
    }
  std::stable_sort(found.begin(), found.end(),
                   [](const Shift& a, const Shift& b) { return a.nats > b.nats; });
  return found;
}

/// Matern's correlation (nu = 1) of the field between places so far apart.
double correlation(double distance_m, double range_m) {
  const double z = std::sqrt(8.0) * distance_m / range_m;
  return z < 1e-6 ? 1.0 : z * boost::math::cyl_bessel_k(1, z);
}

bool folds(const WarpField& field) {
  const auto step = [&](int a, int b) {
    const auto i = static_cast<std::size_t>(2 * a), k = static_cast<std::size_t>(2 * b);
    return std::hypot(field.control_m[i] - field.control_m[k],
                      field.control_m[i + 1] - field.control_m[k + 1]);
  };
  for (int p = 0; p < field.width * field.height; ++p) {
    if (p % field.width > 0 && step(p, p - 1) > kAlmostFolded * field.spacing_m) return true;
    if (p >= field.width && step(p, p - field.width) > kAlmostFolded * field.spacing_m) return true;
  }
  return false;
}

/// What is expected of the field where its value at `here` is another by `shift` (on the drawing, so that the
/// displacement changes by the opposite).
WarpField expected(WarpField field, double range_m, const Point2<Map>& here, const Shift& shift) {
  for (int v = 0; v < field.height; ++v)
    for (int u = 0; u < field.width; ++u) {
      const double share = correlation(std::hypot(field.origin.x_m + u * field.spacing_m - here.x_m,
                                                  field.origin.y_m + v * field.spacing_m - here.y_m),
                                       range_m);
      const auto k = 2 * static_cast<std::size_t>(v * field.width + u);
      field.control_m[k] -= share * shift.x_m;
      field.control_m[k + 1] -= share * shift.y_m;
    }
  return field;
}

}  // namespace

std::vector<DrawingWarp> other_ways(const WallIndex& drawn, const MemoryCloud& cloud, const DrawingWarp& warp,
                                    const Point2<Building>& at) {
  std::vector<DrawingWarp> ways;
  if (warp.field().control_m.empty()) return ways;
  const Point2<Map> here = warp.map(at);
  for (const Shift& shift : peaks(drawn, surroundings(cloud, warp, at))) {
    WarpField field = expected(warp.field(), warp.statistics().range_m, here, shift);
    if (folds(field)) continue;
    ways.emplace_back(warp.similarity(), std::move(field), warp.statistics());
    if (ways.size() == kTried) break;
  }
  return ways;
}

}  // namespace madori::localization
