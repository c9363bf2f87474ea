// Draws plans in many styles, their walls known: what the wall model is trained on beside real drawings.
//   draughtsman FOLDER --plans N [--first-seed S]
// writes FOLDER/plan_SEED.png, plan_SEED.csv (u1,v1,u2,v2) and FOLDER/list.csv (the rows that train_walls
// reads). A seed is a plan: the same seed draws the same picture.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <string>
#include <vector>

namespace {

using Random = std::mt19937;
constexpr int kFine = 3;  // the picture is drawn finer and reduced, as a plotter's lines are

double uniform(Random& random, double a, double b) {
  return a + (b - a) * static_cast<double>(random() >> 5) / 134217728.0;
}
bool chance(Random& random, double p) {
  return uniform(random, 0, 1) < p;
}
int pick(Random& random, int count) {
  return static_cast<int>(uniform(random, 0, count));
}

struct Wall {
  cv::Point2d a, b;
  bool outer = false;
};
struct Door {
  cv::Point2d at, along;
  double width = 0;
};

enum class Body { Single, Double, Filled, Hatched, GreyOutlined, Mixed, FilledOutside };

struct Style {
  Body body = Body::Double;
  int ground = 255, wall = 0, pen_grey = 0, thing_grey = 0, fill = 0, text_grey = 0;
  double pen = 1.5, wall_pen = 1.5, outer = 10, inner = 6, thing_pen = 1, text = 0.5;
  double furniture = 0, racks = 0, labels = 0, windows = 0, doors = 0.7, tiles = 0;
  bool dimensions = false, axes = false, frame = false, stairs = false, rooms_filled = false, routes = false,
       solid_axes = false;
  double turn = 0;
};

Style random_style(Random& r) {
  Style s;
  s.body = static_cast<Body>(pick(r, 7));
  const int paper = pick(r, 10);
  s.ground = paper < 6    ? 255
             : paper < 7  ? 200 + pick(r, 55)
             : paper == 7 ? 60
             : paper == 8 ? pick(r, 40)
                          : 230;
  const bool dark = s.ground < 120;
  const auto ink = [&](double most) {
    const double level = uniform(r, 0, 1) < 0.6 ? 0.0 : uniform(r, 0, most);
    return static_cast<int>(dark ? std::min(255.0, 255 - level * (200 - s.ground)) : level * s.ground);
  };
  s.wall = ink(0.75);
  s.pen_grey = chance(r, 0.6) ? s.wall : ink(0.7);
  s.thing_grey = chance(r, 0.5) ? s.wall : ink(0.8);
  s.text_grey = chance(r, 0.6) ? ink(0) : s.thing_grey;
  if (dark && chance(r, 0.5) && s.body != Body::Single) s.wall = 0;  // black poche on a grey ground
  s.fill = static_cast<int>(std::lerp(s.ground, s.wall, uniform(r, 0.2, 0.7)));
  s.pen = uniform(r, 0.8, 2.2);
  s.wall_pen = s.pen * (chance(r, 0.5) ? 1 : uniform(r, 1.2, 3));
  if (s.body == Body::Single) s.wall_pen = chance(r, 0.6) ? s.pen * uniform(r, 1, 2) : uniform(r, 2, 8);
  s.thing_pen = chance(r, 0.6) ? s.pen : s.pen * uniform(r, 0.5, 1.2);
  s.outer = uniform(r, 5, 22);
  s.inner = std::max(4.0, s.outer * uniform(r, 0.4, 1));
  s.text = uniform(r, 0.3, 0.7);
  s.furniture = chance(r, 0.75) ? uniform(r, 0.2, 1) : 0;
  s.racks = chance(r, 0.2) ? uniform(r, 0.3, 1) : 0;
  s.labels = chance(r, 0.75) ? uniform(r, 0.3, 1) : 0;
  s.windows = chance(r, 0.5) ? uniform(r, 0.2, 0.9) : 0;
  s.doors = uniform(r, 0.3, 1);
  s.tiles = chance(r, 0.15) ? 0.4 : 0;
  s.dimensions = chance(r, 0.3);
  s.axes = chance(r, 0.2);
  s.solid_axes = chance(r, 0.5);
  s.frame = chance(r, 0.2);
  s.stairs = chance(r, 0.4);
  s.rooms_filled = chance(r, 0.3);
  s.routes = chance(r, 0.12);
  s.turn = chance(r, 0.6) ? 0 : chance(r, 0.5) ? uniform(r, -0.05, 0.05) : uniform(r, -0.8, 0.8);
  return s;
}

class Plan {
 public:
  Plan(Random& random, const Style& style) : r_(random), s_(style) {
    const double size = uniform(r_, 420, 1250), shape = uniform(r_, 0.5, 1);
    width_ = chance(r_, 0.5) ? size : size * shape;
    height_ = width_ == size ? size * shape : size;
    margin_ = uniform(r_, 20, 90) + (s_.dimensions ? 50 : 0);
    box_ = {margin_, margin_, width_, height_};
    const double reach = 0.5 * std::hypot(width_, height_);
    const bool turned = std::abs(s_.turn) > 0.1;
    sheet_ = turned ? cv::Size2d(2 * (reach + margin_ / 2), 2 * (reach + margin_ / 2))
                    : cv::Size2d(width_ + 2 * margin_, height_ + 2 * margin_);
    shift_ = cv::Point2d(sheet_.width / 2 - box_.x - width_ / 2, sheet_.height / 2 - box_.y - height_ / 2);
    picture_ = cv::Mat(fine(sheet_.height), fine(sheet_.width), CV_8UC1, cv::Scalar(s_.ground));
    least_room_ = uniform(r_, 60, 130);
  }

