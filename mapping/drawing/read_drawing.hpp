#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/drawing/raster/detection_options.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// What one stage of the pipeline did.
struct StageReport {
  std::string name;
  double milliseconds = 0;
  std::size_t count = 0;  ///< how many things (edges, features, lines) it left
};

struct DetectedWalls {
  std::vector<PixelSegment> walls;        ///< faces and single lines, Image frame
  std::vector<double> probabilities;      ///< one a wall; empty where a vector drawing says it for sure
  std::vector<RejectedSegment> rejected;  ///< lines that were taken for something else
  double skew_deg = 0;  ///< how far the drawing's axes are turned, (-45, 45], counter-clockwise
  std::vector<StageReport> stages;
};

/// Receives the picture of each stage (--debug-images); may be empty.
using StageSink = std::function<void(const std::string& stage, const GrayImage& picture)>;
/// Receives the stage that begins and the share of the work done, 0..1; may be empty.
using Progress = std::function<void(const std::string& stage, double share)>;

/// The walls of a drawing. An empty answer is no error: the caller says what to try next.
/// Throws Error on invalid options, an empty picture or noise. docs/explanation/how-walls-are-found.md.
[[nodiscard]] DetectedWalls read_drawing(const GrayImage& image, const DetectionOptions& options,
                                         const StageSink& sink = {}, const Progress& progress = {});

}  // namespace madori::mapping
