#include "tests/support/random_hall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "core/angle.hpp"
#include "mapping/wall_map/distance_field.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::test {
namespace {

constexpr double kClearM = 0.5;

double uniform(double low, double high, std::mt19937& engine) {
  return std::uniform_real_distribution<double>(low, high)(engine);
}

void add_turned_box(mapping::Walls& walls, const Point2<Map>& middle, double half_x, double half_y,
                    double yaw_rad) {
  const Transform2<Map, Base> at(middle.x_m, middle.y_m, yaw_rad);
  const Point2<Base> corners[] = {{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}};
  for (int i = 0; i < 4; ++i) {
    const Point2<Map> a = at * corners[i], b = at * corners[(i + 1) % 4];
    add_wall(walls, a.x_m, a.y_m, b.x_m, b.y_m);
  }
}

/// From one long side into the hall or right across it, with a door of 1.6 to 3 m.
void add_partition(mapping::Walls& walls, double width, double height, std::mt19937& engine) {
  const bool across = uniform(0.0, 1.0, engine) < 0.5;  // else along
  const double length = across ? height : width;
  const double at = uniform(0.2, 0.8, engine) * (across ? width : height);
  const double door = uniform(1.6, 3.0, engine);
  const double from = uniform(0.1, 0.8, engine) * (length - door);
  const auto piece = [&](double a, double b) {
    if (across) {
      add_wall(walls, at, a, at, b);
    } else {
      add_wall(walls, a, at, b, at);
    }
  };
  piece(0.0, from);
  if (uniform(0.0, 1.0, engine) < 0.6) piece(from + door, length);
}

/// Cells of 0.25 m where a vehicle has room, and the ways between them.
class FreeCells {
 public:
  FreeCells(const mapping::Walls& walls, double width, double height)
      : field_(walls), width_(static_cast<int>(width / kCellM)), height_(static_cast<int>(height / kCellM)) {
    for (int i = 0; i < width_ * height_; ++i) free_.push_back(field_.distance_m(centre(i)) > kClearM);
  }
  [[nodiscard]] Point2<Map> centre(int cell) const {
    return {(cell % width_ + 0.5) * kCellM, (cell / width_ + 0.5) * kCellM};
  }
  [[nodiscard]] int size() const { return width_ * height_; }
  [[nodiscard]] bool is_free(int cell) const { return free_[static_cast<std::size_t>(cell)]; }

  /// Metres from `start` to every cell, infinite where no way leads.
  [[nodiscard]] std::vector<double> distances(int start) const {
    std::vector<double> far(free_.size(), std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    far[static_cast<std::size_t>(start)] = 0.0;
    open.emplace(0.0, start);
    while (!open.empty()) {
      const auto [d, cell] = open.top();
      open.pop();
      if (d > far[static_cast<std::size_t>(cell)]) continue;
      for_neighbours(cell, [&](int next, double step) {
        double& known = far[static_cast<std::size_t>(next)];
        if (d + step >= known) return;
        known = d + step;
        open.emplace(known, next);
      });
    }
    return far;
  }

  /// Corners of the way downhill from `from`, without those that a straight line makes needless.
  [[nodiscard]] std::vector<Point2<Map>> way(int from, const std::vector<double>& far) const {
    std::vector<Point2<Map>> cells{centre(from)};
    for (int cell = from; far[static_cast<std::size_t>(cell)] > 0.0;) {
      int best = cell;
      for_neighbours(cell, [&](int next, double) {
        if (far[static_cast<std::size_t>(next)] < far[static_cast<std::size_t>(best)]) best = next;
      });
      cells.push_back(centre(cell = best));
    }
    std::vector<Point2<Map>> corners{cells.front()};
    for (std::size_t i = 0; i + 1 < cells.size();) {
      std::size_t k = cells.size() - 1;
      while (k > i + 1 && !is_straight(cells[i], cells[k])) --k;
      corners.push_back(cells[i = k]);
    }
    return corners;
  }

 private:
  static constexpr double kCellM = 0.25;

  template <class Visit>
  void for_neighbours(int cell, Visit&& visit) const {
    const int x = cell % width_, y = cell / width_;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int nx = x + dx, ny = y + dy;
        if ((dx == 0 && dy == 0) || nx < 0 || ny < 0 || nx >= width_ || ny >= height_) continue;
        if (is_free(ny * width_ + nx)) visit(ny * width_ + nx, kCellM * std::hypot(dx, dy));
      }
  }
  [[nodiscard]] bool is_straight(const Point2<Map>& a, const Point2<Map>& b) const {
    const int steps = std::max(1, static_cast<int>(distance_m(a, b) / 0.1));
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      if (field_.distance_m({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)}) < kClearM)
        return false;
    }
    return true;
  }

  mapping::DistanceField field_;
  int width_, height_;
  std::vector<bool> free_;
};