  cv::Mat draw() {
    split({box_.x, box_.y, box_.width, box_.height}, 0);
    outside();
    if (s_.rooms_filled)
      for (const auto& room : rooms_) fill_room(room);
    if (s_.axes) axes();
    for (const auto& room : rooms_) furnish(room);
    walls();
    doors();
    if (s_.dimensions) dimensions();
    if (s_.frame)
      rectangle({6, 6, box_.width + 2 * margin_ - 12, box_.height + 2 * margin_ - 12}, s_.pen_grey, s_.pen);
    if (s_.routes) routes();
    return finish();
  }

  [[nodiscard]] const std::vector<std::pair<cv::Point2d, cv::Point2d>>& truth() const { return truth_; }
  [[nodiscard]] double tolerance() const {
    return std::max(3.0, s_.body == Body::Single ? 0.5 * s_.wall_pen + 2.5 : 3.0);
  }

 private:
  static int fine(double px) { return std::max(1, static_cast<int>(std::lround(px * kFine))); }
  /// From the plan to the sheet.
  [[nodiscard]] cv::Point2d placed(cv::Point2d p) const {
    const cv::Point2d m(box_.x + box_.width / 2, box_.y + box_.height / 2), d = p - m;
    const double c = std::cos(s_.turn), n = std::sin(s_.turn);
    return m + cv::Point2d(c * d.x - n * d.y, n * d.x + c * d.y) + shift_;
  }
  [[nodiscard]] cv::Point on_sheet(cv::Point2d p) const {
    p = placed(p);
    return {static_cast<int>(std::lround(p.x * kFine)), static_cast<int>(std::lround(p.y * kFine))};
  }
  void line(cv::Point2d a, cv::Point2d b, int grey, double pen) {
    cv::line(picture_, on_sheet(a), on_sheet(b), cv::Scalar(grey), fine(pen));
  }
  void rectangle(cv::Rect2d q, int grey, double pen) {
    const std::vector<cv::Point2d> p{
        {q.x, q.y}, {q.x + q.width, q.y}, {q.x + q.width, q.y + q.height}, {q.x, q.y + q.height}};
    for (std::size_t k = 0; k < 4; ++k) line(p[k], p[(k + 1) % 4], grey, pen);
  }
  void fill(cv::Rect2d q, int grey) {
    const std::vector<cv::Point> p{on_sheet({q.x, q.y}), on_sheet({q.x + q.width, q.y}),
                                   on_sheet({q.x + q.width, q.y + q.height}),
                                   on_sheet({q.x, q.y + q.height})};
    cv::fillConvexPoly(picture_, p, cv::Scalar(grey));
  }
  void dashed(cv::Point2d a, cv::Point2d b, int grey, double pen, double dash) {
    const double length = cv::norm(b - a);
    for (double at = 0; at < length; at += 1.7 * dash)
      line(a + (b - a) * (at / length), a + (b - a) * (std::min(length, at + dash) / length), grey, pen);
  }
  void text(cv::Point2d at, const std::string& words, double size) {
    cv::putText(picture_, words, on_sheet(at), pick(r_, 8), size * kFine, cv::Scalar(s_.text_grey),
                std::max(1, fine(size * 1.6)), cv::LINE_AA);
  }

