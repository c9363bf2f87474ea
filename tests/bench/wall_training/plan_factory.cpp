#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/bench/wall_training/plan_things.hpp"

namespace madori::training {
namespace {

class Partitioner {
 public:
  Partitioner(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance)
      : canvas_(canvas),
        s_(style),
        r_(room),
        chance_(chance),
        half_(0.5 * style.light->thickness_m * chance.between(0.6, 1.2)) {}

  /// A prefabricated office: four light walls, a door, what stands in it.
  void cabin() {
    const double w = chance_.between(2.2, std::min(8.0, 0.5 * r_.width)),
                 h = chance_.between(2, std::min(6.0, 0.5 * r_.height));
    const Box q(r_.x + chance_.between(1, r_.width - w - 1), r_.y + chance_.between(1, r_.height - h - 1), w,
                h);
    canvas_.fill(q, s_.ground);
    furnish(canvas_, s_, q, chance_);
    const auto p = PlanCanvas::corners(q);
    const auto door = static_cast<std::size_t>(chance_.below(5));  // one in five is closed
    for (std::size_t k = 0; k < 4; ++k) {
      const Point a = p[k], b = p[(k + 1) % 4];
      k == door ? with_door(a, b) : strip(a, b);
    }
    if (chance_.one_in(0.5)) leader(q);
  }

  /// A noise or welding screen.
  void screen() {
    const double side = std::min(r_.width, r_.height), radius = chance_.between(0.15, 0.4) * side;
    const Point m(r_.x + r_.width * chance_.between(0.3, 0.7), r_.y + r_.height * chance_.between(0.3, 0.7));
    const double from = chance_.between(0, 6.28), sweep = chance_.between(0.6, 3.5);
    const int pieces = std::max(3, static_cast<int>(sweep / 0.1));
    const auto at = [&](int k) {
      return m + radius * Point(std::cos(from + k * sweep / pieces), std::sin(from + k * sweep / pieces));
    };
    for (int k = 0; k < pieces; ++k) strip(at(k), at(k + 1));
  }

  /// Walls that stand out from one side of the room.
  void bays() {
    const double step = chance_.between(3, 8),
                 reach = chance_.between(2, 0.4 * std::min(r_.width, r_.height));
    const bool across = chance_.one_in(0.5), far = chance_.one_in(0.5);
    const int count = 1 + chance_.below(4);
    const double length = across ? r_.width : r_.height, wide = across ? r_.height : r_.width;
    const auto place = [&](double along, double off) {
      if (far) off = wide - off;
      return across ? Point(r_.x + along, r_.y + off) : Point(r_.x + off, r_.y + along);
    };
    const double first = chance_.between(2, step);
    for (int k = 0; k < count && first + k * step < length - 1; ++k)
      strip(place(first + k * step, 0), place(first + k * step, reach));
  }

 private:
  void strip(Point a, Point b) {
    const Point d = (b - a) / cv::norm(b - a), n(-d.y * half_, d.x * half_);
    canvas_.wall_body({a + n - d * half_, b + n + d * half_, b - n + d * half_, a - n - d * half_}, false);
  }

  void with_door(Point a, Point b) {
    const double length = cv::norm(b - a), wide = std::min(1.0, 0.6 * length),
                 from = chance_.between(0.3, length - wide - 0.2);
    const Point d = (b - a) / length, hinge = a + d * from, far = hinge + d * wide, out(d.y, -d.x);
    strip(a, hinge);
    strip(far, b);
    if (s_.door_kind == 6) return;
    canvas_.line(hinge, hinge + out * wide, s_.door, s_.thing_pen);
    const double turn = std::atan2(d.y, d.x);
    canvas_.arc(hinge, {wide, wide}, turn - std::numbers::pi / 2, turn, s_.door, s_.thin_pen);
  }

  void leader(const Box& q) {
    const Point from(q.x + 0.5 * q.width, q.y), knee = from + Point(1.5, -1.5), end = knee + Point(3, 0);
    canvas_.lines({from, knee, end}, false, s_.dimension, s_.thin_pen);
    canvas_.text(knee - Point(0, canvas_.metres(3)), "PREFABRICATED", 9, s_.dimension, 0);
  }

