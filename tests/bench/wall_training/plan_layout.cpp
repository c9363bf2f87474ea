#include "tests/bench/wall_training/plan_layout.hpp"

#include <algorithm>
#include <cmath>

namespace madori::training {
namespace {

class Splitter {
 public:
  Splitter(const PlanStyle& style, Wing& wing, Chance& chance) : style_(style), wing_(wing), chance_(chance) {
    switch (style.building) {
      case Building::Flat:
        least_ = chance.between(1.6, 2.6), stop_ = 0.1;
        break;
      case Building::Office:
        least_ = chance.between(2.2, 4), stop_ = 0.15;
        break;
      case Building::Hall:
        least_ = chance.between(3, 8), stop_ = 0.45;
        break;
      case Building::Warehouse:
        least_ = chance.between(5, 12), stop_ = 0.7;
        break;
    }
    if (style.few_rooms || chance.one_in(0.2)) least_ *= chance.between(1.5, 4);  // a few large rooms
  }

  void run() {
    const Box whole(0, 0, wing_.width, wing_.height);
    outside(whole);
    const bool corridor = style_.building != Building::Warehouse && chance_.one_in(0.5) &&
                          std::min(wing_.width, wing_.height) > 2 * least_ + 2;
    corridor ? with_corridor(whole) : split(whole, 0);
    if (chance_.one_in(0.25)) extra_wall(whole);
    for (PlanWall& wall : wing_.walls) open(wall);
  }

 private:
  void wall(Point a, Point b, bool outer = false) {
    if (cv::norm(b - a) > 0.2) wing_.walls.push_back({a, b, outer, false, {}});
  }

  /// The outline, here and there with a step or a corner cut off.
  void outside(const Box& q) {
    const auto p = PlanCanvas::corners(q);
    const int cut = chance_.one_in(0.2) ? chance_.below(4) : -1;
    const double size = cut < 0 ? 0 : chance_.between(0.08, 0.25) * std::min(q.width, q.height);
    std::vector<Point> outline;
    for (int k = 0; k < 4; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const Point back = (p[(i + 3) % 4] - p[i]) / cv::norm(p[(i + 3) % 4] - p[i]),
                  on = (p[(i + 1) % 4] - p[i]) / cv::norm(p[(i + 1) % 4] - p[i]);
      if (k != cut) {
        outline.push_back(p[i]);
        continue;
      }
      outline.push_back(p[i] + back * size);
      if (chance_.one_in(0.3)) outline.push_back(p[i] + back * size + on * size * 0.7);
      outline.push_back(p[i] + on * size);
    }
    for (std::size_t k = 0; k < outline.size(); ++k)
      wall(outline[k], outline[(k + 1) % outline.size()], true);
  }

  void split(const Box& q, int depth) {
    const bool wide = q.width > q.height * chance_.between(0.8, 1.25);
    const double side = wide ? q.width : q.height;
    if (side < 2 * least_ || depth > 7 || (depth > 1 && chance_.one_in(stop_)) ||
        (style_.building == Building::Warehouse && chance_.one_in(0.5))) {
      wing_.rooms.push_back(q);
      return;
    }
    const double at = side * chance_.between(least_ / side, 1 - least_ / side);
    const Box first = wide ? Box(q.x, q.y, at, q.height) : Box(q.x, q.y, q.width, at);
    const Box second =
        wide ? Box(q.x + at, q.y, q.width - at, q.height) : Box(q.x, q.y + at, q.width, q.height - at);
    wall({second.x, second.y}, wide ? Point(second.x, q.y + q.height) : Point(q.x + q.width, second.y));
    split(first, depth + 1);
    split(second, depth + 1);
  }

