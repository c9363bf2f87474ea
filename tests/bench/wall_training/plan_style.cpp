#include "tests/bench/wall_training/plan_style.hpp"

#include <algorithm>

namespace madori::training {
namespace {

/// Paper, a screen, a blueprint.
cv::Scalar random_ground(Chance& chance) {
  const double kind = chance.between(0, 1);
  if (kind < 0.62) return cv::Scalar::all(255);
  if (kind < 0.72) return cv::Scalar::all(chance.between(195, 250));
  if (kind < 0.78) return blend(cv::Scalar::all(255), bright_colour(chance), chance.between(0.05, 0.3));
  if (kind < 0.85) return cv::Scalar::all(chance.between(50, 130));
  if (kind < 0.94) return cv::Scalar::all(chance.between(0, 45));
  return {chance.between(90, 170), chance.between(30, 90), chance.between(10, 50)};
}

/// Something that stands out from the ground: full contrast, a grey, or a colour.
cv::Scalar ink(Chance& chance, const cv::Scalar& ground, bool dark, double palest) {
  const cv::Scalar full = dark ? cv::Scalar::all(255) : cv::Scalar::all(0);
  const double kind = chance.between(0, 1);
  if (kind < 0.5) return full;
  if (kind < 0.78) return blend(full, ground, chance.between(0.1, palest));
  return blend(blend(bright_colour(chance), full, chance.between(0, 0.5)), ground,
               chance.between(0, 0.5 * palest));
}

void choose_colours(PlanStyle& s, Chance& chance) {
  s.ground = random_ground(chance);
  const bool dark = s.dark();
  const auto layer = [&](double same, double palest) {
    return chance.one_in(same) ? s.wall : ink(chance, s.ground, dark, palest);
  };
  s.wall = ink(chance, s.ground, dark, 0.75);
  if (dark && s.body == Body::Filled && s.ground[0] > 45 && chance.one_in(0.5)) s.wall = cv::Scalar::all(0);
  s.outline = layer(0.7, 0.6);
  s.wall_fill = s.body == Body::Filled || s.body == Body::MixedFilled
                    ? s.wall
                    : blend(s.ground, ink(chance, s.ground, dark, 0.6), chance.between(0.15, 0.7));
  s.thing = layer(0.45, 0.8);
  s.thing_fill =
      chance.one_in(0.5) ? blend(s.ground, s.thing, chance.between(0.1, 0.7)) : bright_colour(chance);
  s.door = chance.one_in(0.6) ? s.thing : layer(0.5, 0.7);
  s.window = layer(0.6, 0.7);
  s.text = layer(0.5, 0.6);
  s.dimension = layer(0.4, 0.7);
  s.grid = chance.one_in(0.3) ? bright_colour(chance) : layer(0.3, 0.85);
}

void choose_pens(PlanStyle& s, Chance& chance) {
  const double pen = chance.scaled(0.7, 2.4);
  const bool by_line = s.body == Body::Single || s.body == Body::MixedFilled || s.body == Body::MixedDouble;
  s.wall_pen = pen * (chance.one_in(0.5) ? 1 : chance.between(1.2, 3));
  if (by_line) s.wall_pen = chance.one_in(0.5) ? pen * chance.between(1, 2) : chance.between(2, 9);
  s.thing_pen = std::max(0.5, pen * (chance.one_in(0.5) ? 1 : chance.between(0.5, 1.3)));
  s.thin_pen = std::max(0.5, s.thing_pen * (chance.one_in(0.5) ? 1 : 0.6));
  s.outer_m = chance.scaled(0.2, 0.6);
  s.inner_m = s.outer_m * chance.between(0.3, 1);
  s.text_px = chance.scaled(7, 22);
}

void choose_contents(PlanStyle& s, Chance& chance) {
  const auto share = [&](double p, double least, double most) {
    return chance.one_in(p) ? chance.between(least, most) : 0;
  };
  s.furniture = share(0.75, 0.15, 1);
  s.labels = share(0.8, 0.3, 1);
  s.windows = share(0.6, 0.2, 1);
  s.filled_things = share(0.5, 0.1, 0.8);
  s.window_lines = 1 + chance.below(4);
  s.door_kind = chance.below(7);
  s.columns = chance.one_in(s.building == Building::Flat ? 0.05 : 0.4) ? 1 + chance.below(3) : 0;
  s.room_colours = chance.one_in(s.body == Body::Single ? 0.5 : 0.35) ? 1 + chance.below(4) : 0;
  s.dimensions = share(0.35, 0.3, 1);
  s.axes = share(0.3, 0.3, 1);
  s.frame = share(0.2, 1, 2);
  s.title = share(0.3, 1, 2);
  s.outdoors = share(0.3, 0.3, 1);
  s.routes = share(0.12, 0.3, 1);
  s.tiles = share(0.15, 0.2, 0.6);
  s.ceiling = share(0.1, 0.3, 1);
  s.zones = share(0.15, 0.5, 1);
  s.scale_bar = share(0.2, 0.5, 1);
}

void choose_copying(PlanStyle& s, Chance& chance) {
  s.turn_rad = chance.one_in(0.65)  ? 0
               : chance.one_in(0.5) ? chance.between(-0.06, 0.06)
                                    : chance.between(-0.8, 0.8);
  s.aliased = chance.one_in(0.15);
  s.blur_px = chance.one_in(0.3) ? chance.between(0.4, 1.1) : 0;
  s.noise = chance.one_in(0.15) ? chance.between(1, 7) : 0;
  s.shade = chance.one_in(0.12) ? chance.between(0.1, 0.4) : 0;
  s.fold = chance.one_in(0.06) ? 1 : 0;
  s.jpeg = chance.one_in(0.45) ? 45 + chance.below(50) : 0;
}

/// One pen and one ink for everything, as on a plan from a single layer.
void draw_all_alike(PlanStyle& s) {
  s.thing = s.door = s.window = s.text = s.dimension = s.grid = s.outline = s.wall;
  s.thing_pen = s.thin_pen = s.text_pen = s.wall_pen = std::min(s.wall_pen, 2.5);
}

}  // namespace

cv::Scalar blend(const cv::Scalar& a, const cv::Scalar& b, double t) {
  return a * (1 - t) + b * t;
}

cv::Scalar bright_colour(Chance& chance) {
  cv::Scalar colour(chance.between(0, 255), chance.between(0, 255), chance.between(0, 255));
  colour[chance.below(3)] = 255;
  colour[chance.below(3)] = chance.between(0, 60);
  return colour;
}

PlanStyle random_style(Chance& chance) {
  PlanStyle s;
  const double kind = chance.between(0, 1);
  s.building = kind < 0.33   ? Building::Flat
               : kind < 0.72 ? Building::Office
               : kind < 0.9  ? Building::Hall
                             : Building::Warehouse;
  const double body = chance.between(0, 1);
  s.body = body < 0.2    ? Body::Single
           : body < 0.42 ? Body::Double
           : body < 0.64 ? Body::Filled
           : body < 0.72 ? Body::Hatched
           : body < 0.86 ? Body::FilledOutlined
           : body < 0.94 ? Body::MixedFilled
                         : Body::MixedDouble;
  choose_colours(s, chance);
  choose_pens(s, chance);
  choose_contents(s, chance);
  choose_copying(s, chance);
  if (chance.one_in(0.2)) draw_all_alike(s);
  return s;
}

PlanStyle random_sketch(Chance& chance) {
  PlanStyle s = random_style(chance);
  s.building = chance.one_in(0.5) ? Building::Flat : Building::Office;
  s.few_rooms = true;
  if (chance.one_in(0.7)) draw_all_alike(s);
  s.furniture = chance.between(0, 0.3);
  s.labels = chance.between(0, 1);
  s.overhead = chance.between(0, 0.8);
  s.windows *= 0.3;
  s.columns = s.room_colours = 0;
  s.axes = s.frame = s.title = s.outdoors = s.tiles = s.ceiling = s.zones = 0;
  s.dimensions *= 0.3;
  return s;
}

PlanStyle random_factory(Chance& chance) {
  PlanStyle s = random_style(chance);
  s.building = chance.one_in(0.6)   ? Building::Hall
               : chance.one_in(0.5) ? Building::Warehouse
                                    : Building::Office;
  s.body = chance.of<Body>({Body::Hatched, Body::Hatched, Body::FilledOutlined, Body::Double, Body::Filled});
  if (s.body == Body::Filled) s.wall_fill = s.wall;
  s.wall_pen = std::min(s.wall_pen, 3.0);
  s.room_colours = chance.one_in(0.2) ? 1 : 0;
  s.dimensions = chance.between(0, 1.5);
  s.axes = chance.between(0, 1.5);
  s.frame = chance.between(0.5, 3);
  s.title = 1;
  if (chance.one_in(0.5)) s.turn_rad = chance.between(-0.05, 0.05);
  LightWalls light;
  light.body = chance.of<Body>({Body::Double, Body::Double, Body::FilledOutlined, Body::Filled});
  light.outline = chance.one_in(0.5) ? s.outline : blend(s.outline, s.ground, chance.between(0.1, 0.6));
  light.fill =
      light.body == Body::Filled ? light.outline : blend(s.ground, light.outline, chance.between(0.1, 0.6));
  light.pen = s.wall_pen * chance.between(0.4, 1);
  light.thickness_m = chance.between(0.06, 0.2);
  s.light = light;
  return s;
}

}  // namespace madori::training
