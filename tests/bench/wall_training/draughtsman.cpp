// Draws plans in many styles, their walls known: what the wall model is trained on beside real drawings.
//   draughtsman FOLDER --plans N [--first-seed S] [--sketches | --factories]
// writes FOLDER/plan_SEED.png, plan_SEED.csv (u1,v1,u2,v2) and FOLDER/list.csv (the rows that train_walls
// reads). A seed is a plan: the same seed draws the same picture.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/bench/wall_training/plan_things.hpp"

namespace {

using namespace madori::training;

/// A building of one to four wings, each somewhere and somehow turned.
struct Placed {
  Wing wing;
  Point at;  // metres from the corner of the first
  double turn = 0;
};

class Plan {
 public:
  Plan(unsigned seed, PlanStyle (*style)(Chance&)) : chance_(seed), style_(style(chance_)) {
    choose_wings();
    Box whole = extent();
    double margin = chance_.between(12, 60) + (style_.dimensions > 0 ? 45 : 0);
    double most = chance_.scaled(420, 2400);
    const double longest = std::max(whole.width, whole.height);
    if (style_.light)
      most = std::max(most, chance_.scaled(800, 2000)), margin += most * chance_.between(0.05, 0.2);
    style_.px_per_m = std::clamp(most / longest, 7.0, 90.0);
    // what is thinner than some pixels cannot be told from a pen
    style_.outer_m = std::max(style_.outer_m, 4.5 / style_.px_per_m);
    style_.inner_m = std::max(style_.inner_m, 3.5 / style_.px_per_m);
    if (style_.light) style_.light->thickness_m = std::max(style_.light->thickness_m, 1.8 / style_.px_per_m);
    if (chance_.one_in(0.3)) style_.text_px = std::min(40.0, style_.text_px * style_.px_per_m / 25);
    origin_ = Point(margin, margin) - whole.tl() * style_.px_per_m;
    sheet_ = {whole.width * style_.px_per_m + 2 * margin, whole.height * style_.px_per_m + 2 * margin};
    if (chance_.one_in(0.15)) sheet_.width *= 1.3;
  }

  cv::Mat draw(std::vector<std::pair<Point, Point>>& truth) {
    PlanCanvas canvas(sheet_, style_);
    canvas.stand_at({0, 0}, style_.light && std::abs(style_.turn_rad) < 0.06 ? style_.turn_rad : 0);
    const Box sheet(0, 0, canvas.metres(sheet_.width), canvas.metres(sheet_.height));
    style_.light ? frame_large_sheet(canvas, style_, sheet, chance_)
                 : frame_sheet(canvas, style_, sheet, chance_);
    for (const Placed& p : wings_) {
      stand(canvas, p);
      annotate(canvas, style_, {0, 0, p.wing.width, p.wing.height}, chance_);
    }
    for (const Placed& p : wings_) {
      stand(canvas, p);
      floors(canvas, p.wing);
      for (const Box& room : p.wing.rooms) furnish(canvas, style_, room, chance_);
      columns(canvas, p.wing);
      for (const PlanWall& wall : p.wing.walls)
        if (is_thick(wall) && !wall.light) thick(canvas, wall);
    }
    canvas.draw_bodies(chance_);
    if (style_.light) light_walls(canvas);
    for (const Placed& p : wings_) {
      stand(canvas, p);
      for (const PlanWall& wall : p.wing.walls) openings(canvas, wall);
      for (const PlanWall& wall : p.wing.walls)
        if (!is_thick(wall)) thin(canvas, wall);
    }
    truth = canvas.truth();
    return canvas.copied(chance_);
  }

  [[nodiscard]] double tolerance() const {
    return style_.single_inner() ? std::max(3.0, 0.5 * style_.wall_pen + 2) : 3;
  }

 private:
  void choose_wings() {
    const auto size = [&]() -> std::pair<double, double> {
      switch (style_.building) {
        case Building::Flat:
          return {chance_.between(6, 16), chance_.between(5, 12)};
        case Building::Office:
          return {chance_.between(15, 55), chance_.between(10, 25)};
        case Building::Hall:
          return {chance_.between(20, 80), chance_.between(15, 50)};
        default:
          return {chance_.between(35, 110), chance_.between(25, 60)};
      }
    };
    const int count = style_.few_rooms || chance_.one_in(0.55) ? 1 : 2 + chance_.below(3);
    const bool oblique = chance_.one_in(0.4);
    Point at(0, 0);
    double turn = style_.turn_rad;
    for (int k = 0; k < count; ++k) {
      const auto [w, h] = size();
      wings_.push_back({random_wing(style_, w, h, chance_), at, turn});
      if (style_.light)
        for (PlanWall& wall : wings_.back().wing.walls) wall.light = !wall.outer && chance_.one_in(0.6);
      // the next wing starts at a corner of this one, and turns away from it
      const Point end = chance_.one_in(0.5) ? Point(w, 0) : Point(w, h * chance_.between(0.2, 0.8));
      at += Point(std::cos(turn) * end.x - std::sin(turn) * end.y,
                  std::sin(turn) * end.x + std::cos(turn) * end.y);
      turn += oblique ? chance_.between(-0.5, 0.1) : 0;
    }
  }

