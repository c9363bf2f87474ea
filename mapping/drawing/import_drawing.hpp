#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/drawing/plan.hpp"
#include "mapping/drawing/read_drawing.hpp"
#include "mapping/site/site.hpp"
#include "mapping/wall_map/point_map.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::mapping {

struct ImportOptions {
  std::filesystem::path drawing;
  std::filesystem::path site;
  std::string name;                ///< of the site; empty: the drawing's file name
  std::optional<double> m_per_px;  ///< stronger than the file's own units
  std::optional<double>
      paper_scale;  ///< the N of 1:N, where the picture has a resolution; m_per_px is stronger
  std::string scale_method = "option";               ///< how m_per_px was found (ScaleRecord)
  std::vector<std::string> scale_inputs{"--scale"};  ///< and from what
  PlanOptions plan;
  DetectionOptions detection;
  std::optional<double> point_spacing_m;  ///< of the wall points; default 0.02 m (1 px while unscaled)
  std::optional<double> voxel_m;          ///< default 0.05 m (2 px while unscaled)
  std::optional<double> cell_m;           ///< of map.pgm; default 0.05 m (2 px while unscaled)
  bool force = false;                     ///< replaces the drawing of an existing site; routes and tiles stay
  bool debug_images = false;              ///< one picture a stage in DIR/debug
  std::string date;                       ///< ISO 8601 UTC, recorded with the scale
};

struct ImportReport {
  Site site;
  Walls walls;          ///< metres, pixels while unscaled
  DetectedWalls found;  ///< the same in the drawing, what was taken for something else, and all stages
  PointMap points;
  std::vector<std::string> notes;

  [[nodiscard]] double wall_length() const;
};

/// `madori import`: a drawing becomes a site folder, in one atomic step (SiteTransaction). Throws Error on
/// every bad input, with the site as it was.
ImportReport import_drawing(const ImportOptions& options, const Progress& progress = {});

}  // namespace madori::mapping
