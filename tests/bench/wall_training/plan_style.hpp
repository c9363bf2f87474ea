#pragma once

#include <opencv2/core.hpp>
#include <optional>

#include "tests/bench/wall_training/chance.hpp"

namespace madori::training {

enum class Building { Flat, Office, Hall, Warehouse };
/// How walls are drawn. Mixed: outer walls thick, inner ones single lines.
enum class Body { Single, Double, Filled, Hatched, FilledOutlined, MixedFilled, MixedDouble };

/// How light walls of a factory are drawn beside its masonry: those of inner rooms, cabins, screens.
struct LightWalls {
  Body body = Body::Double;
  cv::Scalar fill, outline;
  double pen = 1, thickness_m = 0.1;
};

/// How a draughtsman draws a plan: pens in pixels of the sheet, lengths in metres, colours blue-green-red.
struct PlanStyle {
  Building building = Building::Office;
  Body body = Body::Double;
  double px_per_m = 20;
  cv::Scalar ground, wall, wall_fill, outline, thing, thing_fill, text, dimension, grid, door, window;
  double wall_pen = 1.5, thing_pen = 1, thin_pen = 1, text_pen = 0,
         text_px = 12;  ///< text_pen: 0 = as its height asks for
  double outer_m = 0.4, inner_m = 0.15;
  double furniture = 0.5, labels = 0.5, windows = 0.5, filled_things = 0.2;
  int window_lines = 2, door_kind = 0, columns = 0;  ///< columns: 0 none, 1 filled, 2 open, 3 crossed
  int room_colours = 0;  ///< 0 none, 1 pale each its own, 2 all alike, 3 strong, 4 strong and all alike
  double dimensions = 0, axes = 0, frame = 0, title = 0, outdoors = 0, routes = 0, tiles = 0, ceiling = 0,
         zones = 0, scale_bar = 0;
  double overhead = 0.12;  ///< share of rooms with a dashed line above
  bool few_rooms = false;
  std::optional<LightWalls> light;  ///< a factory's sheet: with a title block, creases, cabins, screens
  double turn_rad = 0;
  bool aliased = false;
  double blur_px = 0, noise = 0, shade = 0, fold = 0;
  int jpeg = 0;  ///< its quality, 0 = none

  [[nodiscard]] bool dark() const { return ground[0] + ground[1] + ground[2] < 380; }
  [[nodiscard]] bool single_inner() const {
    return body == Body::Single || body == Body::MixedFilled || body == Body::MixedDouble;
  }
};

[[nodiscard]] PlanStyle random_style(Chance& chance);
/// A few rooms and hardly anything in them, mostly with a single pen.
[[nodiscard]] PlanStyle random_sketch(Chance& chance);
/// A hall or a works with its offices, on a large sheet with a title block.
[[nodiscard]] PlanStyle random_factory(Chance& chance);
/// A colour between two others.
[[nodiscard]] cv::Scalar blend(const cv::Scalar& a, const cv::Scalar& b, double t);
[[nodiscard]] cv::Scalar bright_colour(Chance& chance);

}  // namespace madori::training
