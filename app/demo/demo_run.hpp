#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/orders/order.hpp"
#include "core/frames.hpp"
#include "core/point2.hpp"

namespace madori::app {

struct DemoOptions {
  std::filesystem::path site;
  std::filesystem::path scenario;
  std::vector<int> stations;  ///< one order each, in this sequence
  double limit_s = 170.0;     ///< for all of them
};

/// What one transport run came to; errors by the virtual factory's truth.
struct DemoDelivery {
  int node = 0;
  std::string name;
  bool delivered = false;
  double time_s = 0.0;
  double way_m = 0.0;
  double waited_s = 0.0;
  double goal_error_m = 0.0;
};

struct DemoResult {
  std::vector<DemoDelivery> deliveries;
  double localized_after_s = -1.0;  ///< without being told where it stands; negative: never
  double route_mean_m = 0.0;        ///< true distance from the planned path
  double route_max_m = 0.0;
  std::size_t collisions = 0;  ///< while the vehicle moved
  int confirmed = 0;           ///< faults that a person had to look after
  double wall_s = 0.0;
  std::vector<Point2<Map>> driven;  ///< the true way
  std::vector<Point2<Map>> believed;
  std::vector<std::string> events;
  [[nodiscard]] bool all_delivered() const;
};

/// Puts the vehicle of a site into the virtual factory, its devices on real sockets, and has it deliver. The
/// vehicle is not told where it stands; the demo plays the operator, who says Resume and confirms faults.
[[nodiscard]] DemoResult run_demo(const DemoOptions& options);

/// The drawing's walls, the routes, the true way, and the stations, as a PNG.
void draw_demo(const std::filesystem::path& site, const DemoResult& result, const std::filesystem::path& png);

}  // namespace madori::app
