#include "mapping/georeference/apply_scale.hpp"

#include "mapping/drawing/plan.hpp"
#include "mapping/georeference/local_plane.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

void stage_picture(SiteTransaction& change, const fs::path& folder, const Site& site, const Walls& walls,
                   const Walls& other_lines) {
  PlanOptions options;
  options.page = site.drawing.page;
  if (site.drawing.dpi > 0.0) options.dpi = site.drawing.dpi;
  const Plan plan = load_plan(folder / site.drawing.file, options);
  const auto pixels = [&](const Wall& line) {
    return on_drawing(line.segment, site.drawing.height_px, site.scale->m_per_px);
  };
  std::vector<PixelSegment> segments;
  std::vector<double> probabilities;
  for (const Wall& wall : walls) {
    segments.push_back(pixels(wall));
    probabilities.push_back(wall.probability);
  }
  std::vector<RejectedSegment> others;
  for (const Wall& line : other_lines)
    others.push_back({pixels(line), RejectReason::Other, line.probability});
  const auto png = import_picture(plan.picture, segments, others, site.scale->m_per_px, probabilities);
  change.write("import.png", {reinterpret_cast<const char*>(png.data()), png.size()});
}

}  // namespace

double apply_scale(const fs::path& folder, const ScaleEstimate& estimate, const std::string& date,
                   const StageScaled& others) {
  Site site = load_site(folder);  // before the transaction: an Error here leaves no trace
  SiteTransaction change(folder);
  site = load_site(folder);
  require_possible_size(folder.string(), site.drawing, estimate.m_per_px);
  const double unit = site.scale ? site.scale->m_per_px : 1.0;
  const double factor = estimate.m_per_px / unit;
  if (estimate.georeference) {
    site.georeference = estimate.georeference;
  } else if (site.georeference && site.scale) {  // it was laid on its place about its middle
    const Point2<Map> middle{0.5 * site.drawing.width_px * unit, 0.5 * site.drawing.height_px * unit};
    site.georeference = rescaled(*site.georeference, middle, factor);
  }
  site.scale = ScaleRecord{
      estimate.m_per_px, estimate.method,     estimate.relative_uncertainty, estimate.error_m, date,
      estimate.inputs,   estimate.residuals_m};
  Walls walls = load_walls(folder / "walls.csv");
  scale_walls(walls, factor);
  (void)stage_wall_files(change, walls, site.drawing.width_px * estimate.m_per_px,
                         site.drawing.height_px * estimate.m_per_px, {});
  Walls other_lines = load_other_lines(folder);
  scale_walls(other_lines, factor);
  if (!other_lines.empty()) change.write(kOtherLinesFile, walls_csv(other_lines));
  if (fs::exists(folder / "import.png")) stage_picture(change, folder, site, walls, other_lines);
  if (others) others(change, factor);
  change.write("site.yaml", site_yaml(site));
  change.commit();
  return factor;
}

}  // namespace madori::mapping
