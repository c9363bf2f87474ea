#pragma once

#include <cstddef>
#include <optional>

#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/localizer/options.hpp"

namespace madori::localization {

/// The memory and how it lies on the drawing: all that the slow work reads and changes. A copy is cheap.
struct MapState {
  Memory memory;
  std::optional<DrawingFit> drawing;  ///< absent: mapping without a drawing
  InitialPose start;
  HealthEvidence evidence;
  double next_survey_walls = 30.0;  ///< walls seen when all places are looked at again

  /// The slow work, in the worker: closes loops, lays the memory on the drawing, solves the graph.
  void think(const LocalizerOptions& options);
  /// Becomes `thought`, a copy made when this map had `known` keyframes and changed since, and what the scans
  /// have said since then. Returns what moves this map's newest surroundings there.
  Transform2<Map, Map> take_in(MapState thought, std::size_t known);
  /// Did the drawing explain the memory before? Only then is it any use for finding the place again.
  [[nodiscard]] bool drawing_fits(const HealthLimits& limits) const;
  /// Is the drawing exact enough to pull on every scan?
  [[nodiscard]] bool drawing_is_exact(const LocalizerOptions& options) const;

 private:
  void consult_drawing(const LocalizerOptions& options);
  bool correct_recent_drift(const LocalizerOptions& options);
  [[nodiscard]] AlignmentWindow drift_window(const MemoryCloud& recent, std::size_t first,
                                             const LocalizerOptions& options) const;
  void survey_drawing(const MemoryCloud& cloud, const LocalizerOptions& options);
  void look_everywhere(const LocalizerOptions& options);
  [[nodiscard]] double surprise(const Transform2<Map, Base>& first) const;
};

}  // namespace madori::localization
