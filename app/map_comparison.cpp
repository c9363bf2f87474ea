#include "app/map_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "app/grid_map_file.hpp"
#include "app/learned/living_map_file.hpp"
#include "core/result.hpp"
#include "localization/ndt_map/map_registration.hpp"
#include "localization/registration/point_icp.hpp"
#include "localization/registration/point_map.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
using Places = std::vector<Point2<Map>>;
using Pose = Transform2<Map, Map>;

/// The first of each cell.
Places one_a_cell(const Places& all, double cell_m) {
  std::set<std::pair<long, long>> taken;
  Places kept;
  for (const Point2<Map>& p : all)
    if (taken.emplace(std::lround(p.x_m / cell_m), std::lround(p.y_m / cell_m)).second) kept.push_back(p);
  return kept;
}

Places moved(const Places& places, const Pose& by) {
  Places there;
  there.reserve(places.size());
  for (const Point2<Map>& p : places) there.push_back(by * p);
  return there;
}

Point2<Map> middle_of(const Places& places) {
  Point2<Map> sum;
  for (const Point2<Map>& p : places) sum = {sum.x_m + p.x_m, sum.y_m + p.y_m};
  const auto n = static_cast<double>(places.size());
  return {sum.x_m / n, sum.y_m / n};
}

/// In any direction, the middles within 6 m of each other: twelve windows of a twelfth of a turn.
Pose anywhere(const localization::GaussianPyramid& building, const Places& map, const Places& truth) {
  constexpr int kWindows = 12;
  localization::MapRegistrationOptions window;
  window.half_m = 6.0;
  window.half_rad = kPi / kWindows;
  window.first_level = 2;
  const Point2<Map> from = middle_of(map), to = middle_of(truth);
  const localization::GaussianPyramid about_middle(moved(map, Pose(-from.x_m, -from.y_m, 0.0)), 0.25);
  localization::MapRegistration best;
  best.score = -1.0;
  for (int i = 0; i < kWindows; ++i) {
    const auto found =
        localization::lay_on(building, about_middle, Pose(to.x_m, to.y_m, 2.0 * kPi * i / kWindows), window);
    if (found.score > best.score) best = found;
  }
  return best.on_map() * Pose(-from.x_m, -from.y_m, 0.0);
}

/// Coarse cells first, then the points themselves.
Pose aligned(const Places& map, const Places& building, const MapComparisonOptions& options) {
  if (options.alignment == MapAlignment::None) return options.start;
  const localization::GaussianPyramid target(building, 0.25);
  Pose guess = options.start;
  if (options.alignment == MapAlignment::Anywhere) guess = anywhere(target, map, building);
  localization::MapRegistrationOptions near;
  near.half_m = 1.0;
  guess = localization::lay_on(target, localization::GaussianPyramid(map, 0.25), guess, near).on_map();
  localization::ScanPoints points;
  for (const Point2<Map>& p : map) points.add(p.x_m, p.y_m);
  const auto fine = localization::point_icp(points, localization::PointMap(building),
                                            {guess.x_m(), guess.y_m(), guess.yaw_rad()});
  const auto& found = fine.map_from_base;
  return fine.converged ? Pose(found.x_m(), found.y_m(), found.yaw_rad()) : guess;
}

nlohmann::json nearest_distances(const Places& of, const Places& to) {
  const localization::PointMap tree(to);
  std::vector<double> all;
  double sum = 0.0;
  for (const Point2<Map>& p : of) {
    all.push_back(std::sqrt(tree.nearest(p).squared_distance_m2));
    sum += all.back();
  }
  std::sort(all.begin(), all.end());
  const auto at = [&](double share) {
    return all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
  };
  const auto within = std::upper_bound(all.begin(), all.end(), 0.2) - all.begin();
  const auto n = static_cast<double>(all.size());
  return {{"places", all.size()}, {"mean_m", sum / n},
          {"median_m", at(0.5)},  {"p95_m", at(0.95)},
          {"max_m", all.back()},  {"share_within_0_2_m", static_cast<double>(within) / n}};
}

}  // namespace

std::vector<Point2<Map>> occupied_places(const fs::path& file, double cell_m) {
  if (fs::is_directory(file)) return occupied_places(file / "walls.csv", cell_m);
  Places places;
  if (file.extension() == ".csv")
    places = localization::sample_walls(mapping::load_walls(file), 0.5 * cell_m);
  else if (file.extension() == ".yaml")
    places = occupied_cells(load_grid_map(file));
  else if (file.extension() == ".bin")
    places = standing_places(load_living_map(file));
  else
    throw Error(file.string(), "is no map that is known",
                "give a site folder, walls.csv, a map_server file (.yaml) or a living map (.bin)");
  if (places.empty()) throw Error(file.string(), "holds nothing occupied", "is it the right file?");
  return one_a_cell(places, cell_m);
}

nlohmann::json compare_maps(const Places& map, const Places& building, const MapComparisonOptions& options) {
  const Pose building_from_map = aligned(map, building, options);
  const Places laid = moved(map, building_from_map);
  return {{"cell_m", options.cell_m},
          {"building_from_map",
           {{"x_m", building_from_map.x_m()},
            {"y_m", building_from_map.y_m()},
            {"yaw_deg", to_deg(building_from_map.yaw_rad())}}},
          {"building_to_map", nearest_distances(building, laid)},
          {"map_to_building", nearest_distances(laid, building)}};
}

}  // namespace madori::app
