#include "mapping/drawing/labelling/edge_rays.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "core/median.hpp"

namespace madori::mapping {
namespace {

constexpr double kParallelSine = 0.15;  // two edges within 9 degrees are parallel
constexpr double kReach = 0.05;         // of the sheet: further apart are no two faces of a wall
constexpr double kFar = 0.3;            // of the sheet: free beyond is free
constexpr double kStep = 0.7;           // pixels: no 8-connected line is stepped over
constexpr int kEvents = 5;
constexpr double kNeutral = 128;
constexpr double kBeside = 1, kBesideEnds = 3.2;  // pixels: the edge's own blur, and what is beside it
constexpr double kPastEnd = 6;                    // pixels: what abuts at an end is over
constexpr double kThickest = 0.025;               // of the sheet: thicker is no wall

bool are_parallel(const Edge& a, const Edge& b) {
  return std::abs(a.normal.cross(b.normal)) < kParallelSine;
}

/// From a place across an edge, as far as the sheet goes: in small steps, and in large ones where all edges
/// are far. Distances in pixels.
class Walk {
 public:
  Walk(const EdgeSheet& sheet, const Edge& across, double side, const cv::Point2d& from)
      : sheet_(&sheet), from_(from), ahead_(side * across.normal) {}

  [[nodiscard]] double distance() const { return distance_; }
  /// The pixel here; nothing beyond the sheet.
  [[nodiscard]] std::optional<std::size_t> pixel() const {
    const cv::Point2d place = from_ + distance_ * ahead_;
    if (!sheet_->inside(place.x, place.y)) return std::nullopt;
    return sheet_->pixel(place.x, place.y);
  }
  void step_from(std::size_t pixel) { distance_ += std::max(kStep, sheet_->clear_px[pixel] - 1.5); }

 private:
  const EdgeSheet* sheet_;
  cv::Point2d from_, ahead_;
  double distance_ = kStep;
};

struct Tone {
  double sum = 0, square = 0;
  int count = 0;
  void add(double value) { sum += value, square += value * value, ++count; }
  [[nodiscard]] double mean(double otherwise) const { return count > 0 ? sum / count : otherwise; }
  [[nodiscard]] double spread() const {
    const double m = mean(0);
    return count > 0 ? std::sqrt(std::max(0.0, square / count - m * m)) : 0;
  }
};

struct Event {
  double distance = 0;
  int edge = -1;
  bool parallel = false, opposite = false;
};

/// A look across an edge from a place on it.
struct Ray {
  Ray(const EdgeSheet& of, std::size_t across, double side, const cv::Point2d& place)
      : sheet(&of), from(static_cast<int>(across)), walk(of, of.edges[across], side, place) {}

  void look() {
    const double reach = kReach * sheet->size_px(), far = kFar * sheet->size_px();
    while (walk.distance() < far && asks_on(reach)) {
      const auto pixel = walk.pixel();
      border = !pixel;
      if (border) return;
      see(*pixel, reach);
      if (sheet->clear_px[*pixel] <= 0) meet(sheet->edge_at[*pixel]);
      walk.step_from(*pixel);
    }
  }

  const EdgeSheet* sheet;
  int from, last = from;
  Walk walk;
  std::array<Event, kEvents> events;
  int count = 0;
  bool border = false;
  Tone near, fill, red_green, yellow_blue;

 private:
  /// Beyond the reach of faces only the first edge counts, and what follows the last parallel one within it.
  [[nodiscard]] bool asks_on(double reach) const {
    if (count == 0 || walk.distance() <= reach) return count < kEvents;
    const Event& before = events[static_cast<std::size_t>(count - 1)];
    return count < kEvents && before.parallel && before.distance <= reach;
  }

  void see(std::size_t pixel, double reach) {
    const double d = walk.distance();
    if (d > kBeside && d < kBesideEnds) {
      near.add(sheet->grey.pixels[pixel]);
      if (!sheet->grey.red_green.empty()) red_green.add(sheet->grey.red_green[pixel]);
      if (!sheet->grey.yellow_blue.empty()) yellow_blue.add(sheet->grey.yellow_blue[pixel]);
    }
    if (count == 0 && d > kBeside && d < reach) fill.add(sheet->grey.pixels[pixel]);
  }