  /// A corridor with cells of even width along it on both sides, as offices and schools have.
  void with_corridor(const Box& q) {
    const bool wide = q.width > q.height;
    const double across = wide ? q.height : q.width, length = wide ? q.width : q.height;
    const double hall = chance_.between(1.2, std::min(3.0, 0.3 * across));
    const double low = (across - hall) * chance_.between(0.3, 0.7);
    const auto place = [&](double along, double off) { return wide ? Point(along, off) : Point(off, along); };
    for (const bool first : {true, false}) {
      const double a = first ? 0 : low + hall, b = first ? low : across;
      wall(place(0, first ? low : low + hall), place(length, first ? low : low + hall));
      const double cell = chance_.between(least_, 2.5 * least_);
      for (double from = 0; from < length - 0.1;) {
        double to = from + cell * (chance_.one_in(0.2) ? 2 : 1);
        if (to > length - 0.6 * cell) to = length;
        if (to < length) wall(place(to, a), place(to, b));
        const Point p = place(from, a), s = place(to - from, b - a);
        const Box room(p.x, p.y, s.x, s.y);
        b - a > 2.5 * least_&& chance_.one_in(0.4) ? split(room, 3) : wing_.rooms.push_back(room);
        from = to;
      }
    }
  }

  /// Slanted or round, in the middle of things.
  void extra_wall(const Box& q) {
    const Point m(q.width * chance_.between(0.35, 0.65), q.height * chance_.between(0.35, 0.65));
    const double reach = chance_.between(0.1, 0.25) * std::min(q.width, q.height);
    if (chance_.one_in(0.6))
      return wall(m - Point(reach, reach), m + Point(reach, reach * chance_.between(-0.5, 1)));
    Point last = m + Point(reach, 0);
    const double sweep = chance_.between(1, 6);
    for (int k = 1; k <= 10; ++k) {
      const Point next = m + reach * Point(std::cos(0.1 * k * sweep), std::sin(0.1 * k * sweep));
      wall(last, next);
      last = next;
    }
  }

  /// Whether a wall ends at `place` metres of another.
  [[nodiscard]] bool met(const PlanWall& wall, double from, double to) const {
    const Point along = (wall.b - wall.a) / wall.length();
    return std::any_of(wing_.walls.begin(), wing_.walls.end(), [&](const PlanWall& other) {
      for (const Point& end : {other.a, other.b}) {
        const Point d = end - wall.a;
        const double t = d.dot(along), off = std::abs(d.x * along.y - d.y * along.x);
        if (off < 0.1 && t > from - 0.3 && t < to + 0.3) return true;
      }
      return false;
    });
  }

  void open(PlanWall& wall) {
    const double length = wall.length();
    const auto try_at = [&](double from, double size, bool window) {
      const double to = from + size;
      if (from < 0.15 || to > length - 0.15 || met(wall, from, to)) return false;
      for (const Opening& other : wall.openings)
        if (from < other.to + 0.2 && to > other.from - 0.2) return false;
      wall.openings.push_back({from, to, window});
      return true;
    };
    if (wall.outer && style_.windows > 0) {
      const double size = chance_.between(0.8, 2.4), step = size * chance_.between(1.2, 2.5);
      for (double at = chance_.between(0.2, 1.5); at + size < length; at += step)
        if (chance_.one_in(style_.windows)) try_at(at, size, true);
    }
    const double spacing = style_.building == Building::Hall        ? 9
                           : style_.building == Building::Warehouse ? 15
                                                                    : 4;
    const int doors = wall.outer ? (chance_.one_in(0.5) ? 1 : 0) : 1 + static_cast<int>(length / spacing);
    for (int k = 0; k < doors; ++k)
      for (int attempt = 0; attempt < 5; ++attempt) {
        const bool gate = chance_.one_in(0.15),
                   lorries = style_.building == Building::Hall || style_.building == Building::Warehouse;
        const double size = gate ? chance_.between(1.4, lorries ? 6 : 3) : chance_.between(0.7, 1.1);
        if (try_at(chance_.between(0.15, std::max(0.2, length - size)), size, false)) break;
      }
    std::sort(wall.openings.begin(), wall.openings.end(),
              [](const Opening& a, const Opening& b) { return a.from < b.from; });
  }

  const PlanStyle& style_;
  Wing& wing_;
  Chance& chance_;
  double least_ = 3, stop_ = 0.1;
};

}  // namespace

Wing random_wing(const PlanStyle& style, double width, double height, Chance& chance) {
  Wing wing{width, height, {}, {}};
  Splitter(style, wing, chance).run();
  return wing;
}

}  // namespace madori::training
