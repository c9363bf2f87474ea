#include "mapping/drawing/labelling/edge_rays.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/median.hpp"

namespace madori::mapping {
namespace {

constexpr double kParallelSine = 0.15;  // two edges within 9 degrees are parallel
constexpr double kReach = 0.05;         // of the sheet: further apart are no two faces of a wall
constexpr double kFar = 0.3;            // of the sheet: free beyond is free
constexpr double kStep = 0.7;           // pixels: no 8-connected line is stepped over
constexpr int kEvents = 5;
constexpr double kNeutral = 128;
constexpr double kNearEnds = 3.2;    // pixels: what is beside an edge
constexpr double kPastEnd = 6;       // pixels: what abuts at an end is over
constexpr double kThickest = 0.025;  // of the sheet: thicker is no wall

struct Event {
  double distance = 0;
  int edge = -1;
  bool parallel = false, opposite = false;
};

struct Ray {
  std::array<Event, kEvents> events;
  int count = 0;
  bool border = false;
  double near_grey = 0, red_green = 0, yellow_blue = 0, fill_grey = 0, fill_square = 0;

  /// Beyond the reach of faces only the first edge counts, and what follows the last parallel one within it.
  [[nodiscard]] bool asks_on(double distance, double reach) const {
    if (count == 0 || distance <= reach) return count < kEvents;
    const Event& last = events[static_cast<std::size_t>(count - 1)];
    return count < kEvents && last.parallel && last.distance <= reach;
  }
};

struct Tone {
  double sum = 0, square = 0;
  int count = 0;
  void add(double grey) { sum += grey, square += grey * grey, ++count; }
};

class Looker {
 public:
  explicit Looker(const EdgeSheet& sheet) : sheet_(sheet), coloured_(!sheet.grey.red_green.empty()) {}

  [[nodiscard]] SideView look(std::size_t edge, double side) const {
    const Edge& e = sheet_.edges[edge];
    const int places = std::clamp(static_cast<int>(e.length_px / 4), 3, 15);
    std::vector<Ray> rays;
    for (int k = 0; k < places; ++k) rays.push_back(cast(edge, side, (k + 0.5) / places));
    return summary(rays);
  }

  [[nodiscard]] Between past_end(std::size_t edge, bool last) const {
    const Edge& e = sheet_.edges[edge];
    const PixelSegment& s = e.segment;
    const double sign = last ? kPastEnd / e.length_px : -kPastEnd / e.length_px;
    const double u = (last ? s.u2 : s.u1) + sign * (s.u2 - s.u1);
    const double v = (last ? s.v2 : s.v1) + sign * (s.v2 - s.v1);
    return {first_parallel(e, u, v, 1), first_parallel(e, u, v, -1)};
  }

 private:
  /// Pixels from a place beside the edge `from` to the next parallel one; 0 where none is near.
  [[nodiscard]] double first_parallel(const Edge& from, double u0, double v0, double side) const {
    for (double d = kStep; d < kThickest * sheet_.size_px;) {
      const double u = u0 + side * d * from.normal_u, v = v0 + side * d * from.normal_v;
      if (!sheet_.inside(u, v)) return 0;
      const std::size_t pixel = sheet_.pixel(u, v);
      if (const int met = sheet_.edge_at[pixel]; met >= 0) {
        const Edge& other = sheet_.edges[static_cast<std::size_t>(met)];
        const double sine = from.normal_u * other.normal_v - from.normal_v * other.normal_u;
        if (std::abs(sine) < kParallelSine) return d;
      }
      d += std::max(kStep, sheet_.clear_px[pixel] - 1.5);
    }
    return 0;
  }

  [[nodiscard]] Ray cast(std::size_t from, double side, double t) const {
    const Edge& e = sheet_.edges[from];
    const double u0 = std::lerp(e.segment.u1, e.segment.u2, t), v0 = std::lerp(e.segment.v1, e.segment.v2, t);
    const double nu = side * e.normal_u, nv = side * e.normal_v;
    const double far = kFar * sheet_.size_px, reach = kReach * sheet_.size_px;
    Ray ray;
    Tone near, fill;
    int last = static_cast<int>(from);
    for (double d = kStep; d < far && ray.asks_on(d, reach);) {
      const double u = u0 + d * nu, v = v0 + d * nv;
      if (!sheet_.inside(u, v)) {
        ray.border = true;
        break;
      }
      const std::size_t pixel = sheet_.pixel(u, v);
      if (d > 1 && d < kNearEnds) {
        near.add(sheet_.grey.pixels[pixel]);
        if (coloured_) {
          ray.red_green += sheet_.grey.red_green[pixel];
          ray.yellow_blue += sheet_.grey.yellow_blue[pixel];
        }
      }
      if (ray.count == 0 && d < reach && d > 1) fill.add(sheet_.grey.pixels[pixel]);
      const double clear = sheet_.clear_px[pixel];
      if (clear <= 0) {
        const int met = sheet_.edge_at[pixel];
        if (met != last && met != static_cast<int>(from)) {
          add(ray, e, met, d);
          last = met;
        }
      }
      d += std::max(kStep, clear - 1.5);
    }
    if (near.count > 0) {
      ray.near_grey = near.sum / near.count;
      ray.red_green = coloured_ ? ray.red_green / near.count : kNeutral;
      ray.yellow_blue = coloured_ ? ray.yellow_blue / near.count : kNeutral;
    }
    ray.fill_grey = fill.count > 0 ? fill.sum / fill.count : ray.near_grey;
    ray.fill_square = fill.count > 0 ? fill.square / fill.count : ray.near_grey * ray.near_grey;
    return ray;
  }

