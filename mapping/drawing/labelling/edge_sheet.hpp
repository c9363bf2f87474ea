#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "mapping/drawing/labelling/edge_map.hpp"
#include "mapping/drawing/pixel_box.hpp"
#include "mapping/drawing/pixel_segment.hpp"
#include "mapping/picture/gray_image.hpp"

namespace madori::mapping {

/// A straight edge between a dark and a bright side: one side of a pen stroke, of a fill or of a coloured
/// area.
struct Edge {
  PixelSegment segment;  ///< pixels of the sheet
  cv::Point2d normal{};  ///< unit length, towards the dark side
  double length_px = 0;
  double angle_rad = 0;  ///< [0, pi)
};

/// A drawing as its edges: what the features of its lines are measured on.
struct EdgeSheet {
  GrayImage grey;  ///< the drawing, with its colours, at the resolution that edges are looked for in; greys
                   ///< spread from 0 to 255, turned round where the ground is dark
  bool dark_ground = false;
  struct Ground {
    int grey = 255, red_green = 128, yellow_blue = 128;
  } ground;           ///< what most of the sheet is
  double factor = 1;  ///< its pixels for one of the drawing
  std::vector<Edge> edges;
  EdgeMap map;   ///< where they are
  PixelBox box;  ///< around all edges

  /// Its diagonal: what "of the sheet" means.
  [[nodiscard]] double size_px() const { return std::max(1.0, box.diagonal()); }
  [[nodiscard]] bool inside(double u, double v) const {
    return u >= 0 && v >= 0 && u < grey.width_px && v < grey.height_px;
  }
  [[nodiscard]] std::size_t pixel(double u, double v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(grey.width_px) +
           static_cast<std::size_t>(u);
  }
};

/// Edges by the line segment detector of R. Grompone von Gioi et al., "LSD", IEEE PAMI 32 (2010), which needs
/// no threshold of the drawing: a pale line is found as well as a bold one. Small drawings are enlarged
/// twice, large ones reduced, so that a pen has about the same width. Throws Error where the drawing is
/// noise.
[[nodiscard]] EdgeSheet find_edges(const GrayImage& drawing);

}  // namespace madori::mapping