  [[nodiscard]] Box extent() const {
    Point low(1e9, 1e9), high(-1e9, -1e9);
    for (const Placed& p : wings_)
      for (const Point& c : PlanCanvas::corners({0, 0, p.wing.width, p.wing.height})) {
        const Point q = p.at + Point(std::cos(p.turn) * c.x - std::sin(p.turn) * c.y,
                                     std::sin(p.turn) * c.x + std::cos(p.turn) * c.y);
        low = {std::min(low.x, q.x), std::min(low.y, q.y)};
        high = {std::max(high.x, q.x), std::max(high.y, q.y)};
      }
    return {low, high};
  }

  void stand(PlanCanvas& canvas, const Placed& p) const {
    canvas.stand_at(origin_ + p.at * style_.px_per_m, p.turn);
  }

  void floors(PlanCanvas& canvas, const Wing& wing) {
    if (style_.room_colours == 0) return;
    const cv::Scalar one = bright_colour(chance_);
    const double strength = style_.room_colours >= 3 ? chance_.between(0.5, 1) : chance_.between(0.05, 0.5);
    for (const Box& room : wing.rooms) {
      if (chance_.one_in(0.15)) continue;
      const cv::Scalar colour = style_.room_colours % 2 == 0 ? one : bright_colour(chance_);
      canvas.fill(room, blend(style_.ground, chance_.one_in(0.2) ? cv::Scalar::all(128) : colour, strength));
    }
  }

  [[nodiscard]] bool is_thick(const PlanWall& wall) const {
    return style_.body != Body::Single && (wall.outer || !style_.single_inner());
  }

  /// Squares on a grid, part of the walls.
  void columns(PlanCanvas& canvas, const Wing& wing) {
    if (style_.columns == 0) return;
    const double step = chance_.between(3.5, 9),
                 size = std::max(chance_.between(0.25, 0.7), 5 / style_.px_per_m);
    for (double x = step / 2; x < wing.width; x += step)
      for (double y = step / 2; y < wing.height; y += step) {
        const Box q(x - size / 2, y - size / 2, size, size);
        if (style_.columns == 1) canvas.fill(q, style_.wall);
        canvas.box(q, style_.wall, style_.thing_pen);
        if (style_.columns == 3) canvas.line(q.tl(), q.br(), style_.wall, style_.thin_pen);
        const auto p = PlanCanvas::corners(q);
        for (std::size_t k = 0; k < 4; ++k) canvas.truth_line(p[k], p[(k + 1) % 4]);
      }
  }

  void light_walls(PlanCanvas& canvas) {
    for (const Placed& p : wings_) {
      stand(canvas, p);
      for (const PlanWall& wall : p.wing.walls)
        if (wall.light) thick(canvas, wall);
      for (const Box& room : p.wing.rooms) partition(canvas, style_, room, chance_);
    }
    canvas.draw_bodies(*style_.light);
  }

  [[nodiscard]] double half_of(const PlanWall& wall) const {
    return 0.5 * (wall.light ? style_.light->thickness_m : wall.outer ? style_.outer_m : style_.inner_m);
  }
  [[nodiscard]] static std::vector<Point> strip(Point a, Point b, double half) {
    const Point d = (b - a) / cv::norm(b - a), n(-d.y * half, d.x * half);
    return {a + n, b + n, b - n, a - n};
  }
  /// The outline runs along windows where walls are outlined; where they are filled the window is a gap.
  [[nodiscard]] bool gap(const Opening& o) const {
    return !o.window || style_.body == Body::Filled || style_.body == Body::MixedFilled ||
           style_.body == Body::Hatched;
  }

  void thick(PlanCanvas& canvas, const PlanWall& wall) const {
    const double t = half_of(wall);
    double from = -t;
    const auto piece = [&](double to) {
      if (to > from + 0.02) canvas.wall_body(strip(wall.at(from), wall.at(to), t), false);
    };
    for (const Opening& o : wall.openings) {
      if (!gap(o)) continue;
      piece(o.from);
      from = o.to;
    }
    piece(wall.length() + t);
  }

  void thin(PlanCanvas& canvas, const PlanWall& wall) const {
    double from = 0;
    for (const Opening& o : wall.openings) {
      if (o.window) continue;
      canvas.wall_line(wall.at(from), wall.at(o.from), style_.wall, style_.wall_pen);
      from = o.to;
    }
    canvas.wall_line(wall.at(from), wall.b, style_.wall, style_.wall_pen);
  }

