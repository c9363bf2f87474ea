#include "app/learned/deviations.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "app/plot/map_canvas.hpp"
#include "mapping/georeference/local_plane.hpp"

namespace madori::app {
namespace {

using nlohmann::json;

constexpr double kLeastSeenM = 0.4;  ///< two surfaces of the memory
constexpr double kSigmas = 2.0;

Point2<Map> middle(const Segment2<Map>& s) {
  return {0.5 * (s.a.x_m + s.b.x_m), 0.5 * (s.a.y_m + s.b.y_m)};
}

double rounded(double value, double digits) {
  return std::round(value * digits) / digits;
}

Deviation deviation_of(const mapping::Wall& wall, const localization::WallDeviation& found,
                       const localization::WarpFit& fit) {
  const Segment2<Map>& s = wall.segment;
  const double length = s.length_m();
  const double nx = length > 0.0 ? -(s.b.y_m - s.a.y_m) / length : 0.0;
  const double ny = length > 0.0 ? (s.b.x_m - s.a.x_m) / length : 0.0;
  const double own = found.seen_m() > 0.0 ? found.offset_m() : 0.0;
  const auto stands = [&](const Point2<Map>& p) {
    const Point2<Building> q = fit.warp.building(p);
    const double turn = fit.warp.turn_rad(p);
    return Point2<Map>{q.x_m + own * (std::cos(turn) * nx - std::sin(turn) * ny),
                       q.y_m + own * (std::sin(turn) * nx + std::cos(turn) * ny)};
  };
  const Point2<Map> at = stands(middle(s));
  Deviation row{wall.id, s, {stands(s.a), stands(s.b)}};
  row.across_m = nx * (at.x_m - middle(s).x_m) + ny * (at.y_m - middle(s).y_m);
  row.own_m = own;
  row.seen_m = found.seen_m();
  const localization::WarpStatistics& known = fit.warp.statistics();
  row.sigma_m = row.seen_m >= kLeastSeenM
                    ? known.residual_m * std::sqrt(1.0 + 2.0 / row.seen_m)
                    : std::hypot(fit.warp.sigma_m(middle(s)), known.offset_m, known.residual_m);
  if (row.seen_m >= kLeastSeenM)
    row.standing = std::abs(row.across_m) > kSigmas * row.sigma_m ? Standing::Displaced : Standing::AsDrawn;
  return row;
}

/// How far, in the steps of the legend.
constexpr std::array<double, 3> kStepsM{0.1, 0.3, 1e9};
constexpr std::array<Colour, 3> kStepColours{colours::kSky, colours::kOrange, colours::kVermillion};

std::string metres_text(const char* what, double metres) {
  std::array<char, 96> text{};
  std::snprintf(text.data(), text.size(), "%s: %.0f m", what, metres);
  return text.data();
}

}  // namespace

const char* to_string(Standing standing) {
  switch (standing) {
    case Standing::Unseen:
      return "unseen";
    case Standing::AsDrawn:
      return "as drawn";
    case Standing::Displaced:
      break;
  }
  return "displaced";
}

std::vector<Deviation> deviations(const mapping::Walls& drawn, const localization::WarpFit& fit) {
  std::vector<Deviation> rows;
  rows.reserve(drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i)
    rows.push_back(
        deviation_of(drawn[i], i < fit.walls.size() ? fit.walls[i] : localization::WallDeviation{}, fit));
  return rows;
}

std::string deviations_csv(const std::vector<Deviation>& rows) {
  std::string text =
      "wall_id,x1,y1,x2,y2,stands_x1,stands_y1,stands_x2,stands_y2,across_m,own_m,sigma_m,seen_m,standing\n";
  for (const Deviation& r : rows) {
    std::array<char, 320> line{};
    std::snprintf(
        line.data(), line.size(), "%d,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.2f,%s\n",
        r.wall_id, r.drawn.a.x_m, r.drawn.a.y_m, r.drawn.b.x_m, r.drawn.b.y_m, r.stands.a.x_m, r.stands.a.y_m,
        r.stands.b.x_m, r.stands.b.y_m, r.across_m, r.own_m, r.sigma_m, r.seen_m, to_string(r.standing));
    text += line.data();
  }
  return text;
}

std::string deviations_geojson(const mapping::Site& site, const std::vector<Deviation>& rows) {
  const auto at = [&](const Point2<Map>& p) -> json {
    if (!site.georeference) return {rounded(p.x_m, 1e4), rounded(p.y_m, 1e4)};
    const mapping::LatLon place = mapping::place_of(*site.georeference, p);
    return {rounded(place.longitude_deg, 1e9), rounded(place.latitude_deg, 1e9)};
  };
  json features = json::array();
  for (const Deviation& r : rows) {
    json geometry{{"type", "LineString"}, {"coordinates", json::array({at(r.stands.a), at(r.stands.b)})}};
    json properties{{"kind", "wall"},
                    {"id", r.wall_id},
                    {"standing", to_string(r.standing)},
                    {"across_m", rounded(r.across_m, 1e4)},
                    {"own_m", rounded(r.own_m, 1e4)},
                    {"sigma_m", rounded(r.sigma_m, 1e4)},
                    {"seen_m", rounded(r.seen_m, 1e2)}};
    features.push_back(
        {{"type", "Feature"}, {"geometry", std::move(geometry)}, {"properties", std::move(properties)}});
  }
  json all{{"type", "FeatureCollection"}, {"name", site.name}, {"features", std::move(features)}};
  if (!site.georeference) all["coordinates_are"] = "Map metres: the site has no place on Earth yet";
  return all.dump(1) + "\n";
}

std::vector<std::uint8_t> deviations_plot(const mapping::Walls& drawn, const std::vector<Deviation>& rows) {
  std::vector<Point2<Map>> ends;
  for (const Deviation& r : rows) {
    ends.push_back(r.stands.a);
    ends.push_back(r.stands.b);
  }
  MapCanvas canvas(drawn, ends);
  double unseen_m = 0.0;
  double as_drawn_m = 0.0;
  std::array<double, 3> displaced_m{};
  for (const Deviation& r : rows) {
    const double length = r.drawn.length_m();
    if (r.standing == Standing::Unseen) {
      canvas.line(r.drawn, colours::kPale, 2);
      unseen_m += length;
    } else if (r.standing == Standing::AsDrawn) {
      canvas.line(r.drawn, colours::kBlue, 4);
      as_drawn_m += length;
    }
  }
  for (const Deviation& r : rows) {  // above the others, so that what is right does not hide it
    if (r.standing != Standing::Displaced) continue;
    std::size_t step = 0;
    while (std::abs(r.across_m) > kStepsM[step]) ++step;
    canvas.line(r.drawn, colours::kGrey, 1);
    canvas.line({middle(r.drawn), middle(r.stands)}, kStepColours[step], 1);
    canvas.line(r.stands, kStepColours[step], 4);
    displaced_m[step] += r.drawn.length_m();
  }
  canvas.title("Where the building is not as drawn");
  canvas.legend({{Mark::Line, colours::kBlue, 4, metres_text("as drawn, within two sigmas", as_drawn_m)},
                 {Mark::Line, kStepColours[0], 4, metres_text("beside by up to 0.1 m", displaced_m[0])},
                 {Mark::Line, kStepColours[1], 4, metres_text("by 0.1 to 0.3 m", displaced_m[1])},
                 {Mark::Line, kStepColours[2], 4, metres_text("by more", displaced_m[2])},
                 {Mark::Line, colours::kGrey, 1, "where those are drawn"},
                 {Mark::Line, colours::kPale, 2, metres_text("not seen yet", unseen_m)}});
  return canvas.png();
}

}  // namespace madori::app
