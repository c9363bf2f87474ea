#include "app/plot/localizability_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/plot/map_canvas.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::app {
namespace {

using localization::Localizability;

constexpr double kFairM = 0.01;  // one scan's sigma in its weakest direction
constexpr double kWeakM = 0.03;
constexpr double kBareM = 0.1;
constexpr double kClearM = 0.3;
constexpr double kMostSquares = 4000.0;
constexpr double kEllipseEveryM = 2.0;
constexpr double kEnlarged = 50.0;
constexpr double kLongestEllipseM = 3.0;

constexpr std::array<Colour, 4> kFloor{Colour{235, 243, 248}, Colour{185, 218, 238}, Colour{246, 217, 150},
                                       Colour{236, 160, 110}};

/// Indoors, walls stand on all sides: from outside the building half the horizon is open.
bool is_inside(const mapping::DistanceField& field, const Point2<Map>& p) {
  const double range_max_m = (field.frame().width + field.frame().height) * field.frame().cell_m;
  constexpr int kWays = 12;
  int open = 0;
  for (int i = 0; i < kWays; ++i) {
    const double angle = 0.05 + i * 2.0 * kPi / kWays;
    open += field.free_way_m(p, std::cos(angle), std::sin(angle), range_max_m) >= range_max_m;
  }
  return open <= kWays / 4;
}

std::vector<std::pair<double, const Localizability*>> by_way(const LocalizabilityMap& map) {
  std::vector<std::pair<double, const Localizability*>> rows;
  double along = 0.0;
  for (std::size_t i = 0; i < map.route.size(); ++i) {
    if (i > 0)
      along +=
          distance_m(map.route[i - 1].map_from_base.translation(), map.route[i].map_from_base.translation());
    rows.emplace_back(along, &map.route[i]);
  }
  return rows;
}

double bare_m(const LocalizabilityMap& map) {
  double sum = 0.0;
  const auto rows = by_way(map);
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (fix_of(*rows[i].second) == Fix::Bare) sum += rows[i].first - rows[i - 1].first;
  return sum;
}

void draw_route(MapCanvas& canvas, const LocalizabilityMap& map) {
  double next_m = 0.0;
  const Localizability* before = nullptr;
  for (const auto& [along, place] : by_way(map)) {
    const Point2<Map> here = place->map_from_base.translation();
    if (before != nullptr) canvas.line({before->map_from_base.translation(), here}, colours::kInk, 2);
    before = place;
    if (along < next_m) continue;
    next_m = along + kEllipseEveryM;
    const Colour& colour = fix_of(*place) == Fix::Bare ? colours::kVermillion : colours::kPurple;
    canvas.ellipse(here, place->covariance.topLeftCorner<2, 2>(), kEnlarged, kLongestEllipseM, colour, 2);
    if (fix_of(*place) == Fix::Bare) canvas.cross(here, colours::kVermillion, 6);
  }
}

}  // namespace

Fix fix_of(const Localizability& forecast) {
  const double sigma = forecast.worst_sigma_m;
  if (!(sigma < kBareM)) return Fix::Bare;
  return sigma < kFairM ? Fix::Good : (sigma < kWeakM ? Fix::Fair : Fix::Weak);
}

LocalizabilityMap forecast_localizability(const mapping::Walls& walls, const std::vector<double>& weights,
                                          const Path& path, const localization::ForecastLidar& lidar) {
  const localization::SegmentGrid grid(walls, {}, weights);
  const mapping::DistanceField field(walls);
  LocalizabilityMap map;
  map.route = localization::localizability_along(grid, field, path, lidar);
  const mapping::GridFrame& frame = field.frame();
  const double wide = frame.width * frame.cell_m;
  const double tall = frame.height * frame.cell_m;
  map.square_m = std::max(1.0, std::sqrt(wide * tall / kMostSquares));
  for (double y = 0.5 * map.square_m; y < tall; y += map.square_m)
    for (double x = 0.5 * map.square_m; x < wide; x += map.square_m) {
      const Point2<Map> p{frame.origin.x_m + x, frame.origin.y_m + y};
      if (field.distance_m(p) >= kClearM && is_inside(field, p))
        map.floor.push_back(localization::localizability(grid, field, {p.x_m, p.y_m, 0.0}, lidar));
    }
  return map;
}

std::vector<std::uint8_t> localizability_plot(const mapping::Walls& walls, const LocalizabilityMap& map) {
  MapCanvas canvas(walls, {});
  for (const Localizability& place : map.floor) {
    const Point2<Map> p = place.map_from_base.translation();
    canvas.square(p, map.square_m, kFloor[static_cast<std::size_t>(fix_of(place))]);
    if (fix_of(place) == Fix::Bare) canvas.cross(p, colours::kVermillion, 2);
  }
  canvas.walls(walls, colours::kInk, 2);
  draw_route(canvas, map);
  canvas.title("How well the drawn walls will fix the position (one scan, weakest direction)");
  canvas.legend(
      {{Mark::Square, kFloor[0], 1, fmt::format("good: better than {:.0f} mm", 1e3 * kFairM)},
       {Mark::Square, kFloor[1], 1, fmt::format("fair: {:.0f} to {:.0f} mm", 1e3 * kFairM, 1e3 * kWeakM)},
       {Mark::Square, kFloor[2], 1, fmt::format("weak: {:.0f} to {:.0f} mm", 1e3 * kWeakM, 1e3 * kBareM)},
       {Mark::Crossed, colours::kVermillion, 2,
        fmt::format("bare: worse than {:.0f} mm; the wheels alone must carry the vehicle along",
                    1e3 * kBareM)},
       {Mark::Ellipse, colours::kPurple, 2,
        fmt::format("expected error along the route, enlarged {:.0f} times", kEnlarged)}});
  return canvas.png();
}

nlohmann::json to_json(const LocalizabilityMap& map) {
  nlohmann::json rows = nlohmann::json::array();
  double worst = 0.0;
  for (const auto& [along, place] : by_way(map)) {
    worst = std::max(worst, place->worst_sigma_m);
    rows.push_back({{"along_m", along},
                    {"x_m", place->map_from_base.x_m()},
                    {"y_m", place->map_from_base.y_m()},
                    {"sigma_m", place->worst_sigma_m},
                    {"direction_deg", to_deg(place->worst_direction_rad)},
                    {"sigma_yaw_deg", to_deg(place->sigma_yaw_rad)}});
  }
  return {{"worst_sigma_m", worst}, {"bare_m", bare_m(map)}, {"route", rows}};
}

std::string describe(const LocalizabilityMap& map) {
  const auto rows = by_way(map);
  const auto weakest = std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return a.second->worst_sigma_m < b.second->worst_sigma_m;
  });
  if (weakest == rows.end()) return "no route, no forecast";
  const Localizability& place = *weakest->second;
  return fmt::format(
      "weakest place {:.1f} m from the start at ({:.1f}, {:.1f}): {:.3f} m along {:.0f} deg; {:.1f} m of "
      "{:.1f} m "
      "are bare",
      weakest->first, place.map_from_base.x_m(), place.map_from_base.y_m(), place.worst_sigma_m,
      to_deg(place.worst_direction_rad), bare_m(map), rows.back().first);
}

}  // namespace madori::app
