#include "tests/bench/wall_training/plan_things.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace madori::training {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

class Furnisher {
 public:
  Furnisher(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance)
      : canvas_(canvas), s_(style), r_(room), chance_(chance) {
    const double edge = 0.5 * style.inner_m + 0.1;
    in_ = Box(room.x + edge, room.y + edge, room.width - 2 * edge, room.height - 2 * edge);
  }

  void run() {
    if (in_.width < 0.8 || in_.height < 0.8) return;
    if (s_.tiles > 0 && chance_.one_in(s_.tiles)) tiles(chance_.between(0.3, 1));
    if (chance_.one_in(s_.building == Building::Flat ? 0.03 : 0.07)) return stairs();
    if (chance_.one_in(0.03)) return lift();
    if (s_.building == Building::Warehouse && in_.area() > 60) return racks();
    if (s_.furniture > 0 && in_.area() > 2) furniture();
    if (chance_.one_in(s_.overhead)) overhead();
    if (chance_.one_in(s_.labels)) label();
  }

 private:
  void thing(const Box& q) {
    if (chance_.one_in(s_.filled_things)) canvas_.fill(q, s_.thing_fill);
    canvas_.box(q, s_.thing, s_.thing_pen);
  }
  void round(Point middle, double w, double h) {
    canvas_.arc(middle, {w / 2, h / 2}, 0, kTurn, s_.thing, s_.thing_pen);
  }

  void furniture() {
    if (s_.building == Building::Hall && in_.area() > 40 && chance_.one_in(0.7)) return machines();
    if (s_.building == Building::Office && chance_.one_in(0.3)) desk_rows();
    if (chance_.one_in(0.35 * s_.furniture)) counter();
    const int count = std::min(25, static_cast<int>(s_.furniture * in_.area() / chance_.between(2, 7)));
    for (int k = 0; k < count; ++k) piece();
  }

  void piece() {
    const double w = chance_.between(0.4, 2.2), h = chance_.between(0.4, 1.1);
    const bool turned = chance_.one_in(0.5), aside = chance_.one_in(0.5);
    const double dx = turned ? h : w, dy = turned ? w : h;
    if (dx > in_.width || dy > in_.height) return;
    const Box q(aside ? (chance_.one_in(0.5) ? in_.x : in_.x + in_.width - dx)
                      : chance_.between(in_.x, in_.x + in_.width - dx),
                chance_.between(in_.y, in_.y + in_.height - dy), dx, dy);
    something_in(q, std::min(dx, dy) * chance_.between(0.5, 1));
  }

  void something_in(const Box& q, double side) {
    const double dx = q.width, dy = q.height;
    const Point m(q.x + dx / 2, q.y + dy / 2);
    switch (chance_.below(11)) {
      case 0:
        round(m, std::min(dx, dy), std::min(dx, dy));
        break;
      case 1:  // a desk with its chair
        thing(q);
        thing({m.x - 0.22, q.y + dy + 0.05, 0.45, 0.42});
        break;
      case 2:  // a basin
        thing(q);
        round(m, dx * 0.7, dy * 0.7);
        break;
      case 3:
        canvas_.fill(q, s_.thing_fill);
        break;
      case 4:  // a bath, a bed
        thing(q);
        canvas_.box({q.x + 0.1, q.y + 0.1, dx - 0.2, dy - 0.2}, s_.thing, s_.thin_pen);
        break;
      case 5:  // a table with chairs
        round(m, std::min(dx, dy), std::min(dx, dy));
        for (int k = 0; k < 4; ++k)
          round(m + 0.6 * std::min(dx, dy) * Point(std::cos(k * kTurn / 4), std::sin(k * kTurn / 4)), 0.4,
                0.4);
        break;
      case 6:  // a cupboard
        thing(q);
        canvas_.line({q.x, q.y}, {q.x + dx, q.y + dy}, s_.thing, s_.thin_pen);
        break;
      case 7:
        plant(m, 0.5 * std::min(dx, dy));
        break;
      case 8:  // a chair, a stool, a square table: as square as a column, but not on a grid
        thing({m.x - side / 2, m.y - side / 2, side, side});
        break;
      case 9:
        square_table(m, side);
        break;
      default:
        thing(q);
    }
  }

