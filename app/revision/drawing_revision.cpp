#include "app/revision/drawing_revision.hpp"

#include <stdlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "app/revision/carry_site.hpp"
#include "core/angle.hpp"
#include "core/result.hpp"
#include "core/segment_distance.hpp"
#include "mapping/revision/wall_changes.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/wall.hpp"
#include "planning/route_graph/route_check.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "planning/route_graph/route_search.hpp"
#include "planning/route_graph/vehicle_fit.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;
using Walls2 = std::vector<Segment2<Map>>;

mapping::Walls walls_of(const fs::path& site) {
  return mapping::load_walls(site / "walls.csv");
}

Walls2 segments_of(const mapping::Walls& walls) {
  Walls2 segments;
  for (const auto& wall : walls) segments.push_back(wall.segment);
  return segments;
}

bool same(const planning::RouteFinding& a, const planning::RouteFinding& b) {
  return a.code == b.code && a.values.contains("from") == b.values.contains("from") &&
         a.values.contains("node") == b.values.contains("node") &&
         (!a.values.contains("from") ||
          (a.values.at("from") == b.values.at("from") && a.values.at("to") == b.values.at("to"))) &&
         (!a.values.contains("node") || a.values.at("node") == b.values.at("node"));
}

/// The stations that a vehicle can serve: far enough from walls, and reached over legs that pass none.
std::set<std::size_t> served(const planning::RouteGraph& routes, const Walls2& walls, double half_width_m) {
  std::vector<planning::RouteLeg> free;
  for (const auto& leg : routes.legs()) {
    const Segment2<Map> way{routes.nodes()[leg.from].position, routes.nodes()[leg.to].position};
    if (std::ranges::none_of(walls, [&](const auto& wall) { return distance_m(way, wall) == 0.0; }))
      free.push_back(leg);
  }
  const planning::RouteGraph open(routes.nodes(), free);
  const auto [component, largest] = planning::strong_components(open);
  std::set<std::size_t> stations;
  for (const std::size_t station : routes.stations()) {
    const Point2<Map>& at = routes.nodes()[station].position;
    const bool room =
        std::ranges::none_of(walls, [&](const auto& wall) { return distance_m(wall, at) < half_width_m; });
    if (room && component[station] == largest) stations.insert(station);
  }
  return stations;
}

/// What the new walls mean for the routes, which stay where they are.
void check(const fs::path& site, const mapping::Site& record, const Walls2& before, const Walls2& now,
           DrawingRevision& revision) {
  if (!fs::exists(site / "routes/path.csv")) return;
  const auto routes = planning::load_routes(site / "routes");
  const planning::RouteCheckOptions options{.vehicle = planning::outline_of(record.vehicle)};
  const auto old = planning::check_routes(routes, before, options);
  for (auto& finding : planning::check_routes(routes, now, options))
    if (std::ranges::none_of(old, [&](const auto& one) { return same(one, finding); }))
      revision.findings.push_back(std::move(finding));
  const auto left = served(routes, now, options.vehicle.half_width_m);
  for (const std::size_t station : served(routes, before, options.vehicle.half_width_m)) {
    if (left.contains(station)) continue;
    const auto& node = routes.nodes()[station];
    revision.stations_lost.push_back(node.name.empty() ? std::to_string(node.id) : node.name);
  }
}

/// Of the Map a metre: pixels are taken for 2 cm while nobody measured.
double unit_of(const mapping::Site& record) {
  return record.scale ? 1.0 : 1.0 / 0.02;
}

double length_of(const Walls2& pieces) {
  double sum = 0.0;
  for (const auto& piece : pieces) sum += piece.length_m();
  return sum;
}

}  // namespace

class RevisedDrawing::Beside {
 public:
  Beside(mapping::ImportOptions options, const mapping::Progress& progress) {
    options.site = folder_.path;
    options.force = false;
    (void)mapping::import_drawing(options, progress);
  }
  [[nodiscard]] const fs::path& folder() const { return folder_.path; }

 private:
  /// Empty, and of a name that no program had before: one that was killed leaves its own. Goes with this
  /// object, also where the import fails.
  struct Folder {
    Folder() {
      std::string name = (fs::temp_directory_path() / "madori-revision-XXXXXX").string();
      if (::mkdtemp(name.data()) == nullptr)
        throw Error(name, "cannot be made", "check the permissions and the free space there");
      path = name;
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    fs::path path;
  };

