#pragma once

#include <string>
#include <vector>

#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

/// A node of the routes, and a leg between two places, as the export shows them.
struct GeoNode {
  int id = 0;
  std::string name;
  Point2<Map> position;
};
struct GeoLeg {
  int from = 0;
  int to = 0;
  Segment2<Map> line;
};

struct GeoContent {
  Walls walls;
  std::vector<GeoNode> nodes;
  std::vector<GeoLeg> legs;
};

/// The site as GeoJSON (RFC 7946: WGS84, longitude first): the drawing's outline, walls, route legs and
/// nodes; the property `kind` tells them apart. Throws Error when the site is not georeferenced.
[[nodiscard]] std::string site_geojson(const Site& site, const GeoContent& content);

}  // namespace madori::mapping
