#include <algorithm>
#include <numbers>

#include "tests/bench/wall_training/plan_things.hpp"

namespace madori::training {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

class Annotator {
 public:
  Annotator(PlanCanvas& canvas, const PlanStyle& style, const Box& building, Chance& chance)
      : canvas_(canvas), s_(style), b_(building), chance_(chance) {}

  void axes() {
    const bool bare = chance_.one_in(0.4);  // a grid over the building, not named at its ends
    const double reach = bare ? chance_.between(-0.3, 0.5) : canvas_.metres(chance_.between(15, 60)),
                 step = chance_.between(3, 9);
    const int kind = bare ? 0 : chance_.below(3);
    const auto axis = [&](Point a, Point b) {
      if (kind == 0) {
        canvas_.line(a, b, s_.grid, s_.thin_pen);
      } else {
        canvas_.dashed(a, b, s_.grid, s_.thin_pen, 14, kind == 2);
      }
      if (bare || !chance_.one_in(0.8)) return;
      const double radius = canvas_.metres(9);
      canvas_.arc(a, {radius, radius}, 0, kTurn, s_.grid, s_.thin_pen);
      canvas_.text(a + Point(-0.4 * radius, 0.4 * radius),
                   std::string(1, static_cast<char>('A' + chance_.below(26))), 11, s_.grid, 0);
    };
    const bool on_walls = chance_.one_in(0.4);
    for (double x = b_.x + (on_walls ? 0 : chance_.between(0, step)); x <= b_.x + b_.width; x += step)
      axis({x, b_.y - reach}, {x, b_.y + b_.height + reach});
    for (double y = b_.y + (on_walls ? 0 : chance_.between(0, step)); y <= b_.y + b_.height; y += step)
      axis({b_.x - reach, y}, {b_.x + b_.width + reach, y});
  }

  /// Chains of dimensions above and to the left, some inside.
  void dimensions() {
    const int chains = 1 + chance_.below(3), kind = chance_.below(3);
    for (int k = 0; k < chains; ++k) {
      const double off = canvas_.metres(16.0 + 15 * k);
      chain({b_.x, b_.y - off}, {b_.x + b_.width, b_.y - off}, kind,
            k + 1 == chains ? 1 : 3 + chance_.below(8));
      chain({b_.x - off, b_.y + b_.height}, {b_.x - off, b_.y}, kind,
            k + 1 == chains ? 1 : 3 + chance_.below(6));
    }
    for (int k = chance_.below(6); k > 0; --k) {
      const double y = chance_.between(b_.y, b_.y + b_.height),
                   x = chance_.between(b_.x, b_.x + 0.6 * b_.width);
      chain({x, y}, {x + chance_.between(0.1, 0.4) * b_.width, y}, kind, 1);
    }
  }

  void routes() {
    const int count = 1 + chance_.below(3);
    for (int n = 0; n < count; ++n) {
      Point last(chance_.between(b_.x, b_.x + b_.width), chance_.between(b_.y, b_.y + b_.height));
      for (int k = 0; k < 5; ++k) {
        const Point next = k % 2 == 0 ? Point(chance_.between(b_.x, b_.x + b_.width), last.y)
                                      : Point(last.x, chance_.between(b_.y, b_.y + b_.height));
        canvas_.dashed(last, next, s_.thing, s_.thing_pen, 7, false);
        last = next;
      }
    }
  }

  /// A terrace, parked cars, the line of the lot, hatched ground.
  void outdoors() {
    const double gap = chance_.between(0.5, 4);
    if (chance_.one_in(0.4))
      canvas_.dashed({b_.x - gap, b_.y - gap}, {b_.x + b_.width + gap, b_.y - gap}, s_.thing, s_.thin_pen, 16,
                     true);
    if (chance_.one_in(0.4))
      canvas_.box({b_.x - gap, b_.y - gap, b_.width + 2 * gap, b_.height + 2 * gap}, s_.thing, s_.thin_pen);
    if (chance_.one_in(0.4)) {
      const double step = chance_.between(2.3, 2.7);
      for (double x = b_.x; x < b_.x + b_.width * chance_.between(0.3, 1); x += step)
        canvas_.line({x, b_.y + b_.height + 0.5}, {x, b_.y + b_.height + 5}, s_.thing, s_.thing_pen);
    }
    if (chance_.one_in(0.3))
      canvas_.fill(Box(b_.x + b_.width * 0.3, b_.y + b_.height + 0.3, b_.width * 0.4, gap), s_.thing_fill);
    if (chance_.one_in(0.3)) {
      const double step = canvas_.metres(chance_.between(4, 10));
      for (double x = b_.x; x < b_.x + b_.width * 0.5; x += step)
        canvas_.line({x, b_.y - 0.5}, {x + 1, b_.y - 0.5 - gap}, s_.thing, s_.thin_pen);
    }
  }

  /// Coloured areas that end somewhere between the walls.
  void zones() {
    for (int k = 1 + chance_.below(5); k > 0; --k) {
      const double w = b_.width * chance_.between(0.05, 0.45), h = b_.height * chance_.between(0.05, 0.45);
      canvas_.fill(Box(b_.x + chance_.between(-0.1, 0.9) * b_.width,
                       b_.y + chance_.between(-0.1, 0.9) * b_.height, w, h),
                   blend(s_.ground, bright_colour(chance_), chance_.between(0.1, 0.9)));
    }
  }