  void openings(PlanCanvas& canvas, const PlanWall& wall) {
    for (const Opening& o : wall.openings) o.window ? window(canvas, wall, o) : door(canvas, wall, o);
  }

  void window(PlanCanvas& canvas, const PlanWall& wall, const Opening& o) const {
    const Point a = wall.at(o.from), b = wall.at(o.to), d = (b - a) / cv::norm(b - a), n(-d.y, d.x);
    const double t = is_thick(wall) ? half_of(wall) : 3 / style_.px_per_m;
    const int lines = style_.window_lines;
    for (int k = 0; k < lines; ++k) {
      const double off = lines == 1 ? 0 : t * (2.0 * k / (lines - 1) - 1) * (gap(o) ? 0.95 : 0.5);
      canvas.line(a + n * off, b + n * off, style_.window, style_.thin_pen);
    }
    if (style_.door_kind % 2 == 0)
      for (const Point& p : {a, b}) canvas.line(p - n * t, p + n * t, style_.window, style_.thin_pen);
  }

  void door(PlanCanvas& canvas, const PlanWall& wall, const Opening& o) {
    const double width = o.to - o.from, side = chance_.one_in(0.5) ? 1 : -1;
    Point hinge = wall.at(o.from), far = wall.at(o.to);
    if (chance_.one_in(0.5)) std::swap(hinge, far);
    const Point along = (far - hinge) / width, n = Point(-along.y, along.x) * side;
    const auto leaf = [&](Point at, Point to, double size) {
      canvas.line(at, at + n * size, style_.door, style_.thing_pen);
      if (style_.door_kind == 1)
        canvas.line(at + to * 0.06, at + to * 0.06 + n * size, style_.door, style_.thing_pen);
      if (style_.door_kind == 4) return;
      const double from = std::atan2(to.y, to.x);
      double turn = std::atan2(n.y, n.x) - from;
      turn = std::remainder(turn, 2 * std::numbers::pi);
      canvas.arc(at, {size, size}, from, from + turn, style_.door, style_.thin_pen);
    };
    if (width > 1.3 && chance_.one_in(0.4)) {  // two leaves that slide, closed
      const double t = half_of(wall) * chance_.between(0.2, 0.7);
      for (const double from : {0.0, 0.5})
        canvas.lines(strip(hinge + from * (far - hinge), hinge + (from + 0.5) * (far - hinge), t), true,
                     style_.door, style_.thin_pen);
      return;
    }
    switch (style_.door_kind) {
      case 0:
      case 1:
      case 4:
        if (width > 1.3) {
          leaf(hinge, along, width / 2);
          leaf(far, -along, width / 2);
        } else {
          leaf(hinge, along, width);
        }
        break;
      case 2:
        canvas.line(hinge, far, style_.door, style_.thin_pen);
        break;
      case 3:
        canvas.lines(strip(hinge, far, 0.5 * half_of(wall)), true, style_.door, style_.thin_pen);
        break;
      case 5:
        canvas.line(hinge, hinge + (along + n) * 0.7 * width, style_.door, style_.thing_pen);
        break;
      default:
        break;
    }
  }

  Chance chance_;
  PlanStyle style_;
  std::vector<Placed> wings_;
  Point origin_;
  cv::Size2d sheet_;
};

}  // namespace

int main(int count, char** words) {
  std::string folder;
  unsigned first = 1, plans = 0;
  PlanStyle (*style)(Chance&) = random_style;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--plans" && i + 1 < count) {
      plans = static_cast<unsigned>(std::stoul(words[++i]));
    } else if (word == "--first-seed" && i + 1 < count) {
      first = static_cast<unsigned>(std::stoul(words[++i]));
    } else if (word == "--sketches") {
      style = random_sketch;
    } else if (word == "--factories") {
      style = random_factory;
    } else {
      folder = word;
    }
  }
  if (folder.empty() || plans == 0) {
    std::fprintf(stderr, "draughtsman FOLDER --plans N [--first-seed S] [--sketches | --factories]\n");
    return 2;
  }
  std::filesystem::create_directories(folder);
  std::ofstream list(folder + "/list.csv");
  list << "name,source,weight,drawing,walls,tolerance_px,truth,ignore\n";
  for (unsigned seed = first; seed < first + plans; ++seed) {
    Plan plan(seed, style);
    const std::string stem = folder + "/plan_" + std::to_string(seed);
    std::vector<std::pair<Point, Point>> truth;
    cv::imwrite(stem + ".png", plan.draw(truth));
    std::ofstream walls(stem + ".csv");
    walls << "u1,v1,u2,v2\n";
    for (const auto& [a, b] : truth) walls << a.x << ',' << a.y << ',' << b.x << ',' << b.y << '\n';
    list << "plan_" << seed << ",synthetic,0.3," << stem << ".png," << stem << ".csv," << plan.tolerance()
         << ",faces,\n";
  }
  return 0;
}