  void square_table(Point m, double side) {
    const double seat = side * chance_.between(0.4, 0.7), off = 0.5 * (side + seat) + chance_.between(0, 0.2);
    thing({m.x - side / 2, m.y - side / 2, side, side});
    for (const Point& to : {Point(off, 0), Point(-off, 0), Point(0, off), Point(0, -off)})
      if (chance_.one_in(0.8)) thing({m.x + to.x - seat / 2, m.y + to.y - seat / 2, seat, seat});
  }

  void plant(Point m, double radius) {
    const int leaves = 5 + chance_.below(8);
    for (int k = 0; k < leaves; ++k) {
      const double a = k * kTurn / leaves;
      canvas_.line(m, m + radius * Point(std::cos(a), std::sin(a)), s_.thing, s_.thin_pen);
    }
  }

  /// What hangs above: a beam, a crane's way, the edge of a gallery.
  void overhead() {
    const double y = chance_.between(in_.y, in_.y + in_.height),
                 x = chance_.between(in_.x, in_.x + in_.width);
    const double dash = chance_.between(4, 30);
    chance_.one_in(0.5)
        ? canvas_.dashed({in_.x, y}, {in_.x + in_.width, y}, s_.thing, s_.thing_pen, dash, false)
        : canvas_.dashed({x, in_.y}, {x, in_.y + in_.height}, s_.thing, s_.thing_pen, dash,
                         chance_.one_in(0.3));
  }

  /// A kitchen's or laboratory's counter runs along a wall, as a face of it would.
  void counter() {
    const double deep = chance_.between(0.35, 0.8);
    const bool across = chance_.one_in(0.5), far = chance_.one_in(0.5);
    const double length = (across ? in_.width : in_.height) * chance_.between(0.4, 1);
    const Box q = across ? Box(in_.x, far ? in_.y + in_.height - deep : in_.y, length, deep)
                         : Box(far ? in_.x + in_.width - deep : in_.x, in_.y, deep, length);
    thing(q);
    if (chance_.one_in(0.5)) {
      const Point m(q.x + q.width / 2, q.y + q.height / 2);
      for (const double off : {-0.25, 0.25}) round(m + (across ? Point(off, 0) : Point(0, off)), 0.3, 0.3);
    }
  }

  void desk_rows() {
    const double w = chance_.between(1.2, 1.8), h = chance_.between(0.6, 0.9),
                 aisle = chance_.between(0.9, 2);
    for (double y = in_.y + 0.5; y + 2 * h + 0.5 < in_.y + in_.height; y += 2 * h + aisle + 1)
      for (double x = in_.x + 0.5; x + w < in_.x + in_.width; x += w)
        for (const double side : {0.0, h}) {
          thing({x, y + side, w, h});
          thing({x + w / 2 - 0.25, side > 0 ? y + 2 * h + 0.05 : y - 0.5, 0.5, 0.45});
        }
  }

  void machines() {
    const int count = std::min(16, static_cast<int>(s_.furniture * in_.area() / 30) + 1);
    for (int k = 0; k < count; ++k) {
      const double w = std::min(in_.width / 2, chance_.scaled(1, 7)),
                   h = std::min(in_.height / 2, chance_.scaled(0.8, 4));
      const Box q(chance_.between(in_.x, in_.x + in_.width - w),
                  chance_.between(in_.y, in_.y + in_.height - h), w, h);
      thing(q);
      for (int part = chance_.below(4); part > 0; --part) {
        const double pw = w * chance_.between(0.1, 0.5), ph = h * chance_.between(0.1, 0.8);
        thing({q.x + chance_.between(0, w - pw), q.y + chance_.between(0, h - ph), pw, ph});
      }
      if (chance_.one_in(0.3))
        canvas_.dashed({q.x - 0.6, q.y - 0.6}, {q.x + w + 0.6, q.y - 0.6}, s_.thing, s_.thin_pen, 5, false);
    }
    if (chance_.one_in(0.3)) {  // a conveyor
      const double y = chance_.between(in_.y, in_.y + in_.height * 0.8), deep = chance_.between(0.5, 1.2);
      canvas_.box({in_.x + 1, y, in_.width - 2, deep}, s_.thing, s_.thing_pen);
      const double roller = chance_.between(0.15, 0.6);
      for (double x = in_.x + 1; x < in_.x + in_.width - 1; x += roller)
        canvas_.line({x, y}, {x, y + deep}, s_.thing, s_.thin_pen);
    }
  }

