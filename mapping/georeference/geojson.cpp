#include "mapping/georeference/geojson.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "mapping/georeference/local_plane.hpp"

namespace madori::mapping {
namespace {

using nlohmann::json;

/// Longitude and latitude, nine digits after the point: a tenth of a millimetre.
class Positions {
 public:
  explicit Positions(const GeoreferenceRecord& georeference) : georeference_(georeference) {}
  json operator()(const Point2<Map>& p) const {
    const LatLon place = place_of(georeference_, p);
    return {std::round(place.longitude_deg * 1e9) / 1e9, std::round(place.latitude_deg * 1e9) / 1e9};
  }
  json operator()(const Segment2<Map>& s) const { return json::array({(*this)(s.a), (*this)(s.b)}); }

 private:
  const GeoreferenceRecord& georeference_;
};

json feature(const char* type, json coordinates, json properties) {
  return {{"type", "Feature"},
          {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}},
          {"properties", std::move(properties)}};
}

}  // namespace

std::string site_geojson(const Site& site, const GeoContent& content) {
  if (!site.georeference || !site.scale)
    throw Error(site.name, "has no place on Earth yet",
                "give control points: madori scale DIR --control u,v=LAT,LON ... --apply");
  const Positions at(*site.georeference);
  const double width = site.drawing.width_px * site.scale->m_per_px;
  const double height = site.drawing.height_px * site.scale->m_per_px;
  json features = json::array();
  const json ring =
      json::array({at(Point2<Map>{0, 0}), at(Point2<Map>{width, 0}), at(Point2<Map>{width, height}),
                   at(Point2<Map>{0, height}), at(Point2<Map>{0, 0})});
  features.push_back(feature("Polygon", json::array({ring}), {{"kind", "drawing"}, {"name", site.name}}));
  for (const auto& [id, segment, probability] : content.walls)
    features.push_back(feature("LineString", at(segment), {{"kind", "wall"}, {"id", id}}));
  for (const auto& leg : content.legs)
    features.push_back(
        feature("LineString", at(leg.line), {{"kind", "route"}, {"from", leg.from}, {"to", leg.to}}));
  for (const auto& node : content.nodes)
    features.push_back(
        feature("Point", at(node.position), {{"kind", "node"}, {"id", node.id}, {"name", node.name}}));
  return json{{"type", "FeatureCollection"}, {"name", site.name}, {"features", features}}.dump(1) + "\n";
}

}  // namespace madori::mapping
