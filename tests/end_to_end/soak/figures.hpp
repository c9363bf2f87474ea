#pragma once

#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace madori::soak {

/// Counts of small lengths, in steps of 1 mm up to 1 m, so that figures of many days can be added up.
class Spread {
 public:
  void add(double value_m);
  [[nodiscard]] nlohmann::json json() const;

 private:
  static constexpr int kBins = 1000;
  std::array<long, kBins + 1> counts_{};
  double sum_m_ = 0.0;
  double most_m_ = 0.0;
  long count_ = 0;
};

struct Help {
  int delivery = 0;
  std::string reason;
  bool every_way_blocked = false;
};

/// What is measured over a day.
struct Figures {
  int day = 0;
  int asked = 0;
  int delivered = 0;
  std::vector<std::string> undelivered;
  std::vector<std::string> collisions_moving;    ///< the vehicle moved
  std::vector<std::string> collisions_standing;  ///< somebody ran into the standing vehicle
  int near_misses = 0;  ///< times that something came within 0.1 m of the moving vehicle
  std::vector<Help> help;
  std::vector<double> found_after_s;  ///< of the kidnappings
  int kidnapped = 0;
  int dropouts = 0;
  int dropouts_survived = 0;  ///< the delivery was made without help
  int persons = 0, pallets = 0;
  int detours = 0, other_routes = 0;
  double driven_m = 0.0, simulated_s = 0.0, wall_s = 0.0, cpu_s = 0.0;
  double sure_but_wrong_s = 0.0;  ///< localized, and more than 0.5 m off, but for 3 s after a kidnapping
  Spread off_route;               ///< of the true Base origin from the path, while driving on the route
  Spread pose_error;              ///< while localized, from 3 s after a kidnapping on
  Spread goal_error;
  std::vector<double> goal_error_deg;
  std::vector<double> delivery_s;
  std::map<std::string, double> standstill_s;
  long memory_kib = 0;
  long database_bytes = 0;
  nlohmann::json living_map;  ///< against the truth of the day; null where none is made
};

[[nodiscard]] nlohmann::json to_json(const Figures& figures);

/// Of this process, from /proc.
[[nodiscard]] long resident_kib();
[[nodiscard]] double cpu_seconds();

}  // namespace madori::soak
