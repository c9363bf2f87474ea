#include "hmi/server/site_compare.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "mapping/revision/wall_changes.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::hmi {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Pieces = std::vector<Segment2<Map>>;

Pieces version_walls(const fs::path& site, const mapping::SiteVersion& version) {
  Pieces walls;
  const auto found = version.files.find("walls.csv");
  if (found == version.files.end()) return walls;
  (void)mapping::version_file(site, version, "walls.csv");  // throws where it is damaged
  for (const auto& wall : mapping::load_walls(site / "versions/objects" / found->second))
    walls.push_back(wall.segment);
  return walls;
}

planning::RouteGraph version_routes(const fs::path& site, const mapping::SiteVersion& version) {
  return planning::parse_routes(mapping::version_file(site, version, "routes/tree.csv"),
                                mapping::version_file(site, version, "routes/path.csv"))
      .graph;
}

json piece_rows(const Pieces& pieces) {
  json list = json::array();
  for (const auto& p : pieces) list.push_back({p.a.x_m, p.a.y_m, p.b.x_m, p.b.y_m});
  return list;
}

/// The IDs of points that only one has, or that differ.
json changed_points(const planning::RouteGraph& a, const planning::RouteGraph& b) {
  std::set<int> ids;
  const auto differs = [](const planning::RouteNode& p, const planning::RouteNode& q) {
    return distance_m(p.position, q.position) > 1e-6 || p.name != q.name || p.station != q.station ||
           p.heading_rad != q.heading_rad || p.speed_limit_mps != q.speed_limit_mps || p.action != q.action;
  };
  const auto look = [&](const planning::RouteGraph& from, const planning::RouteGraph& in) {
    for (const auto& node : from.nodes()) {
      const auto other = in.index_of(node.id);
      if (!other || differs(node, in.nodes()[*other])) ids.insert(node.id);
    }
  };
  look(a, b);
  look(b, a);
  return ids;
}

json version_drawing(const mapping::SiteVersion& version) {
  for (const auto& [name, object] : version.files)
    if (name.starts_with("drawing.")) return object;
  return nullptr;
}

}  // namespace

json versions_json(const fs::path& site) {
  mapping::recover_site(site);  // a save that was cut short counts
  json list = json::array();
  for (const auto& version : mapping::site_versions(site))
    list.push_back({{"number", version.number},
                    {"stamp", version.stamp_s},
                    {"author", version.author},
                    {"sentence", version.sentence}});
  return list;
}

json compare_versions(const fs::path& site, int before, int after) {
  const auto a = mapping::site_version(site, before), b = mapping::site_version(site, after);
  const Pieces old_walls = version_walls(site, a), new_walls = version_walls(site, b);
  const mapping::ChangeOptions exactly{.within = 0.02, .shortest = 0.05};
  return {{"before", before},
          {"after", after},
          {"drawing_changed", version_drawing(a) != version_drawing(b)},
          {"walls_before", old_walls.size()},
          {"walls_after", new_walls.size()},
          {"gone", piece_rows(mapping::pieces_without(old_walls, new_walls, exactly))},
          {"added", piece_rows(mapping::pieces_without(new_walls, old_walls, exactly))},
          {"points_changed", changed_points(version_routes(site, a), version_routes(site, b))}};
}

}  // namespace madori::hmi
