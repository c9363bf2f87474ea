#include "tests/end_to_end/soak/figures.hpp"

#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace madori::soak {

void Spread::add(double value_m) {
  ++counts_[static_cast<std::size_t>(std::clamp(value_m * 1000.0, 0.0, 1.0 * kBins))];
  sum_m_ += value_m;
  most_m_ = std::max(most_m_, value_m);
  ++count_;
}

nlohmann::json Spread::json() const {
  nlohmann::json bins = nlohmann::json::array();  // [mm, count] of what is not empty
  for (int i = 0; i <= kBins; ++i)
    if (counts_[static_cast<std::size_t>(i)] > 0) bins.push_back({i, counts_[static_cast<std::size_t>(i)]});
  return {{"count", count_}, {"sum_m", sum_m_}, {"most_m", most_m_}, {"bins_mm", bins}};
}

nlohmann::json to_json(const Figures& f) {
  nlohmann::json help = nlohmann::json::array();
  for (const Help& h : f.help)
    help.push_back(
        {{"delivery", h.delivery}, {"reason", h.reason}, {"every_way_blocked", h.every_way_blocked}});
  return {{"day", f.day},
          {"asked", f.asked},
          {"delivered", f.delivered},
          {"undelivered", f.undelivered},
          {"collisions_moving", f.collisions_moving},
          {"collisions_standing", f.collisions_standing},
          {"near_misses", f.near_misses},
          {"help", help},
          {"found_after_s", f.found_after_s},
          {"kidnapped", f.kidnapped},
          {"dropouts", f.dropouts},
          {"dropouts_survived", f.dropouts_survived},
          {"persons", f.persons},
          {"pallets", f.pallets},
          {"detours", f.detours},
          {"other_routes", f.other_routes},
          {"driven_m", f.driven_m},
          {"simulated_s", f.simulated_s},
          {"wall_s", f.wall_s},
          {"cpu_s", f.cpu_s},
          {"sure_but_wrong_s", f.sure_but_wrong_s},
          {"off_route", f.off_route.json()},
          {"pose_error", f.pose_error.json()},
          {"goal_error", f.goal_error.json()},
          {"goal_error_deg", f.goal_error_deg},
          {"delivery_s", f.delivery_s},
          {"standstill_s", f.standstill_s},
          {"memory_kib", f.memory_kib},
          {"database_bytes", f.database_bytes},
          {"living_map", f.living_map}};
}

long resident_kib() {
  std::ifstream statm("/proc/self/statm");
  long pages = 0, resident = 0;
  statm >> pages >> resident;
  return resident * ::sysconf(_SC_PAGESIZE) / 1024;
}

double cpu_seconds() {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

}  // namespace madori::soak
