#include "mapping/drawing/import_drawing.hpp"

#include <algorithm>
#include <future>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "core/result.hpp"
#include "mapping/drawing/raster/stage_clock.hpp"
#include "mapping/georeference/scale_estimate.hpp"
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_transaction.hpp"
#include "mapping/wall_map/import_picture.hpp"
#include "mapping/wall_map/wall.hpp"
#include "mapping/wall_map/wall_files.hpp"

namespace madori::mapping {
namespace {

namespace fs = std::filesystem;

void refuse_existing(const ImportOptions& options) {
  std::error_code error;
  const auto status = fs::status(options.site, error);
  if (options.force || status.type() == fs::file_type::not_found) return;
  if (status.type() == fs::file_type::none)
    throw Error(options.site.string(), "cannot be looked at: " + error.message(), "name another --site");
  if (!fs::is_directory(status))
    throw Error(options.site.string(), "is a file, not a folder", "name another --site");
  if (fs::exists(options.site / "site.yaml", error))
    throw Error(options.site.string(), "is a site already",
                "name another folder, or replace its drawing with --force");
  const fs::directory_iterator entries(options.site, error);
  if (error)
    throw Error(options.site.string(), "cannot be read: " + error.message(), "check its permissions");
  for (const auto& entry : entries)
    if (!entry.path().filename().string().starts_with(".staging"))
      throw Error(options.site.string(), "is a folder with other files in it",
                  "name another folder, or use --force");
}

StageSink debug_sink(const ImportOptions& options, SiteTransaction& change) {
  if (!options.debug_images) return {};
  return [&change, number = 0](const std::string& stage, const GrayImage& picture) mutable {
    const std::string name = "debug/" + std::to_string(10 + number++) + "-" + stage + ".png";
    const cv::Mat view(picture.height_px, picture.width_px, CV_8UC1,
                       const_cast<std::uint8_t*>(picture.pixels.data()));
    std::vector<std::uint8_t> png;
    cv::imencode(".png", view, png, {cv::IMWRITE_PNG_COMPRESSION, 1});
    change.write(name, {reinterpret_cast<const char*>(png.data()), png.size()});
  };
}

/// Image to Map: x = u * s, y = (height - v) * s (architecture.md, frames). Takes the next number.
void add_line(Walls& lines, const PixelSegment& s, double probability, int height_px, double m_per_px) {
  const Point2<Map> a{s.u1 * m_per_px, (height_px - s.v1) * m_per_px};
  const Point2<Map> b{s.u2 * m_per_px, (height_px - s.v2) * m_per_px};
  lines.push_back({static_cast<int>(lines.size()) + 1, {a, b}, probability});
}

Walls to_map(const DetectedWalls& found, int height_px, double m_per_px) {
  Walls walls;
  walls.reserve(found.walls.size());
  for (const auto& s : found.walls)
    add_line(walls, s, found.probabilities.empty() ? 1.0 : found.probabilities[walls.size()], height_px,
             m_per_px);
  return walls;
}

/// What a drawing file does not say to be writing, measures, an opening or the sheet's own may stand there.
bool may_stand(RejectReason reason) {
  return reason == RejectReason::Furniture || reason == RejectReason::TooShort ||
         reason == RejectReason::Other;
}

Walls other_lines(const DetectedWalls& found, int height_px, double m_per_px) {
  Walls lines;
  for (const RejectedSegment& other : found.rejected)
    if (may_stand(other.reason)) add_line(lines, other.segment, other.probability, height_px, m_per_px);
  return lines;
}

/// One colour from edge to edge, as an empty page or a failed scan has it.
void refuse_blank(const ImportOptions& options, const GrayImage& picture) {
  std::uint8_t darkest = 255, brightest = 0;
  for (const std::uint8_t value : picture.pixels) {
    darkest = std::min(darkest, value);
    brightest = std::max(brightest, value);
    if (brightest - darkest > 8) return;  // any drawing shows that long before its end
  }
  throw Error(options.drawing.string(),
              std::string("is all ") + (darkest > 128 ? "white" : "black") + ", no wall was found",
              "scan or export it again, or choose another --page");
}

[[noreturn]] void no_walls(const ImportOptions& options, const Plan& plan) {
  std::string layers;
  for (const auto& note : plan.left_out) layers += note + "; ";
  layers += "name the layers of the walls with --layers";
  throw Error(options.drawing.string(), "no wall was found in it",
              plan.vectors
                  ? layers
                  : "doubtful walls: --strictness 0.3; name a line that is a wall: --like u,v; look at the "
                    "stages with --debug-images");
}

/// From a printed scale: one pixel is 1/dpi inch of paper.
ScaleRecord scale_of_paper(const ImportOptions& options, const Plan& plan) {
  const double dpi = plan.vectors ? 0.0 : options.plan.dpi.value_or(plan.picture.dpi);
  const ScaleEstimate paper = paper_scale(*options.paper_scale, dpi);
  return {paper.m_per_px, paper.method, paper.relative_uncertainty,
          paper.error_m,  options.date, paper.inputs};
}

/// Where the scale comes from, strongest first: the options, the paper, the file's own units.
std::optional<ScaleRecord> given_scale(const ImportOptions& options, const Plan& plan) {
  if (options.m_per_px)
    return ScaleRecord{*options.m_per_px, options.scale_method, 0, 0, options.date, options.scale_inputs};
  if (options.paper_scale) return scale_of_paper(options, plan);
  if (plan.m_per_px) return ScaleRecord{*plan.m_per_px, plan.scale_method, 0, 0, options.date, plan.notes};
  return std::nullopt;
}

std::optional<ScaleRecord> find_scale(const ImportOptions& options, const Plan& plan) {
  auto scale = given_scale(options, plan);
  if (scale) {
    const GrayImage& picture = plan.picture;
    require_possible_size(options.drawing.string(), {"", picture.width_px, picture.height_px, 1, picture.dpi},
                          scale->m_per_px);
  }
  return scale;
}

Site make_site(const ImportOptions& options, const Plan& plan, const std::string& drawing_name) {
  Site site;
  const bool replaces = options.force && fs::exists(options.site / "site.yaml");
  if (replaces) site = load_site(options.site);
  site.georeference.reset();
  if (!options.name.empty() || !replaces)
    site.name = options.name.empty() ? options.drawing.stem().string() : options.name;
  site.drawing = {drawing_name, plan.picture.width_px, plan.picture.height_px, options.plan.page,
                  options.plan.dpi.value_or(plan.picture.dpi)};
  site.scale = find_scale(options, plan);
  return site;
}

/// The files of an older import that this one does not write again.
void remove_old_drawing(const ImportOptions& options, const std::string& drawing_name,
                        SiteTransaction& change) {
  if (!fs::exists(options.site / "site.yaml")) return;
  const std::string old = load_site(options.site).drawing.file;
  if (old != drawing_name) change.remove(old);
}

/// The exact lines of a vector drawing, or those found in its picture.
DetectedWalls find_walls(const ImportOptions& options, Plan& plan, SiteTransaction& change,
                         const Progress& progress) {
  DetectedWalls found;
  if (plan.vectors) {
    found.walls = std::move(plan.vectors->walls);
    found.rejected = std::move(plan.vectors->rejected);
  } else {
    refuse_blank(options, plan.picture);
    found = read_drawing(plan.picture, options.detection, debug_sink(options, change), progress);
  }
  if (found.walls.empty()) no_walls(options, plan);
  return found;
}

PointMap stage_walls(const ImportOptions& options, const Plan& plan, const Walls& walls, double unit,
                     bool scaled, SiteTransaction& change) {
  WallFileOptions files = scaled ? WallFileOptions() : WallFileOptions::unscaled();
  files.point_spacing = options.point_spacing_m.value_or(files.point_spacing);
  files.voxel = options.voxel_m.value_or(files.voxel);
  files.cell = options.cell_m.value_or(files.cell);
  return stage_wall_files(change, walls, plan.picture.width_px * unit, plan.picture.height_px * unit, files);
}

void stage_site(const ImportOptions& options, const Site& site, SiteTransaction& change) {
  change.write("site.yaml", site_yaml(site));
  change.write(site.drawing.file, file_content(options.drawing));
  remove_old_drawing(options, site.drawing.file, change);
}

/// What import.png shows, packed beside what the caller does meanwhile.
std::future<std::vector<std::uint8_t>> start_picture(const Plan& plan, const DetectedWalls& found,
                                                     std::optional<double> m_per_px) {
  return std::async(std::launch::async, [&plan, &found, m_per_px] {
    return import_picture(plan.picture, found.walls, found.rejected, m_per_px, found.probabilities);
  });
}

}  // namespace

double ImportReport::wall_length() const {
  double sum = 0;
  for (const auto& wall : walls) sum += wall.segment.length_m();
  return sum;
}

ImportReport import_drawing(const ImportOptions& options, const Progress& progress) {
  refuse_existing(options);
  ImportReport report;
  std::vector<StageReport> reports;
  StageClock stages(reports, progress);
  stages.begin("load", 0.0);
  Plan plan = load_plan(options.drawing, options.plan);
  stages.end(plan.picture.pixels.size());

  SiteTransaction change(options.site);
  report.found = find_walls(options, plan, change, progress);
  const DetectedWalls& found = report.found;
  reports.insert(reports.end(), found.stages.begin(), found.stages.end());
  report.site = make_site(options, plan, "drawing" + options.drawing.extension().string());
  const auto& scale = report.site.scale;
  const double unit = scale ? scale->m_per_px : 1.0;
  report.walls = to_map(found, plan.picture.height_px, unit);

  auto picture = start_picture(plan, found, scale ? std::optional(unit) : std::nullopt);
  stages.begin("points", 0.85);
  report.points = stage_walls(options, plan, report.walls, unit, scale.has_value(), change);
  change.write(kOtherLinesFile, walls_csv(other_lines(found, plan.picture.height_px, unit)));
  stages.end(report.points.points.size());
  stages.begin("save", 0.9);
  stage_site(options, report.site, change);
  stages.end(report.walls.size());
  stages.begin("picture", 0.95);
  const auto png = picture.get();
  change.write("import.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  stages.end(found.walls.size());
  stages.begin("commit", 0.98);
  change.commit();
  stages.end(1);

  report.found.stages = std::move(reports);
  report.notes = std::move(plan.notes);
  report.notes.insert(report.notes.end(), plan.left_out.begin(), plan.left_out.end());
  return report;
}

}  // namespace madori::mapping