/// Free cells that can be reached from each other, the most of five tries.
std::vector<int> reachable(const FreeCells& cells, std::mt19937& engine) {
  std::vector<int> free, most;
  for (int i = 0; i < cells.size(); ++i)
    if (cells.is_free(i)) free.push_back(i);
  for (int tried = 0; tried < 5 && !free.empty(); ++tried) {
    const auto far = cells.distances(free[engine() % free.size()]);
    std::vector<int> reached;
    std::copy_if(free.begin(), free.end(), std::back_inserter(reached),
                 [&](int cell) { return std::isfinite(far[static_cast<std::size_t>(cell)]); });
    if (reached.size() > most.size()) most = std::move(reached);
  }
  return most;
}

/// Past random places, always on to the nearest that is left.
std::vector<Point2<Map>> round_trip(const FreeCells& cells, double area_m2, std::mt19937& engine) {
  const std::vector<int> reached = reachable(cells, engine);
  std::vector<int> left;
  const int places = std::clamp(static_cast<int>(area_m2 / 60.0), 6, 60);
  for (int i = 0; i < places; ++i) left.push_back(reached[engine() % reached.size()]);
  const int first = left.back();
  std::vector<Point2<Map>> way{cells.centre(first)};
  std::vector<double> to_here = cells.distances(first);
  int here = first;
  left.pop_back();
  const auto go = [&](int next) {
    const auto far = cells.distances(next);
    const auto leg = cells.way(here, far);
    way.insert(way.end(), leg.begin() + 1, leg.end());
    to_here = far;
    here = next;
  };
  while (!left.empty()) {
    const auto next = std::min_element(left.begin(), left.end(), [&](int a, int b) {
      return to_here[static_cast<std::size_t>(a)] < to_here[static_cast<std::size_t>(b)];
    });
    const int cell = *next;
    left.erase(next);
    if (cell != here) go(cell);
  }
  if (here != first) go(first);
  const std::size_t third = way.size() / 3;
  for (std::size_t i = 1; i <= third; ++i) way.push_back(way[i]);
  return way;
}

}  // namespace

RandomHall random_hall(double area_m2, std::mt19937& engine) {
  RandomHall hall;
  hall.area_m2 = area_m2;
  const double aspect = uniform(1.0, 2.5, engine);
  const double width = std::sqrt(area_m2 * aspect), height = area_m2 / width;
  add_box(hall.walls, 0.0, 0.0, width, height);
  const int partitions = static_cast<int>(area_m2 / 400.0 + uniform(0.0, 1.0, engine));
  for (int i = 0; i < partitions; ++i) add_partition(hall.walls, width, height, engine);
  const int machines = std::max(3, static_cast<int>(area_m2 / uniform(25.0, 45.0, engine)));
  for (int i = 0; i < machines; ++i) {
    const double half_x = uniform(0.25, 2.5, engine), half_y = uniform(0.25, 1.0, engine);
    const double askew =
        engine() % 6 == 0 ? uniform(-kPi, kPi, engine) : (engine() % 2 == 0 ? 0.0 : 0.5 * kPi);
    add_turned_box(hall.walls, {uniform(0.0, width, engine), uniform(0.0, height, engine)}, half_x, half_y,
                   askew);
  }
  const int columns = static_cast<int>(area_m2 / 150.0);
  for (int i = 0; i < columns; ++i)
    add_turned_box(hall.walls, {uniform(0.0, width, engine), uniform(0.0, height, engine)}, 0.2, 0.2, 0.0);
  hall.way = round_trip(FreeCells(hall.walls, width, height), area_m2, engine);
  return hall;
}

}  // namespace madori::test
