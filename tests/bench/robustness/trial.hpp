#pragma once

#include <string>

#include "app/health_log.hpp"
#include "localization/memory/memory.hpp"
#include "tests/bench/robustness/buildings.hpp"
#include "tests/bench/robustness/cases.hpp"

namespace madori::bench {

/// What one drive came to. Metres, milliseconds a scan.
struct Outcome {
  Truth trajectory;
  app::HealthLog health;
  int longest_lost = 0;       ///< scans in a row that were off by more than 2 m
  int wrongly_sure = 0;       ///< scans LOCALIZED while over 1.5 m off
  double worst_sure_m = 0.0;  ///< farthest off while LOCALIZED
  double p50_ms = 0.0, p99_ms = 0.0;
  std::string scans =  ///< a line of CSV a scan: errors, and what it was judged by
      "time_s,x_m,y_m,error_x_m,error_y_m,error_deg,on_walls,on_memory,sigma_m,nats_a_wall,drawing_sigma_m,"
      "here,rival,state,reason\n";
};

/// The building's reference where the case's drawing and log have it.
[[nodiscard]] Truth truth_of(const Building& building, const Case& c);

/// Plays the harmed log to a localizer on the harmed drawing. `memory` is what earlier drives remembered,
/// empty for none, and gets what this one adds.
[[nodiscard]] Outcome play(const Building& building, const Case& c, localization::Memory& memory);

}  // namespace madori::bench
