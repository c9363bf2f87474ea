#include "app/revision/carry_site.hpp"

#include <algorithm>
#include <array>

#include "core/angle.hpp"
#include "mapping/drawing/plan.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/revision/register_walls.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/site/site_versions.hpp"
#include "mapping/wall_map/wall_files.hpp"
#include "planning/route_graph/route_csv.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

constexpr double kHalfWidthM = 0.2;   ///< of what is looked at across a piece
constexpr double kPixelsPerM = 50.0;  ///< while nobody measured

/// Between the paper, which is most of a sheet, and its darkest hundredth.
int ink_threshold(const mapping::GrayImage& picture) {
  std::array<std::size_t, 256> count{};
  for (const std::uint8_t value : picture.pixels) ++count.at(value);
  const auto quantile = [&](double share) {
    auto left = static_cast<std::size_t>(share * static_cast<double>(picture.pixels.size()));
    int value = 0;
    while (value < 255 && left >= count.at(static_cast<std::size_t>(value)))
      left -= count.at(static_cast<std::size_t>(value++));
    return value;
  };
  return (quantile(0.01) + quantile(0.5)) / 2;
}

planning::RouteGraph carried(const planning::RouteGraph& routes, const mapping::Similarity& by) {
  std::vector<planning::RouteNode> nodes = routes.nodes();
  for (auto& node : nodes) {
    node.position = mapping::moved(by, node.position);
    if (node.heading_rad) node.heading_rad = wrap_angle(*node.heading_rad + by.yaw_rad);
  }
  return {std::move(nodes), routes.legs()};
}

void stage_drawing(mapping::SiteTransaction& change, const fs::path& beside, const mapping::Site& old,
                   const mapping::Site& now) {
  if (old.drawing.file != now.drawing.file) change.remove(old.drawing.file);
  change.write(now.drawing.file, mapping::file_content(beside / now.drawing.file));
  change.write("import.png", mapping::file_content(beside / "import.png"));
}

void stage_walls(mapping::SiteTransaction& change, const mapping::Site& now, mapping::Walls walls,
                 const mapping::Similarity& now_from_old) {
  int id = 0;
  for (auto& wall : walls) wall = {++id, mapping::moved(now_from_old, wall.segment), wall.probability};
  const double unit = now.scale ? now.scale->m_per_px : 1.0;
  (void)mapping::stage_wall_files(
      change, walls, now.drawing.width_px * unit, now.drawing.height_px * unit,
      now.scale ? mapping::WallFileOptions{} : mapping::WallFileOptions::unscaled());
}

/// The new drawing's own, in the site's unit.
void stage_other_lines(mapping::SiteTransaction& change, const fs::path& beside, double factor) {
  mapping::Walls lines = mapping::load_other_lines(beside);
  mapping::scale_walls(lines, factor);
  change.write(mapping::kOtherLinesFile, mapping::walls_csv(lines));
}

}  // namespace

mapping::Similarity inverse(const mapping::Similarity& by) {
  mapping::Similarity back{1.0 / by.scale, -by.yaw_rad, {0.0, 0.0}};
  back.offset = -back.apply(by.offset);
  return back;
}

DrawnInk::DrawnInk(const fs::path& site) {
  const mapping::Site record = mapping::load_site(site);
  mapping::PlanOptions options;
  options.page = record.drawing.page;
  if (record.drawing.dpi > 0.0) options.dpi = record.drawing.dpi;
  picture_ = mapping::load_plan(site / record.drawing.file, options).picture;
  unit_ = record.scale ? record.scale->m_per_px : 1.0;
  half_width_ = record.scale ? kHalfWidthM : kHalfWidthM * kPixelsPerM;
  ink_below_ = ink_threshold(picture_);
}

/// Share of ink across the piece at one place of it.
double DrawnInk::cover(const Segment2<Map>& piece, double share, double half_width) const {
  const double length = piece.length_m();
  const double nx = -(piece.b.y_m - piece.a.y_m) / length, ny = (piece.b.x_m - piece.a.x_m) / length;
  const double x = piece.a.x_m + share * (piece.b.x_m - piece.a.x_m);
  const double y = piece.a.y_m + share * (piece.b.y_m - piece.a.y_m);
  int ink = 0, all = 0;
  for (double across = -half_width; across <= half_width; across += unit_, ++all) {
    const auto u = static_cast<int>((x + across * nx) / unit_);
    const auto v = static_cast<int>(picture_.height_px - (y + across * ny) / unit_);
    if (u < 0 || v < 0 || u >= picture_.width_px || v >= picture_.height_px) continue;
    ink += picture_.at(u, v) < ink_below_ ? 1 : 0;
  }
  return all == 0 ? 0.0 : static_cast<double>(ink) / all;
}

bool DrawnInk::is_bold_along(const Segment2<Map>& here, const DrawnInk& own,
                             const Segment2<Map>& piece) const {
  constexpr int kPlaces = 60;
  constexpr double kAsBold = 0.5, kAlong = 0.55;
  const double scale = here.length_m() / piece.length_m();
  int along = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const double share = (i + 0.5) / kPlaces;
    const double bold = own.cover(piece, share, own.half_width_);
    along += cover(here, share, own.half_width_ * scale) >= kAsBold * bold ? 1 : 0;
  }
  return along >= kAlong * kPlaces;
}

void carry_site(const fs::path& site, const fs::path& beside, const mapping::Similarity& old_from_new,
                const mapping::Walls& walls) {
  const mapping::Site old = mapping::load_site(site);
  const mapping::Site imported = mapping::load_site(beside);
  mapping::Site now = old;
  now.drawing = imported.drawing;
  const double factor = old.scale ? old_from_new.scale : 1.0;
  if (now.scale)
    now.scale->m_per_px = factor * (imported.scale ? imported.scale->m_per_px : 1.0);
  else
    now.scale = imported.scale;  // a drawing that knows its size measures the site
  mapping::Similarity now_from_old = inverse(old_from_new);
  now_from_old.scale *= factor;
  now_from_old.offset *= factor;
  if (now.georeference) {
    const auto origin =
        mapping::place_of(*old.georeference, mapping::moved(old_from_new, Point2<Map>{0.0, 0.0}));
    now.georeference = mapping::GeoreferenceRecord{
        origin.latitude_deg, origin.longitude_deg,
        to_deg(wrap_angle(to_rad(old.georeference->enu_from_map_yaw_deg) + old_from_new.yaw_rad))};
  }
  mapping::SiteTransaction change(site);
  change.say("drawing replaced by a new revision, routes kept");
  stage_drawing(change, beside, old, now);
  stage_walls(change, now, walls, now_from_old);
  stage_other_lines(change, beside, factor);
  if (fs::exists(site / "routes/path.csv"))
    change.write("routes/path.csv",
                 planning::path_csv(carried(planning::load_routes(site / "routes"), now_from_old)));
  change.remove(mapping::kWayFile);  // it lies on the old drawing
  change.write("site.yaml", mapping::site_yaml(now));
  change.commit();
}

}  // namespace madori::app
