#include "mapping/wall_map/occupancy_map.hpp"

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr double kMostPictureCells = 1e8;
constexpr int kCellFractionBits = 8;  // cv::line takes ends in 1/256 of a cell

cv::Point to_cell(const Point2<Map>& p, double cell_m, int rows) {
  const double u = p.x_m / cell_m - 0.5;
  const double v = rows - p.y_m / cell_m - 0.5;
  return {static_cast<int>(std::lround(u * (1 << kCellFractionBits))),
          static_cast<int>(std::lround(v * (1 << kCellFractionBits)))};
}

}  // namespace

OccupancyMap make_occupancy_map(const Walls& walls, double width_m, double height_m, double cell_m) {
  const double columns = std::ceil(width_m / cell_m);
  const double rows = std::ceil(height_m / cell_m);
  if (columns * rows > kMostPictureCells)
    throw Error("a map of " + std::to_string(std::lround(width_m)) + " m x " +
                    std::to_string(std::lround(height_m)) + " m",
                "would have more than 100 million cells",
                "check the scale; where it is right, import the drawing anew with larger cells");
  cv::Mat grid(static_cast<int>(rows), static_cast<int>(columns), CV_8UC1, cv::Scalar(254));
  for (const auto& wall : walls)
    cv::line(grid, to_cell(wall.segment.a, cell_m, grid.rows), to_cell(wall.segment.b, cell_m, grid.rows),
             cv::Scalar(0), 1, cv::LINE_8, kCellFractionBits);
  OccupancyMap map;
  map.pgm = "P5\n" + std::to_string(grid.cols) + ' ' + std::to_string(grid.rows) + "\n255\n";
  map.pgm.append(reinterpret_cast<const char*>(grid.data), grid.total());
  std::ostringstream yaml;
  yaml.precision(12);
  yaml << "image: map.pgm\nmode: trinary\nresolution: " << cell_m
       << "\norigin: [0.0, 0.0, 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n";
  map.yaml = yaml.str();
  return map;
}

}  // namespace madori::mapping