  /// Rooms by splitting; each split is a wall with a door in it.
  void split(cv::Rect2d q, int depth) {
    const bool wide = q.width > q.height;
    const double side = wide ? q.width : q.height;
    if (side < 2 * least_room_ || depth > 6 || (depth > 2 && chance(r_, 0.12))) {
      rooms_.push_back(q);
      return;
    }
    if (depth == 0 && chance(r_, 0.5)) return corridor(q, wide);
    const double at = std::round(side * uniform(r_, 0.35, 0.65));
    const cv::Rect2d first = wide ? cv::Rect2d(q.x, q.y, at, q.height) : cv::Rect2d(q.x, q.y, q.width, at);
    const cv::Rect2d second = wide ? cv::Rect2d(q.x + at, q.y, q.width - at, q.height)
                                   : cv::Rect2d(q.x, q.y + at, q.width, q.height - at);
    wall_with_door(cv::Point2d(second.x, second.y),
                   wide ? cv::Point2d(second.x, q.y + q.height) : cv::Point2d(q.x + q.width, second.y));
    split(first, depth + 1);
    split(second, depth + 1);
  }
  void corridor(cv::Rect2d q, bool wide) {
    const double hall = uniform(r_, 25, 50), at = (wide ? q.height : q.width) * uniform(r_, 0.35, 0.6);
    for (const double offset : {at, at + hall}) {
      const double length = wide ? q.width : q.height;
      const double step = uniform(r_, 70, 150);
      for (double from = 0; from < length - 1; from += step) {
        const double to = from + step > length - 30 ? length : from + step;
        wall_with_door(wide ? cv::Point2d(q.x + from, q.y + offset) : cv::Point2d(q.x + offset, q.y + from),
                       wide ? cv::Point2d(q.x + to, q.y + offset) : cv::Point2d(q.x + offset, q.y + to));
        if (to < length) {  // the walls between the rooms along it
          const bool low = offset == at;
          const double a = low ? 0 : offset, b = low ? offset : (wide ? q.height : q.width);
          walls_.push_back({wide ? cv::Point2d(q.x + to, q.y + a) : cv::Point2d(q.x + a, q.y + to),
                            wide ? cv::Point2d(q.x + to, q.y + b) : cv::Point2d(q.x + b, q.y + to), false});
        }
        const double a = offset == at ? 0 : offset, b = offset == at ? offset : (wide ? q.height : q.width);
        rooms_.push_back(wide ? cv::Rect2d(q.x + from, q.y + a, to - from, b - a)
                              : cv::Rect2d(q.x + a, q.y + from, b - a, to - from));
        if (to == length) break;
      }
    }
  }
  void wall_with_door(cv::Point2d a, cv::Point2d b, bool outer = false) {
    const double length = cv::norm(b - a);
    const cv::Point2d along = (b - a) / length;
    const double door = uniform(r_, 14, 30);
    if (length > 3 * door && chance(r_, s_.doors)) {
      const double at = uniform(r_, 0.15, 0.85 - door / length) * length;
      walls_.push_back({a, a + along * at, outer});
      walls_.push_back({a + along * (at + door), b, outer});
      doors_.push_back({a + along * at, along, door});
    } else {
      walls_.push_back({a, b, outer});
    }
  }
  void outside() {
    const std::vector<cv::Point2d> p{{box_.x, box_.y},
                                     {box_.x + box_.width, box_.y},
                                     {box_.x + box_.width, box_.y + box_.height},
                                     {box_.x, box_.y + box_.height}};
    for (std::size_t k = 0; k < 4; ++k) wall_with_door(p[k], p[(k + 1) % 4], true);
    if (chance(r_, 0.3)) {  // a slanted or round part
      const cv::Point2d m(box_.x + box_.width * 0.5, box_.y + box_.height * 0.5);
      const double reach = 0.2 * std::min(box_.width, box_.height);
      if (chance(r_, 0.5)) {
        walls_.push_back({m - cv::Point2d(reach, reach), m + cv::Point2d(reach, reach * 0.4), false});
      } else {
        cv::Point2d last = m + cv::Point2d(reach, 0);
        for (int k = 1; k <= 10; ++k) {
          const double angle = 0.12 * k * std::numbers::pi;
          const cv::Point2d next = m + reach * cv::Point2d(std::cos(angle), std::sin(angle));
          walls_.push_back({last, next, false});
          last = next;
        }
      }
    }
  }

