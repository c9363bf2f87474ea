#pragma once

#include <string>
#include <vector>

#include "localization/localizer/options.hpp"
#include "tests/bench/robustness/drawn_buildings.hpp"
#include "tests/bench/robustness/log_harm.hpp"

namespace madori::bench {

/// One line of the table: what is wrong with the log, the drawing and the start. The start is off by metres
/// along the Map axes and degrees.
struct Case {
  std::string name;
  LogHarm log{};
  Lies lies{};
  PictureHarm picture{};
  double start_x_m = 0.35, start_y_m = 0.35, start_deg = 10.0;
  bool has_drawing = true;
  unsigned seed = 1;
  localization::LocalizerOptions options{};
  int laps = 1;  ///< the log again and again, each time on the memory of the drives before
};

/// Starts, wheels and scans made worse, and the log over again on its own memory.
[[nodiscard]] std::vector<Case> log_harms();
/// Half a metre in ten directions and ten degrees to either side.
[[nodiscard]] std::vector<Case> ten_starts();
/// The drawing scaled, bent, and its walls missing or shifted.
[[nodiscard]] std::vector<Case> drawing_harms();
/// A layout as one finds them: long walls only, some missing, each somewhat off, all of it bent.
[[nodiscard]] std::vector<Case> rough_drawings();

}  // namespace madori::bench
