#include "localization/warp/other_ways.hpp"

#include <algorithm>
#include <boost/math/special_functions/bessel.hpp>
#include <cmath>
#include <cstddef>
#include <span>
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

/// `at` and its surroundings, and by how much these fit better somewhere beside where they are.
struct Shift {
  Point2<Map> at;
  double x_m, y_m;
  double nats;  ///< more than where they are
};

constexpr int kSteps = static_cast<int>(kWindowM / kStepM);
constexpr int kWide = 2 * kSteps + 1;

/// What lies around a place, and how well the drawing explains it after each shift.
struct Room {
  Room(const Point2<Map>& place, double reach_m) : middle(place), radius_m(reach_m), nats(kWide * kWide) {}
  [[nodiscard]] bool holds(const CloudSurface& s) const {
    const double x = s.x_m - middle.x_m, y = s.y_m - middle.y_m;
    return x * x + y * y <= radius_m * radius_m;
  }
  [[nodiscard]] double at(int x, int y) const {
    return nats[static_cast<std::size_t>((y + kSteps) * kWide + x + kSteps)];
  }

  Point2<Map> middle;
  double radius_m;
  std::vector<double> nats;  ///< over clutter, row by row of shifts
  std::size_t surfaces = 0;
};

/// Each surface is asked once at each shift, for all rooms that hold it.
void weigh(const WallIndex& drawn, const MemoryCloud& cloud, std::vector<Room>& rooms) {
  const WallMixture mixture(DrawingModel{}, kBlurM);
  std::vector<Transform2<Map, Map>> shifts;
  for (int y = -kSteps; y <= kSteps; ++y)
    for (int x = -kSteps; x <= kSteps; ++x) shifts.emplace_back(x * kStepM, y * kStepM, 0.0);
  std::vector<Room*> holders;
  for (const CloudSurface& surface : cloud) {
    holders.clear();
    for (Room& room : rooms) {
      if (!room.holds(surface)) continue;
      holders.push_back(&room);
      ++room.surfaces;
    }
    if (holders.empty()) continue;
    const MemoryCloud alone{surface};
    for (std::size_t k = 0; k < shifts.size(); ++k) {
      const double nats = log_likelihood(drawn, alone, shifts[k], mixture);
      for (Room* room : holders) room->nats[k] += nats;
    }
  }
}

/// The peaks of the likelihood over shifts, highest first.
std::vector<Shift> peaks(const Room& room) {
  std::vector<Shift> found;
  for (int y = -kSteps + 1; y < kSteps; ++y)
    for (int x = -kSteps + 1; x < kSteps; ++x) {
      bool highest = std::hypot(x, y) * kStepM > kOwnM;
      for (int j = -1; j <= 1; ++j)
        for (int i = -1; i <= 1; ++i) highest = highest && room.at(x, y) >= room.at(x + i, y + j);
      if (highest) found.push_back({room.middle, x * kStepM, y * kStepM, room.at(x, y) - room.at(0, 0)});
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

/// All rooms of the memory: discs that cover it.
void add_rooms(const MemoryCloud& cloud, std::vector<Room>& rooms) {
  Point2<Map> low{cloud.front().x_m, cloud.front().y_m}, high = low;
  for (const CloudSurface& s : cloud) {
    low = {std::min(low.x_m, s.x_m), std::min(low.y_m, s.y_m)};
    high = {std::max(high.x_m, s.x_m), std::max(high.y_m, s.y_m)};
  }
  for (double y = low.y_m; y < high.y_m; y += kRoomM)
    for (double x = low.x_m; x < high.x_m; x += kRoomM)
      rooms.emplace_back(Point2<Map>{x + 0.5 * kRoomM, y + 0.5 * kRoomM}, kRoomM);
}

/// The best shift of every room that fits better beside where it is, best first, none that overlaps a better
/// one.
std::vector<Shift> better_rooms(std::span<const Room> rooms) {
  std::vector<Shift> found;
  for (const Room& room : rooms) {
    if (room.surfaces < kFewest) continue;
    const auto shifts = peaks(room);
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
    if (steepest_step_m(field) > kAlmostFolded * field.spacing_m) continue;
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
  std::vector<Room> rooms{{here, kAroundM}};
  add_rooms(carried, rooms);
  weigh(drawn, carried, rooms);
  add_starts(warp, peaks(rooms.front()), kTriedNear, ways);
  add_starts(warp, better_rooms(std::span(rooms).subspan(1)), kTriedRooms, ways);
  return ways;
}

}  // namespace madori::localization