  void fill_room(cv::Rect2d q) {
    fill(q, static_cast<int>(std::lerp(s_.ground, s_.ground > 120 ? 80 : 160, uniform(r_, 0, 0.7))));
  }

  void walls() {
    if (s_.body == Body::Single) {
      for (const Wall& w : walls_) single(w);
      return;
    }
    cv::Mat body(picture_.size(), CV_8UC1, cv::Scalar(0));
    for (const Wall& w : walls_)
      if (s_.body != Body::Mixed || w.outer) thick(body, w);
    if (s_.body == Body::Hatched || s_.body == Body::GreyOutlined || s_.body == Body::Mixed ||
        s_.body == Body::Filled || s_.body == Body::FilledOutside)
      fill_body(body);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(body, outlines, cv::RETR_LIST, cv::CHAIN_APPROX_SIMPLE);
    const bool outlined =
        s_.body == Body::Double || s_.body == Body::Hatched || s_.body == Body::GreyOutlined;
    for (auto& outline : outlines) {
      std::vector<cv::Point> corners;
      cv::approxPolyDP(outline, corners, kFine * 0.7, true);
      if (outlined) cv::polylines(picture_, corners, true, cv::Scalar(s_.wall), fine(s_.wall_pen));
      for (std::size_t k = 0; k < corners.size(); ++k)
        truth_.push_back(
            {cv::Point2d(corners[k]) / kFine, cv::Point2d(corners[(k + 1) % corners.size()]) / kFine});
    }
    if (s_.body == Body::Mixed)
      for (const Wall& w : walls_)
        if (!w.outer) single(w);
  }
  void single(const Wall& w) {
    line(w.a, w.b, s_.wall, s_.wall_pen);
    truth_.push_back({placed(w.a), placed(w.b)});
  }
  void thick(cv::Mat& body, const Wall& w) {
    const double t = 0.5 * (w.outer ? s_.outer : s_.inner), length = cv::norm(w.b - w.a);
    if (length < 1) return;
    const cv::Point2d d = (w.b - w.a) / length, n(-d.y * t, d.x * t);
    const cv::Point2d a = is_jamb(w.a) ? w.a : w.a - d * t, b = is_jamb(w.b) ? w.b : w.b + d * t;
    const std::vector<cv::Point> p{on_sheet(a + n), on_sheet(b + n), on_sheet(b - n), on_sheet(a - n)};
    cv::fillConvexPoly(body, p, cv::Scalar(255));
  }
  [[nodiscard]] bool is_jamb(cv::Point2d p) const {
    return std::any_of(doors_.begin(), doors_.end(), [&](const Door& door) {
      return cv::norm(door.at - p) < 1 || cv::norm(door.at + door.along * door.width - p) < 1;
    });
  }
  void fill_body(const cv::Mat& body) {
    if (s_.body == Body::Hatched) {
      cv::Mat hatch(picture_.size(), CV_8UC1, cv::Scalar(s_.ground));
      const int step = fine(uniform(r_, 3, 8));
      for (int k = -hatch.rows; k < hatch.cols; k += step)
        cv::line(hatch, {k, 0}, {k + hatch.rows, hatch.rows}, cv::Scalar(s_.pen_grey), fine(0.7));
      hatch.copyTo(picture_, body);
    } else {
      picture_.setTo(cv::Scalar(s_.body == Body::GreyOutlined ? s_.fill : s_.wall), body);
    }
  }