  /// One or two rows of boxes in turn filled and empty, below the building.
  void scale_bar() {
    const int cells = 2 + chance_.below(8), rows = 1 + chance_.below(2);
    const double wide = chance_.scaled(0.01, 0.12) * b_.width, high = canvas_.metres(chance_.between(5, 16)),
                 pen = s_.thing_pen * chance_.between(1, 2);
    const Point at(b_.x + chance_.between(0, 0.3) * b_.width, b_.y + b_.height + canvas_.metres(12));
    for (int k = 0; k < cells; ++k)
      for (int row = 0; row < rows; ++row) {
        const Box cell(at.x + k * wide, at.y + row * high, wide, high);
        if ((k + row) % 2 == 0) canvas_.fill(cell, s_.text);
        canvas_.box(cell, s_.text, pen);
      }
  }

  void ceiling() {
    const double step = chance_.between(0.6, 2.4);
    for (double x = b_.x; x < b_.x + b_.width; x += step)
      canvas_.line({x, b_.y}, {x, b_.y + b_.height}, s_.grid, s_.thin_pen);
    for (double y = b_.y; y < b_.y + b_.height; y += step)
      canvas_.line({b_.x, y}, {b_.x + b_.width, y}, s_.grid, s_.thin_pen);
  }

 private:
  void chain(Point a, Point b, int kind, int parts) {
    const double length = cv::norm(b - a), tick = canvas_.metres(4);
    const Point along = (b - a) / length, across(-along.y, along.x);
    canvas_.line(a, b, s_.dimension, s_.thin_pen);
    for (int k = 0; k <= parts; ++k) {
      const Point p = a + (b - a) * (static_cast<double>(k) / parts);
      canvas_.line(p - across * tick * 1.5, p + across * tick * 1.5, s_.dimension, s_.thin_pen);
      if (kind == 0)
        canvas_.line(p - (along + across) * tick, p + (along + across) * tick, s_.dimension, s_.thing_pen);
      if (kind == 1)
        canvas_.fill(
            {p, p + along * tick * 2 + across * tick * 0.5, p + along * tick * 2 - across * tick * 0.5},
            s_.dimension);
      if (k < parts)
        canvas_.text(p + (b - a) * (0.4 / parts) - Point(0, canvas_.metres(3)),
                     std::to_string(900 + chance_.below(8000)), 9, s_.dimension, 0);
    }
  }

  PlanCanvas& canvas_;
  const PlanStyle& s_;
  Box b_;
  Chance& chance_;
};

}  // namespace

void annotate(PlanCanvas& canvas, const PlanStyle& style, const Box& building, Chance& chance) {
  Annotator notes(canvas, style, building, chance);
  if (chance.one_in(style.zones)) notes.zones();
  if (chance.one_in(style.axes)) notes.axes();
  if (chance.one_in(style.dimensions)) notes.dimensions();
  if (chance.one_in(style.routes)) notes.routes();
  if (chance.one_in(style.outdoors)) notes.outdoors();
  if (chance.one_in(style.ceiling)) notes.ceiling();
  if (chance.one_in(style.scale_bar)) notes.scale_bar();
}

void frame_sheet(PlanCanvas& canvas, const PlanStyle& style, const Box& sheet, Chance& chance) {
  const double gap = canvas.metres(chance.between(4, 14));
  if (style.frame > 0) {
    canvas.box({gap, gap, sheet.width - 2 * gap, sheet.height - 2 * gap}, style.text,
               style.thing_pen * style.frame);
    if (chance.one_in(0.3))
      canvas.box({2 * gap, 2 * gap, sheet.width - 4 * gap, sheet.height - 4 * gap}, style.text,
                 style.thin_pen);
  }
  if (style.title <= 0) return;
  const double w = canvas.metres(chance.between(90, 220)), h = canvas.metres(chance.between(25, 70));
  const Box q(sheet.width - gap - w, sheet.height - gap - h, w, h);
  if (chance.one_in(0.6)) {
    canvas.box(q, style.text, style.thing_pen);
    for (const double t : {0.33, 0.66})
      canvas.line({q.x, q.y + t * h}, {q.x + w, q.y + t * h}, style.text, style.thin_pen);
    canvas.line({q.x + 0.6 * w, q.y}, {q.x + 0.6 * w, q.y + h}, style.text, style.thin_pen);
  }
  canvas.text({q.x + 0.05 * w, q.y + 0.28 * h}, "GROUND FLOOR 1:100", 0.22 * h * style.px_per_m, style.text,
              chance.below(8));
  if (chance.one_in(0.5)) {  // a scale bar, a north arrow
    for (int k = 0; k < 5; ++k) {
      const Box bar(2 * gap + k, sheet.height - 2 * gap, 1, canvas.metres(6));
      k % 2 == 0 ? canvas.fill(bar, style.text) : canvas.box(bar, style.text, style.thin_pen);
    }
    const Point n(sheet.width - 3 * gap - 1, 3 * gap + 1);
    canvas.arc(n, {canvas.metres(14), canvas.metres(14)}, 0, kTurn, style.text, style.thin_pen);
    canvas.line(n, n - Point(0, canvas.metres(20)), style.text, style.thing_pen);
  }
}

}  // namespace madori::training