  PlanCanvas& canvas_;
  const PlanStyle& s_;
  Box r_;
  Chance& chance_;
  double half_;
};

/// Rows of cells with words in them.
void table(PlanCanvas& canvas, const PlanStyle& style, const Box& q, double pen, Chance& chance) {
  static const std::vector<std::string> words{"GROUND FLOOR", "LAYOUT", "SCALE 1:100", "DRAWN",  "CHECKED",
                                              "SHEET A-101",  "REV C",  "2021-03-14",  "HALL 2", "DATE"};
  const int rows = 2 + chance.below(5);
  const double high = q.height / rows, inner = chance.one_in(0.5) ? pen : style.thin_pen;
  canvas.box(q, style.text, pen);
  for (int row = 0; row < rows; ++row) {
    const double y = q.y + row * high;
    if (row > 0) canvas.line({q.x, y}, {q.x + q.width, y}, style.text, inner);
    const double cut = chance.one_in(0.6) ? chance.between(0.2, 0.8) : 0;
    if (cut > 0) canvas.line({q.x + cut * q.width, y}, {q.x + cut * q.width, y + high}, style.text, inner);
    for (const double x : {0.0, cut})
      if (chance.one_in(x == 0 || cut > 0 ? 0.8 : 0))
        canvas.text({q.x + (x + 0.02) * q.width, y + 0.7 * high}, chance.of(words),
                    std::min(0.5 * high * style.px_per_m, 30.0), style.text, chance.below(3));
  }
}

}  // namespace

void partition(PlanCanvas& canvas, const PlanStyle& style, const Box& room, Chance& chance) {
  if (std::min(room.width, room.height) < 7) return;
  for (int k = chance.below(3); k > 0; --k) Partitioner(canvas, style, room, chance).cabin();
  if (chance.one_in(0.4)) Partitioner(canvas, style, room, chance).screen();
  if (chance.one_in(0.4)) Partitioner(canvas, style, room, chance).bays();
}

void frame_large_sheet(PlanCanvas& canvas, const PlanStyle& style, const Box& sheet, Chance& chance) {
  const cv::Scalar crease = blend(style.ground, cv::Scalar::all(128), chance.between(0.1, 0.5));
  if (chance.one_in(0.4)) {  // folded to the size of a file
    const int columns = 2 + chance.below(5), rows = 2 + chance.below(3);
    for (int k = 1; k < columns; ++k)
      canvas.line({sheet.width * k / columns, 0}, {sheet.width * k / columns, sheet.height}, crease, 1.5);
    for (int k = 1; k < rows; ++k)
      canvas.line({0, sheet.height * k / rows}, {sheet.width, sheet.height * k / rows}, crease, 1.5);
  }
  const double gap = canvas.metres(chance.between(3, 25)), pen = style.wall_pen * chance.between(0.5, 2.5);
  const Box frame(gap, gap, sheet.width - 2 * gap, sheet.height - 2 * gap);
  if (chance.one_in(0.8)) canvas.box(frame, style.text, style.wall_pen * style.frame);
  const Point corner = frame.br();
  const double w = sheet.width * chance.between(0.12, 0.35), h = sheet.height * chance.between(0.05, 0.16);
  if (chance.one_in(0.7)) {
    table(canvas, style, {corner.x - w, corner.y - h, w, h}, pen, chance);
    if (chance.one_in(0.4)) {
      const double more = sheet.height * chance.between(0.05, 0.3);
      table(canvas, style, {corner.x - w, corner.y - h - more, w, more}, pen, chance);
    }
  } else if (chance.one_in(0.5)) {  // a strip below, or at the side
    table(canvas, style, {frame.x, corner.y - h, frame.width, h}, pen, chance);
  } else {
    const double wide = 0.5 * w;
    table(canvas, style, {corner.x - wide, frame.y, wide, frame.height}, pen, chance);
  }
}

}  // namespace madori::training