  void meet(int edge) {
    if (edge == last || edge == from) return;
    last = edge;
    const Edge &own = sheet->edges[static_cast<std::size_t>(from)],
               &other = sheet->edges[static_cast<std::size_t>(edge)];
    const bool parallel = are_parallel(own, other);
    const bool opposite = own.normal.dot(other.normal) < 0;
    const double d = walk.distance();
    if (count > 0) {  // the next piece of the edge that was just met
      const Event& before = events[static_cast<std::size_t>(count - 1)];
      if (parallel && before.parallel && before.opposite == opposite && d - before.distance < 1.5) return;
    }
    events[static_cast<std::size_t>(count++)] = {d, edge, parallel, opposite};
  }
};

class Looker {
 public:
  explicit Looker(const EdgeSheet& sheet) : sheet_(sheet) {}

  [[nodiscard]] SideView look(std::size_t edge, double side) {
    const Edge& e = sheet_.edges[edge];
    const PixelSegment& s = e.segment;
    const int places = std::clamp(static_cast<int>(e.length_px / 4), 3, 15);
    rays_.clear();
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      rays_.emplace_back(sheet_, edge, side, cv::Point2d(std::lerp(s.u1, s.u2, t), std::lerp(s.v1, s.v2, t)));
    }
    for (Ray& ray : rays_) ray.look();
    return summary(rays_);
  }

  [[nodiscard]] Between past_end(std::size_t edge, bool last) const {
    const Edge& e = sheet_.edges[edge];
    const PixelSegment& s = e.segment;
    const double sign = last ? kPastEnd / e.length_px : -kPastEnd / e.length_px;
    const cv::Point2d place((last ? s.u2 : s.u1) + sign * (s.u2 - s.u1),
                            (last ? s.v2 : s.v1) + sign * (s.v2 - s.v1));
    return {first_parallel(e, place, 1), first_parallel(e, place, -1)};
  }

 private:
  /// Pixels from a place beside the edge `from` to the next parallel one; 0 where none is near.
  [[nodiscard]] double first_parallel(const Edge& from, const cv::Point2d& place, double side) const {
    Walk walk(sheet_, from, side, place);
    while (walk.distance() < kThickest * sheet_.size_px()) {
      const auto pixel = walk.pixel();
      if (!pixel) return 0;
      if (sheet_.clear_px[*pixel] <= 0 &&
          are_parallel(from, sheet_.edges[static_cast<std::size_t>(sheet_.edge_at[*pixel])]))
        return walk.distance();
      walk.step_from(*pixel);
    }
    return 0;
  }

  [[nodiscard]] SideView summary(const std::vector<Ray>& rays) const {
    SideView view;
    const double far = kFar * sheet_.size_px();
    std::vector<double> free, near, fill, spread, red_green, yellow_blue;
    for (const Ray& ray : rays) {
      free.push_back(ray.count > 0 ? ray.events[0].distance : far);
      near.push_back(ray.near.mean(0));
      red_green.push_back(ray.red_green.mean(kNeutral));
      yellow_blue.push_back(ray.yellow_blue.mean(kNeutral));
      fill.push_back(ray.fill.mean(near.back()));
      spread.push_back(ray.fill.spread());
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
    const double far = kFar * sheet_.size_px(), reach = kReach * sheet_.size_px();
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
  std::vector<Ray> rays_;
};

}  // namespace

std::vector<EdgeViews> look_across(const EdgeSheet& sheet) {
  std::vector<EdgeViews> views(sheet.edges.size());
  const auto look = [&](const cv::Range& edges) {
    Looker looker(sheet);
    for (auto i = static_cast<std::size_t>(edges.start); i < static_cast<std::size_t>(edges.end); ++i)
      views[i] = {
          looker.look(i, 1), looker.look(i, -1), {looker.past_end(i, false), looker.past_end(i, true)}};
  };
  cv::parallel_for_({0, static_cast<int>(views.size())}, look);
  return views;
}

}  // namespace madori::mapping