  void doors() {
    const int kind = pick(r_, 4);
    for (const Door& door : doors_) {
      const cv::Point2d n(-door.along.y, door.along.x), far = door.at + door.along * door.width;
      if (kind == 0 || kind == 1) {  // leaf and swing
        line(door.at, door.at + n * door.width, s_.thing_grey, s_.thing_pen);
        cv::Point2d last = far;
        for (int k = 1; k <= 8; ++k) {
          const double angle = k * std::numbers::pi / 16;
          const cv::Point2d next =
              door.at + door.width * (door.along * std::cos(angle) + n * std::sin(angle));
          line(last, next, s_.thing_grey, s_.thing_pen);
          last = next;
        }
      } else if (kind == 2) {
        line(door.at, far, s_.thing_grey, s_.thing_pen);
      }
    }
  }

  void furnish(cv::Rect2d q) {
    const double edge = 0.5 * s_.outer + 3;
    const cv::Rect2d in(q.x + edge, q.y + edge, q.width - 2 * edge, q.height - 2 * edge);
    if (in.width < 25 || in.height < 25) return;
    if (s_.tiles > 0 && chance(r_, s_.tiles)) {
      const double step = uniform(r_, 8, 16);
      for (double u = in.x; u < in.x + in.width; u += step)
        line({u, in.y}, {u, in.y + in.height}, s_.thing_grey, 0.6);
      for (double v = in.y; v < in.y + in.height; v += step)
        line({in.x, v}, {in.x + in.width, v}, s_.thing_grey, 0.6);
    }
    if (s_.stairs && chance(r_, 0.12)) return stairs(in);
    if (s_.racks > 0 && chance(r_, s_.racks)) return racks(in);
    const int things = static_cast<int>(s_.furniture * in.area() / 2500);
    for (int k = 0; k < std::min(things, 14); ++k) thing(in);
    if (chance(r_, s_.labels)) {
      static const char* const words[] = {"OFFICE", "Room 12", "Bedroom", "WC",     "STORE 3",
                                          "Hall",   "12.5 m2", "A-104",   "Kitchen"};
      text({in.x + in.width * 0.15, in.y + in.height * 0.5}, words[pick(r_, 9)], s_.text);
      if (chance(r_, 0.4))
        text({in.x + in.width * 0.15, in.y + in.height * 0.5 + 28 * s_.text}, "4.11 x 2.72", s_.text * 0.8);
    }
    if (chance(r_, 0.05)) {  // a void or a lift
      line({in.x, in.y}, {in.x + in.width, in.y + in.height}, s_.thing_grey, s_.thing_pen);
      line({in.x + in.width, in.y}, {in.x, in.y + in.height}, s_.thing_grey, s_.thing_pen);
    }
  }
  void thing(cv::Rect2d in) {
    const double w = uniform(r_, 7, 40), h = uniform(r_, 7, 26);
    if (w + 2 > in.width || h + 2 > in.height) return;
    const bool aside = chance(r_, 0.5);
    const cv::Rect2d q(aside ? in.x : uniform(r_, in.x, in.x + in.width - w),
                       uniform(r_, in.y, in.y + in.height - h), w, h);
    switch (pick(r_, 6)) {
      case 0:
        cv::circle(picture_, on_sheet({q.x + w / 2, q.y + h / 2}), fine(h / 2), cv::Scalar(s_.thing_grey),
                   fine(s_.thing_pen));
        break;
      case 1:  // a desk with its chair
        rectangle(q, s_.thing_grey, s_.thing_pen);
        rectangle({q.x + w / 3, q.y + h + 2, w / 3, 6}, s_.thing_grey, s_.thing_pen);
        break;
      case 2:
        cv::ellipse(picture_, on_sheet({q.x + w / 2, q.y + h / 2}), {fine(w / 2), fine(h / 2)},
                    s_.turn * 57.3, 0, 360, cv::Scalar(s_.thing_grey), fine(s_.thing_pen));
        rectangle(q, s_.thing_grey, s_.thing_pen);
        break;
      case 3:
        fill(q, static_cast<int>(std::lerp(s_.ground, s_.thing_grey, uniform(r_, 0.2, 1))));
        break;
      case 4:
        rectangle(q, s_.thing_grey, s_.thing_pen);
        rectangle({q.x + 2.5, q.y + 2.5, w - 5, h - 5}, s_.thing_grey, s_.thing_pen);
        break;
      default:
        rectangle(q, s_.thing_grey, s_.thing_pen);
    }
  }
  void stairs(cv::Rect2d in) {
    const double w = std::min(in.width, uniform(r_, 20, 45)), step = uniform(r_, 4, 8);
    const double end = in.y + in.height * uniform(r_, 0.5, 1);
    for (double v = in.y; v < end; v += step) line({in.x, v}, {in.x + w, v}, s_.thing_grey, s_.thing_pen);
    line({in.x + w, in.y}, {in.x + w, end}, s_.thing_grey, s_.thing_pen);
    line({in.x + w / 2, in.y + 3}, {in.x + w / 2, end - 3}, s_.thing_grey, s_.thing_pen);
  }
  void racks(cv::Rect2d in) {
    const double w = uniform(r_, 8, 18), h = uniform(r_, 8, 25), aisle = uniform(r_, 12, 30);
    for (double u = in.x + 6; u + 2 * w < in.x + in.width; u += 2 * w + aisle)
      for (double v = in.y + 6; v + h < in.y + in.height - 4; v += h)
        for (const double side : {0.0, w}) {
          if (chance(r_, 0.03)) fill({u + side, v, w, h}, s_.thing_grey);
          rectangle({u + side, v, w, h}, s_.thing_grey, s_.thing_pen);
        }
  }
  void axes() {
    for (double u = box_.x + uniform(r_, 0, 40); u < box_.x + box_.width; u += uniform(r_, 60, 160))
      axis({u, box_.y - 30}, {u, box_.y + box_.height + 30});
    for (double v = box_.y + uniform(r_, 0, 40); v < box_.y + box_.height; v += uniform(r_, 60, 160))
      axis({box_.x - 30, v}, {box_.x + box_.width + 30, v});
  }
  void axis(cv::Point2d a, cv::Point2d b) {
    if (s_.solid_axes) {
      line(a, b, s_.thing_grey, 0.7 * s_.thing_pen);
    } else {
      dashed(a, b, s_.thing_grey, 0.7 * s_.thing_pen, 12);
    }
    cv::circle(picture_, on_sheet(a), fine(9), cv::Scalar(s_.thing_grey), fine(s_.thing_pen));
    text(a + cv::Point2d(-4, 4), "B", 0.35);
  }
  void dimensions() {
    for (const double off : {22.0, 36.0}) {
      const double v = box_.y - off, u = box_.x - off;
      line({box_.x, v}, {box_.x + box_.width, v}, s_.thing_grey, s_.thing_pen);
      line({u, box_.y}, {u, box_.y + box_.height}, s_.thing_grey, s_.thing_pen);
      for (double at = 0; at < box_.width; at += uniform(r_, 40, 160)) {
        line({box_.x + at - 3, v + 3}, {box_.x + at + 3, v - 3}, s_.thing_grey, s_.thing_pen);
        line({box_.x + at, v - 5}, {box_.x + at, box_.y - 8}, s_.thing_grey, s_.thing_pen);
        text({box_.x + at + 12, v - 3}, std::to_string(1000 + pick(r_, 8000)), 0.3);
      }
      for (double at = 0; at < box_.height; at += uniform(r_, 40, 160))
        line({u - 3, box_.y + at + 3}, {u + 3, box_.y + at - 3}, s_.thing_grey, s_.thing_pen);
    }
  }
  void routes() {
    cv::Point2d last(box_.x + 20, box_.y + box_.height / 2);
    for (int k = 0; k < 6; ++k) {
      const cv::Point2d next = k % 2 == 0 ? cv::Point2d(uniform(r_, box_.x, box_.x + box_.width), last.y)
                                          : cv::Point2d(last.x, uniform(r_, box_.y, box_.y + box_.height));
      dashed(last, next, s_.thing_grey, s_.pen, 6);
      last = next;
    }
  }

