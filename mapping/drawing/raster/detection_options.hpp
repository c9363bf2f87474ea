#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace madori::mapping {

/// Somebody points at a line of the drawing and says what it is. Pixels of the drawing.
struct LineTouch {
  double u = 0, v = 0;
  bool wall = true;
};

/// The choices of read_drawing. An empty optional means: measured on the drawing itself.
struct DetectionOptions {
  /// Shorter walls are dropped, pixels. Higher removes debris and short wall stubs.
  std::optional<double> min_wall_length_px;
  /// Two pieces of one straight line with a smaller gap between them are one wall, pixels.
  std::optional<double> close_gap_px;
  /// The wall model that judges; empty: the one that is built in.
  std::filesystem::path model;
  /// What a wrong wall weighs against a missed one. Higher leaves more out, 0 keeps every line.
  std::optional<double> strictness;
  /// Lines that somebody has named: those like them are judged alike.
  std::vector<LineTouch> touches;
  /// Walls within a few tenths of a degree of the drawing's main directions are turned onto them. The walls
  /// stay in the pixels of the drawing as it is: the skew is measured and reported, never rotated away.
  bool straighten = true;

  /// Why these options make no sense; empty when they do.
  [[nodiscard]] std::string why_invalid() const {
    const auto outside = [](const std::optional<double>& value, double high) {
      return value && !(*value >= 0 && *value <= high);
    };
    if (outside(min_wall_length_px, 1e6)) return "the shortest wall must be 0 pixels or more";
    if (outside(close_gap_px, 1e4)) return "the gap to close must be 0 pixels or more";
    if (outside(strictness, 1e3)) return "the strictness must be 0 or more";
    return {};
  }
  [[nodiscard]] bool is_valid() const { return why_invalid().empty(); }
};

}  // namespace madori::mapping
