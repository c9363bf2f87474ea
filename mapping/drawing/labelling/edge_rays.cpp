#include "mapping/drawing/labelling/edge_rays.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <span>

#include "core/median.hpp"

namespace madori::mapping {
namespace {

constexpr double kParallelSine = 0.15;  // two edges within 9 degrees are parallel
constexpr double kReach = 0.05;         // of the sheet: further apart are no two faces of a wall
constexpr double kFar = 0.3;            // of the sheet: free beyond is free
constexpr double kStep = 0.7;           // pixels: no 8-connected line is stepped over
constexpr int kEvents = 5;
constexpr double kNeutral = 128;
constexpr double kBesideBegins = 1, kBesideEnds = 3.2;  // pixels: the edge's own blur, and what is beside it
constexpr double kPastEnd = 6;                          // pixels: what abuts at an end is over
constexpr double kThickest = 0.025;                     // of the sheet: thicker is no wall
constexpr std::size_t kEdgesAtOnce = 8;                 // their rays stay in the processor's first cache

bool are_parallel(const Edge& a, const Edge& b) {
  return std::abs(a.normal.cross(b.normal)) < kParallelSine;
}

/// From a place across an edge, as far as the sheet goes: in small steps, and in large ones where all edges
/// are far. Distances in pixels.
class Walk {
 public:
  Walk(const EdgeSheet& sheet, const Edge& across, double side, const cv::Point2d& from)
      : sheet_(&sheet), from_(from), ahead_(side * across.normal) {
    look_ahead();
  }

  [[nodiscard]] double distance() const { return distance_; }
  /// The pixel here; nothing beyond the sheet.
  [[nodiscard]] std::optional<std::size_t> pixel() const {
    if (beyond_) return std::nullopt;
    return pixel_;
  }
  void step() {
    distance_ += std::max(kStep, sheet_->map.clear_px(pixel_) - 1.5);
    look_ahead();
  }

 private:
  /// What is asked of the next pixel is fetched while others are asked: most of a walk is waiting for memory.
  void look_ahead() {
    const cv::Point2d place = from_ + distance_ * ahead_;
    beyond_ = !sheet_->inside(place.x, place.y);
    if (beyond_) return;
    pixel_ = sheet_->pixel(place.x, place.y);
    sheet_->map.fetch(pixel_);
  }

  const EdgeSheet* sheet_;
  cv::Point2d from_, ahead_;
  double distance_ = kStep;
  std::size_t pixel_ = 0;
  bool beyond_ = false;
};

/// How far looks reach on a sheet, pixels.
struct Reach {
  explicit Reach(const EdgeSheet& sheet)
      : faces(kReach * sheet.size_px()), far(kFar * sheet.size_px()), thickest(kThickest * sheet.size_px()) {}
  double faces, far, thickest;
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

  /// Looks at the next pixel; false where nothing more is asked.
  bool step(const Reach& reach) {
    if (walk.distance() >= reach.far || !asks_on(reach.faces)) return false;
    const auto pixel = walk.pixel();
    border = !pixel;
    if (border) return false;
    see(*pixel, reach.faces);
    if (const int edge = sheet->map.edge_at(*pixel); edge >= 0) meet(edge);
    walk.step();
    if (const auto next = walk.pixel(); next && count == 0) __builtin_prefetch(&sheet->grey.pixels[*next]);
    return true;
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
    if (d > kBesideBegins && d < kBesideEnds) {
      near.add(sheet->grey.pixels[pixel]);
      if (!sheet->grey.red_green.empty()) red_green.add(sheet->grey.red_green[pixel]);
      if (!sheet->grey.yellow_blue.empty()) yellow_blue.add(sheet->grey.yellow_blue[pixel]);
    }
    if (count == 0 && d > kBesideBegins && d < reach) fill.add(sheet->grey.pixels[pixel]);
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

/// A look from a place beside an edge's line to the next parallel edge.
struct Gap {
  Gap(const EdgeSheet& of, const Edge& along, const cv::Point2d& place, double side)
      : sheet(&of), from(&along), walk(of, along, side, place) {}

  /// Looks at the next pixel; false where the edge is found or is too far.
  bool step(const Reach& reach) {
    const auto pixel = walk.pixel();
    if (!pixel || walk.distance() >= reach.thickest) return false;
    const int edge = sheet->map.edge_at(*pixel);
    if (edge >= 0 && are_parallel(*from, sheet->edges[static_cast<std::size_t>(edge)])) {
      width = walk.distance();
      return false;
    }
    walk.step();
    return true;
  }

  const EdgeSheet* sheet;
  const Edge* from;
  Walk walk;
  double width = 0;  // pixels; 0 where none is near
};

/// All looks go in step: each waits for its own pixels to come from memory, and together they wait once.
template <class Look>
void look_together(std::vector<Look>& looks, const Reach& reach) {
  std::vector<Look*> going;
  for (Look& look : looks) going.push_back(&look);
  while (!going.empty()) std::erase_if(going, [&](Look* look) { return !look->step(reach); });
}

class Looker {
 public:
  explicit Looker(const EdgeSheet& sheet) : sheet_(sheet) {}

  /// What is seen from some edges.
  void look(std::size_t from, std::size_t to, std::vector<EdgeViews>& views) {
    rays_.clear();
    gaps_.clear();
    for (std::size_t edge = from; edge < to; ++edge) {
      add_rays(edge, 1);
      add_rays(edge, -1);
      add_gaps(sheet_.edges[edge]);
    }
    look_together(rays_, reach_);
    look_together(gaps_, reach_);
    std::span<const Ray> rays(rays_);
    auto gap = gaps_.cbegin();
    for (std::size_t edge = from; edge < to; ++edge) {
      const std::size_t places = places_on(sheet_.edges[edge]);
      views[edge].dark = summary(rays.first(places));
      views[edge].bright = summary(rays.subspan(places, places));
      rays = rays.subspan(2 * places);
      for (Between& past : views[edge].past_ends) {
        past.left_px = (gap++)->width;
        past.right_px = (gap++)->width;
      }
    }
  }

 private:
  static std::size_t places_on(const Edge& edge) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(edge.length_px / 4), 3, 15));
  }

