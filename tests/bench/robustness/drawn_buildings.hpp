#pragma once

#include <filesystem>
#include <random>
#include <vector>

#include "app/trajectory_file.hpp"
#include "mapping/wall_map/wall.hpp"
#include "sensors/log_record.hpp"

namespace madori::bench {

using Records = std::vector<sensors::LogRecord>;

/// All records of a CARMEN log.
[[nodiscard]] Records load_records(const std::filesystem::path& file);

/// What is done to a layout picture before its walls are looked for, pixels.
struct PictureHarm {
  int blur_px = 0;     ///< standard deviation
  int thinner_px = 0;  ///< ink worn away from each side; negative: grown
};
/// The walls of a layout picture, metres.
[[nodiscard]] mapping::Walls picture_walls(const std::filesystem::path& picture, double m_per_px,
                                           const PictureHarm& harm = {});

/// The straight walls that the log's scans show from the poses of a reference: a drawing for a building of
/// which there is none. `truth` is in the frame that the drawing gets.
[[nodiscard]] mapping::Walls walls_from_log(const Records& log, const std::vector<app::StampedPose>& truth);

/// How a drawing lies. Metres.
struct Lies {
  double bend_m = 0.0;      ///< amplitude of a smooth displacement, wave lengths of 8 to 30 m
  double shift_m = 0.0;     ///< sigma of each wall's own shift along its normal
  double missing = 0.0;     ///< share of the walls that are not drawn
  double shortest_m = 0.0;  ///< shorter walls are not drawn
  double scale = 1.0;       ///< about the middle of the drawing
};
[[nodiscard]] mapping::Walls lie(const mapping::Walls& walls, const Lies& lies, std::mt19937& engine);
/// The place on a drawing that was scaled about its middle.
[[nodiscard]] Point2<Map> scaled_about_middle(const mapping::Walls& walls, const Point2<Map>& p,
                                              double scale);

}  // namespace madori::bench