  /// Reduced to the sheet's pixels, with what a scanner and a codec do to it.
  cv::Mat finish() {
    cv::Mat out;
    cv::resize(picture_, out, {static_cast<int>(sheet_.width), static_cast<int>(sheet_.height)}, 0, 0,
               cv::INTER_AREA);
    if (chance(r_, 0.25)) cv::GaussianBlur(out, out, {}, uniform(r_, 0.4, 0.9));
    if (chance(r_, 0.2)) {
      const double a = uniform(r_, 0.75, 1), b = uniform(r_, 0.75, 1), noise = uniform(r_, 0, 6);
      for (int v = 0; v < out.rows; ++v)
        for (int u = 0; u < out.cols; ++u)
          out.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
              out.at<std::uint8_t>(v, u) * std::lerp(a, b, static_cast<double>(u) / out.cols) +
              uniform(r_, -noise, noise));
    }
    if (chance(r_, 0.4)) {
      std::vector<std::uint8_t> bytes;
      cv::imencode(".jpg", out, bytes, {cv::IMWRITE_JPEG_QUALITY, 50 + pick(r_, 45)});
      out = cv::imdecode(bytes, cv::IMREAD_GRAYSCALE);
    }
    return out;
  }

  Random& r_;
  Style s_;
  double width_ = 0, height_ = 0, margin_ = 0, least_room_ = 80;
  cv::Rect2d box_;
  cv::Size2d sheet_;
  cv::Point2d shift_;
  cv::Mat picture_;
  std::vector<cv::Rect2d> rooms_;
  std::vector<Wall> walls_;
  std::vector<Door> doors_;
  std::vector<std::pair<cv::Point2d, cv::Point2d>> truth_;
};

}  // namespace

