#include "mapping/georeference/apply_scale.hpp"

#include "mapping/drawing/plan.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

void scale_walls(Walls& walls, double factor) {
  for (auto& wall : walls)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) *p = {p->x_m * factor, p->y_m * factor};
}

/// Lines that import rejected are not kept in the site, so the new picture is without them.
void stage_picture(SiteTransaction& change, const fs::path& folder, const Site& site, const Walls& walls) {
  PlanOptions options;
  options.page = site.drawing.page;
  if (site.drawing.dpi > 0.0) options.dpi = site.drawing.dpi;
  const Plan plan = load_plan(folder / site.drawing.file, options);
  const double m_per_px = site.scale->m_per_px;
  std::vector<PixelSegment> segments;
  std::vector<double> probabilities;
  for (const auto& [id, s, probability] : walls) {
    PixelSegment pixel;
    pixel.u1 = s.a.x_m / m_per_px;
    pixel.v1 = site.drawing.height_px - s.a.y_m / m_per_px;
    pixel.u2 = s.b.x_m / m_per_px;
    pixel.v2 = site.drawing.height_px - s.b.y_m / m_per_px;
    segments.push_back(pixel);
    probabilities.push_back(probability);
  }
  const auto png = import_picture(plan.picture, segments, {}, m_per_px, probabilities);
  change.write("import.png", {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace

double apply_scale(const fs::path& folder, const ScaleEstimate& estimate, const std::string& date,
                   const StageScaled& others) {
  Site site = load_site(folder);  // before the transaction: an Error here leaves no trace
  SiteTransaction change(folder);
  site = load_site(folder);
  require_possible_size(folder.string(), site.drawing, estimate.m_per_px);
  const double factor = estimate.m_per_px / (site.scale ? site.scale->m_per_px : 1.0);
  site.scale = ScaleRecord{
      estimate.m_per_px, estimate.method,     estimate.relative_uncertainty, estimate.error_m, date,
      estimate.inputs,   estimate.residuals_m};
  if (estimate.georeference) site.georeference = estimate.georeference;
  Walls walls = load_walls(folder / "walls.csv");
  scale_walls(walls, factor);
  (void)stage_wall_files(change, walls, site.drawing.width_px * estimate.m_per_px,
                         site.drawing.height_px * estimate.m_per_px, {});
  if (fs::exists(folder / "import.png")) stage_picture(change, folder, site, walls);
  if (others) others(change, factor);
  change.write("site.yaml", site_yaml(site));
  change.commit();
  return factor;
}

}  // namespace madori::mapping
