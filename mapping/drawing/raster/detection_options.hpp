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

/// Every automatic choice of detect_walls. An empty optional means: measured on the drawing itself.
struct DetectionOptions {
  /// Ink is darker than this, 1..254. Higher keeps fainter lines and more dirt.
  std::optional<double> threshold;
  /// Shorter walls are dropped, pixels. Higher removes debris and short wall stubs.
  std::optional<double> min_wall_length_px;
  /// A stroke at least this thick is a solid wall with two faces; thinner ones are lines, pixels.
  std::optional<double> min_thickness_px;
  /// Two pieces of one straight line with a smaller gap between them are one wall, pixels.
  std::optional<double> close_gap_px;
  /// Scale where it is known already; guards only against absurd wall thicknesses.
  std::optional<double> m_per_px;
  /// The wall model that decides; empty: the one that is built in, where it does not find the rules' walls
  /// about as good.
  std::filesystem::path model;
  /// What a wrong wall weighs against a missed one. Higher leaves more out, 0 keeps every line; the model
  /// decides.
  std::optional<double> strictness;
  /// Lines that somebody has named: those like them are judged alike; the model decides.
  std::vector<LineTouch> touches;
  bool keep_furniture = false;    ///< furniture, machines and stairs stay walls
  bool keep_dashed = false;       ///< dashed and dash-dot lines stay walls
  bool keep_dimensions = false;   ///< dimension, leader and extension lines stay walls
  bool keep_outer_faces = false;  ///< faces of thick solid outer walls that nobody inside can see
  /// Walls within a few tenths of a degree of the drawing's main directions are turned onto them. The walls
  /// stay in the pixels of the drawing as it is: the skew is measured and reported, never rotated away.
  bool straighten = true;

  /// Why these options make no sense; empty when they do.
  [[nodiscard]] std::string why_invalid() const;
  [[nodiscard]] bool is_valid() const { return why_invalid().empty(); }
};

}  // namespace madori::mapping