int main(int count, char** words) {
  std::string folder;
  unsigned first = 1, plans = 0;
  for (int i = 1; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--plans" && i + 1 < count) {
      plans = static_cast<unsigned>(std::stoul(words[++i]));
    } else if (word == "--first-seed" && i + 1 < count) {
      first = static_cast<unsigned>(std::stoul(words[++i]));
    } else {
      folder = word;
    }
  }
  if (folder.empty() || plans == 0) {
    std::fprintf(stderr, "draughtsman FOLDER --plans N [--first-seed S]\n");
    return 2;
  }
  std::filesystem::create_directories(folder);
  std::ofstream list(folder + "/list.csv");
  list << "name,source,weight,drawing,walls,tolerance_px,truth,ignore\n";
  for (unsigned seed = first; seed < first + plans; ++seed) {
    Random random(seed);
    Plan plan(random, random_style(random));
    const std::string stem = folder + "/plan_" + std::to_string(seed);
    cv::imwrite(stem + ".png", plan.draw());
    std::ofstream truth(stem + ".csv");
    truth << "u1,v1,u2,v2\n";
    for (const auto& [a, b] : plan.truth()) truth << a.x << ',' << a.y << ',' << b.x << ',' << b.y << '\n';
    list << "plan_" << seed << ",synthetic,0.3," << stem << ".png," << stem << ".csv," << plan.tolerance()
         << ",faces,\n";
  }
  return 0;
}