  void add_rays(std::size_t edge, double side) {
    const PixelSegment& s = sheet_.edges[edge].segment;
    const auto places = static_cast<int>(places_on(sheet_.edges[edge]));
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      rays_.emplace_back(sheet_, edge, side, cv::Point2d(std::lerp(s.u1, s.u2, t), std::lerp(s.v1, s.v2, t)));
    }
  }

  /// Past its first end and past its last one, to both sides.
  void add_gaps(const Edge& e) {
    const PixelSegment& s = e.segment;
    const double beyond = kPastEnd / e.length_px;
    const cv::Point2d first(s.u1 - beyond * (s.u2 - s.u1), s.v1 - beyond * (s.v2 - s.v1));
    const cv::Point2d last(s.u2 + beyond * (s.u2 - s.u1), s.v2 + beyond * (s.v2 - s.v1));
    for (const cv::Point2d& place : {first, last})
      for (const double side : {1.0, -1.0}) gaps_.emplace_back(sheet_, e, place, side);
  }

  [[nodiscard]] SideView summary(std::span<const Ray> rays) const {
    SideView view;
    std::vector<double> free, near, fill, spread, red_green, yellow_blue;
    for (const Ray& ray : rays) {
      free.push_back(ray.count > 0 ? ray.events[0].distance : reach_.far);
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

  [[nodiscard]] SideView::ParallelHit parallel_hit(std::span<const Ray> rays, int wanted) const {
    std::vector<double> distances, after;
    std::map<int, int> votes;
    int opposite = 0;
    for (const Ray& ray : rays) {
      int parallel = 0;
      for (int k = 0; k < ray.count; ++k) {
        const Event& event = ray.events[static_cast<std::size_t>(k)];
        if (!event.parallel || event.distance > reach_.faces || parallel++ != wanted) continue;
        distances.push_back(event.distance);
        after.push_back(k + 1 < ray.count
                            ? ray.events[static_cast<std::size_t>(k + 1)].distance - event.distance
                            : reach_.far);
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
  const Reach reach_{sheet_};
  std::vector<Ray> rays_;
  std::vector<Gap> gaps_;
};

}  // namespace

std::vector<EdgeViews> look_across(const EdgeSheet& sheet) {
  std::vector<EdgeViews> views(sheet.edges.size());
  const std::size_t batches = (views.size() + kEdgesAtOnce - 1) / kEdgesAtOnce;
  const auto look = [&](const cv::Range& some) {
    Looker looker(sheet);
    for (auto k = static_cast<std::size_t>(some.start); k < static_cast<std::size_t>(some.end); ++k)
      looker.look(k * kEdgesAtOnce, std::min(views.size(), (k + 1) * kEdgesAtOnce), views);
  };
  cv::parallel_for_({0, static_cast<int>(batches)}, look);
  return views;
}

}  // namespace madori::mapping