  void racks() {
    const double deep = chance_.between(0.8, 1.3), bay = chance_.between(0.9, 2.8),
                 aisle = chance_.between(2, 4);
    const bool across = chance_.one_in(0.5), doubled = chance_.one_in(0.6), crossed = chance_.one_in(0.2);
    const double length = across ? in_.width : in_.height, wide = across ? in_.height : in_.width;
    for (double off = chance_.between(0.5, 3); off + 2 * deep + 0.5 < wide;
         off += (doubled ? 2 : 1) * deep + aisle)
      for (double at = 1.5; at + bay + 1.5 < length; at += bay)
        for (int side = 0; side < (doubled ? 2 : 1); ++side) {
          const double o = off + side * deep;
          const Box q =
              across ? Box(in_.x + at, in_.y + o, bay, deep) : Box(in_.x + o, in_.y + at, deep, bay);
          if (chance_.one_in(0.04)) canvas_.fill(q, s_.thing);
          canvas_.box(q, s_.thing, s_.thing_pen);
          if (crossed) canvas_.line({q.x, q.y}, {q.x + q.width, q.y + q.height}, s_.thing, s_.thin_pen);
        }
  }

  void stairs() {
    const bool across = in_.width > in_.height;
    const double wide = std::min(across ? in_.height : in_.width, chance_.between(0.9, 1.8)),
                 step = chance_.between(0.24, 0.32);
    const double end = (across ? in_.width : in_.height) * chance_.between(0.5, 0.95);
    const auto at = [&](double along, double off) {
      return across ? Point(in_.x + along, in_.y + off) : Point(in_.x + off, in_.y + along);
    };
    for (double a = 0; a < end; a += step) canvas_.line(at(a, 0), at(a, wide), s_.thing, s_.thing_pen);
    canvas_.line(at(0, wide), at(end, wide), s_.thing, s_.thing_pen);
    if (chance_.one_in(0.7)) canvas_.line(at(0.2, wide / 2), at(end - 0.2, wide / 2), s_.thing, s_.thin_pen);
  }

  void lift() {
    const double w = std::min(in_.width, 2.2), h = std::min(in_.height, 2.2);
    const Box q(in_.x, in_.y, w, h);
    canvas_.box(q, s_.thing, s_.thing_pen);
    canvas_.line({q.x, q.y}, {q.x + w, q.y + h}, s_.thing, s_.thing_pen);
    canvas_.line({q.x + w, q.y}, {q.x, q.y + h}, s_.thing, s_.thing_pen);
  }

  void tiles(double step) {
    for (double x = in_.x; x < in_.x + in_.width; x += step)
      canvas_.line({x, in_.y}, {x, in_.y + in_.height}, s_.thing, 0.6 * s_.thin_pen);
    for (double y = in_.y; y < in_.y + in_.height; y += step)
      canvas_.line({in_.x, y}, {in_.x + in_.width, y}, s_.thing, 0.6 * s_.thin_pen);
  }

  void label() {
    static const std::vector<std::string> words{
        "OFFICE", "Room 12", "Bedroom", "WC",  "STORE 3", "Hall", "12.5 m2",
        "A-104",  "Kitchen", "101",     "LAB", "Meeting", "B",    "Reception Room"};
    const Point at(in_.x + in_.width * chance_.between(0.05, 0.3),
                   in_.y + in_.height * chance_.between(0.3, 0.7));
    const int face = chance_.below(8);
    canvas_.text(at, chance_.of(words), s_.text_px, s_.text, face);
    const Point below = at + Point(0, canvas_.metres(1.4 * s_.text_px));
    if (chance_.one_in(0.4)) canvas_.text(below, "4.11 x 2.72", 0.85 * s_.text_px, s_.text, face);
    if (chance_.one_in(0.15))
      canvas_.box({at.x - 0.1, at.y - canvas_.metres(1.2 * s_.text_px), canvas_.metres(4.5 * s_.text_px),
                   canvas_.metres(1.7 * s_.text_px)},
                  s_.text, s_.thin_pen);
  }

  PlanCanvas& canvas_;
  const PlanStyle& s_;
  Box r_, in_;
  Chance& chance_;
};

}  // namespace

void furnish(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance) {
  Furnisher(canvas, style, room, chance).run();
}

}  // namespace madori::training
