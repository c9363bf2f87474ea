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

constexpr double kAroundM = 8.0;     ///< what is seen from one place, mostly
constexpr double kRoomM = 4.0;       ///< what may have been taken for its neighbour elsewhere: about a room
constexpr std::size_t kFewest = 20;  ///< surfaces: 4 m of wall
constexpr double kWindowM = 2.4;     ///< twice as far as a fit reaches by itself (WallSides::kReachM)
constexpr double kStepM = 0.2;
constexpr double kBlurM = 0.15;          ///< no peak lies between two steps
constexpr double kOwnM = 0.5;            ///< nearer, the fit finds it by itself
constexpr std::size_t kTriedNear = 3;    ///< a fit each
constexpr std::size_t kTriedRooms = 2;   ///< ... more often than not the first is the one
constexpr double kHopelessNats = -20.0;  ///< of 29 such fits in Intel's building two were likelier in the end
constexpr double kAlmostFolded = 0.48;  ///< of a step between control points, by their spacing: nothing folds

/// The surfaces, where the warp has them on the drawing.
MemoryCloud on_drawing(const MemoryCloud& cloud, const DrawingWarp& warp) {
  MemoryCloud carried = cloud;
  for (CloudSurface& s : carried) {
    const auto q = warp.map(Transform2<Building, Base>(s.x_m, s.y_m, std::atan2(s.normal_y, s.normal_x)));
    s.x_m = q.x_m(), s.y_m = q.y_m();
    s.normal_x = q.cos_yaw(), s.normal_y = q.sin_yaw();
  }
  return carried;
}

MemoryCloud around(const MemoryCloud& cloud, const Point2<Map>& at, double radius_m) {
  MemoryCloud near;
  for (const CloudSurface& s : cloud)
    if (std::hypot(s.x_m - at.x_m, s.y_m - at.y_m) <= radius_m) near.push_back(s);
  return near;
}

/// `at` and its surroundings, and by how much these fit better somewhere beside where they are.
struct Shift {
  Point2<Map> at;
  double x_m, y_m;
  double nats;  ///< more than where they are
};

/// The peaks of the likelihood over shifts, highest first.
std::vector<Shift> peaks(const WallIndex& drawn, const MemoryCloud& around, const Point2<Map>& place) {
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
      if (highest) found.push_back({place, x * kStepM, y * kStepM, at(x, y) - at(0, 0)});
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

/// What is expected of the field where its value at a place is another by `shift` (on the drawing, so that
/// the displacement changes by the opposite).
WarpField expected(WarpField field, double range_m, const Shift& shift) {
  for (int v = 0; v < field.height; ++v)
    for (int u = 0; u < field.width; ++u) {
      const double share = correlation(std::hypot(field.origin.x_m + u * field.spacing_m - shift.at.x_m,
                                                  field.origin.y_m + v * field.spacing_m - shift.at.y_m),
                                       range_m);
      const auto k = 2 * static_cast<std::size_t>(v * field.width + u);
      field.control_m[k] -= share * shift.x_m;
      field.control_m[k + 1] -= share * shift.y_m;
    }
  return field;
}

/// The best shift of every room of the memory that fits better beside where it is, best first, none that
/// overlaps a better one.
std::vector<Shift> better_rooms(const WallIndex& drawn, const MemoryCloud& cloud) {
  Point2<Map> low{cloud.front().x_m, cloud.front().y_m}, high = low;
  for (const CloudSurface& s : cloud) {
    low = {std::min(low.x_m, s.x_m), std::min(low.y_m, s.y_m)};
    high = {std::max(high.x_m, s.x_m), std::max(high.y_m, s.y_m)};
  }
  std::vector<Shift> found;
  for (double y = low.y_m; y < high.y_m; y += kRoomM)
    for (double x = low.x_m; x < high.x_m; x += kRoomM) {
      const Point2<Map> middle{x + 0.5 * kRoomM, y + 0.5 * kRoomM};
      const MemoryCloud room = around(cloud, middle, kRoomM);
      if (room.size() < kFewest) continue;
      const auto shifts = peaks(drawn, room, middle);
      if (!shifts.empty() && shifts.front().nats > 0.0) found.push_back(shifts.front());
    }
  std::stable_sort(found.begin(), found.end(),
                   [](const Shift& a, const Shift& b) { return a.nats > b.nats; });
  std::vector<Shift> apart;
  for (const Shift& shift : found)
    if (std::none_of(apart.begin(), apart.end(),
                     [&](const Shift& s) { return distance_m(s.at, shift.at) < 2.0 * kRoomM; }))
      apart.push_back(shift);
  return apart;
}

/// The first few of shifts, best first, that do not fold the drawing.
void add_starts(const DrawingWarp& warp, const std::vector<Shift>& shifts, std::size_t most,
                std::vector<DrawingWarp>& starts) {
  std::size_t added = 0;
  for (const Shift& shift : shifts) {
    if (added == most || shift.nats < kHopelessNats) return;
    WarpField field = expected(warp.field(), warp.statistics().range_m, shift);
    if (folds(field)) continue;
    starts.emplace_back(warp.similarity(), std::move(field), warp.statistics());
    ++added;
  }
}

}  // namespace

std::vector<DrawingWarp> other_ways(const WallIndex& drawn, const MemoryCloud& cloud, const DrawingWarp& warp,
                                    const Point2<Building>& at) {
  std::vector<DrawingWarp> ways;
  if (warp.field().control_m.empty() || cloud.empty()) return ways;
  const MemoryCloud carried = on_drawing(cloud, warp);
  const Point2<Map> here = warp.map(at);
  add_starts(warp, peaks(drawn, around(carried, here, kAroundM), here), kTriedNear, ways);
  add_starts(warp, better_rooms(drawn, carried), kTriedRooms, ways);
  return ways;
}

}  // namespace madori::localization