  void add(Ray& ray, const Edge& from, int met, double distance) const {
    const Edge& other = sheet_.edges[static_cast<std::size_t>(met)];
    const double sine = from.normal_u * other.normal_v - from.normal_v * other.normal_u;
    const bool parallel = std::abs(sine) < kParallelSine;
    const bool opposite = from.normal_u * other.normal_u + from.normal_v * other.normal_v < 0;
    if (ray.count > 0) {  // the next piece of the edge that was just met
      const Event& before = ray.events[static_cast<std::size_t>(ray.count - 1)];
      if (parallel && before.parallel && before.opposite == opposite && distance - before.distance < 1.5)
        return;
    }
    ray.events[static_cast<std::size_t>(ray.count++)] = {distance, met, parallel, opposite};
  }

  [[nodiscard]] SideView summary(const std::vector<Ray>& rays) const {
    SideView view;
    const double far = kFar * sheet_.size_px;
    std::vector<double> free, near, fill, spread, red_green, yellow_blue;
    for (const Ray& ray : rays) {
      free.push_back(ray.count > 0 ? ray.events[0].distance : far);
      near.push_back(ray.near_grey);
      red_green.push_back(ray.red_green);
      yellow_blue.push_back(ray.yellow_blue);
      fill.push_back(ray.fill_grey);
      spread.push_back(std::sqrt(std::max(0.0, ray.fill_square - ray.fill_grey * ray.fill_grey)));
      view.open += ray.count == 0 && ray.border ? 1.0 / static_cast<double>(rays.size()) : 0.0;
    }
    view.free_most_px = *std::max_element(free.begin(), free.end());
    view.free_px = median_of(free);
    view.near_grey = median_of(near);
    view.red_green = median_of(red_green);
    view.yellow_blue = median_of(yellow_blue);
    view.fill_grey = median_of(fill);
    view.fill_spread = median_of(spread);
    for (int h = 0; h < SideView::kHits; ++h) view.hits[static_cast<std::size_t>(h)] = parallel_hit(rays, h);
    return view;
  }

  [[nodiscard]] SideView::ParallelHit parallel_hit(const std::vector<Ray>& rays, int wanted) const {
    const double far = kFar * sheet_.size_px, reach = kReach * sheet_.size_px;
    std::vector<double> distances, after;
    std::map<int, int> votes;
    int opposite = 0;
    for (const Ray& ray : rays) {
      int parallel = 0;
      for (int k = 0; k < ray.count; ++k) {
        const Event& event = ray.events[static_cast<std::size_t>(k)];
        if (!event.parallel || event.distance > reach || parallel++ != wanted) continue;
        distances.push_back(event.distance);
        after.push_back(
            k + 1 < ray.count ? ray.events[static_cast<std::size_t>(k + 1)].distance - event.distance : far);
        opposite += event.opposite ? 1 : 0;
        ++votes[event.edge];
      }
    }
    SideView::ParallelHit hit;
    if (3 * distances.size() < rays.size() || distances.empty()) return hit;
    const auto count = static_cast<double>(distances.size());
    hit.share = count / static_cast<double>(rays.size());
    hit.opposite = opposite / count;
    hit.distance_px = median_of(distances);
    hit.free_after_px = median_of(after);
    hit.edge = std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) {
                 return a.second < b.second;
               })->first;
    return hit;
  }

  const EdgeSheet& sheet_;
  bool coloured_;
};

}  // namespace

std::vector<EdgeViews> look_across(const EdgeSheet& sheet) {
  const Looker looker(sheet);
  std::vector<EdgeViews> views(sheet.edges.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i] = {looker.look(i, 1), looker.look(i, -1), {looker.past_end(i, false), looker.past_end(i, true)}};
  return views;
}

}  // namespace madori::mapping
