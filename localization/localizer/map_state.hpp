#pragma once

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
  /// Did the drawing explain the memory before? Only then is it any use for finding the place again.
  [[nodiscard]] bool drawing_fits(const HealthLimits& limits) const;

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