  Folder folder_;
};

RevisedDrawing::RevisedDrawing(const mapping::ImportOptions& options, const mapping::Progress& progress)
    : site_(options.site),
      beside_(std::make_unique<const Beside>(options, progress)),
      before_(walls_of(site_)) {
  const double unit = unit_of(mapping::load_site(site_));
  const auto laid =
      mapping::register_walls(segments_of(before_), segments_of(walls_of(beside_->folder())), 0.15 * unit);
  if (!laid)
    throw Error("the new drawing", "is no revision of the site's: its walls do not lie on the old ones",
                "import it as a site of its own, or replace the drawing with --force");
  compare(*laid);
}

RevisedDrawing::~RevisedDrawing() = default;

void RevisedDrawing::move(const mapping::Similarity& by) {
  const auto& old = found_.laid.old_from_new;
  const mapping::Similarity near{by.scale * old.scale, wrap_angle(by.yaw_rad + old.yaw_rad),
                                 by.apply(old.offset)};
  const double unit = unit_of(mapping::load_site(site_));
  compare(mapping::settle_walls(segments_of(before_), segments_of(walls_of(beside_->folder())), near,
                                0.15 * unit));
}

void RevisedDrawing::apply() const {
  carry_site(site_, beside_->folder(), found_.laid.old_from_new, found_.walls);
}

void RevisedDrawing::compare(const mapping::WallRegistration& laid) {
  const mapping::Site record = mapping::load_site(site_);
  const double unit = unit_of(record);
  found_ = {laid, {}, {}, {}, {}, {}};
  mapping::Walls drawn = walls_of(beside_->folder());
  for (auto& wall : drawn) wall.segment = mapping::moved(laid.old_from_new, wall.segment);
  drawn_ = segments_of(drawn);
  const Walls2 before = segments_of(before_);
  const mapping::ChangeOptions options{.within = 0.15 * unit, .shortest = 0.8 * unit, .step = 0.05 * unit};
  const DrawnInk old_ink(site_), new_ink(beside_->folder());
  const auto changes = [&](const mapping::Walls& of, const Walls2& others, auto drawn_too) {
    mapping::Walls pieces = mapping::walls_without(of, others, options);
    // taken for a wall in one drawing only, and drawn in both
    std::erase_if(pieces, [&](const mapping::Wall& piece) { return drawn_too(piece.segment); });
    return pieces;
  };
  const auto back = inverse(laid.old_from_new);
  const mapping::Walls added = changes(drawn, before, [&](const Segment2<Map>& piece) {
    return old_ink.is_bold_along(piece, new_ink, mapping::moved(back, piece));
  });
  found_.added = segments_of(added);
  found_.gone = segments_of(changes(before_, drawn_, [&](const Segment2<Map>& piece) {
    return new_ink.is_bold_along(mapping::moved(back, piece), old_ink, piece);
  }));
  // What has not changed stays as it is, with all that a person mended of it.
  const mapping::ChangeOptions exactly{.within = 1e-3 * unit, .shortest = 0.05 * unit, .step = 0.05 * unit};
  found_.walls = mapping::walls_without(before_, found_.gone, exactly);
  found_.walls.insert(found_.walls.end(), added.begin(), added.end());
  check(site_, record, before, segments_of(found_.walls), found_);
}

nlohmann::json segment_rows(const Walls2& pieces) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& p : pieces) list.push_back({p.a.x_m, p.a.y_m, p.b.x_m, p.b.y_m});
  return list;
}

nlohmann::json revision_json(const DrawingRevision& revision, bool applied) {
  const auto& by = revision.laid.old_from_new;
  nlohmann::json findings = nlohmann::json::array();
  for (const auto& finding : revision.findings)
    findings.push_back({{"severity", to_string(finding.severity)},
                        {"file", finding.file},
                        {"line", finding.line},
                        {"message", finding.message},
                        {"code", finding.code},
                        {"values", finding.values}});
  return {{"laid",
           {{"scale", by.scale},
            {"yaw_deg", to_deg(by.yaw_rad)},
            {"x", by.offset.x()},
            {"y", by.offset.y()},
            {"covered", revision.laid.covered}}},
          {"gone", segment_rows(revision.gone)},
          {"added", segment_rows(revision.added)},
          {"gone_m", length_of(revision.gone)},
          {"added_m", length_of(revision.added)},
          {"findings", findings},
          {"stations_lost", revision.stations_lost},
          {"applied", applied}};
}

}  // namespace madori::app
