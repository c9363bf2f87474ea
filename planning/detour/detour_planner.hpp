#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "planning/detour/free_space.hpp"
#include "planning/detour/manoeuvre.hpp"
#include "planning/detour/side_detour.hpp"

namespace madori::planning {

/// What a way around is asked for with. Everything is copied, so that the cycle goes on meanwhile.
struct DetourRequest {
  std::uint32_t id = 0;
  Path path;
  std::size_t from = 0;  ///< the vehicle's place on the path
  Transform2<Map, Base> map_from_base;
  PathCheck check;
  std::vector<Point2<Map>> obstacles;
  Squeeze squeeze{};             ///< where the vehicle has come to stand too near to something
  bool any_end_heading = false;  ///< the end of the path may be come to in any heading
  bool turn_free = true;         ///< else the way begins as the vehicle stands: through the free space
  std::shared_ptr<const WallGrid> walls = std::make_shared<const WallGrid>();
};

struct DetourAnswer {
  std::uint32_t id = 0;
  std::optional<Path> path;  ///< from the vehicle to the end of the route; nothing where no way was found
  std::size_t rejoin = 0;    ///< first point of `path` that lies on the route again
  std::string reason;        ///< why no way was found
};

struct DetourOptions {
  SideDetourOptions side;
  FreeSpaceOptions free_space;
  ManoeuvreOptions manoeuvre;
  double room_m = 0.08;  ///< beside the vehicle beyond the margins, where there is so much
};

/// First beside the route, then through the free space, last by a manoeuvre of strokes forward and backward;
/// each with more room than the margins where there is. Always ends: the search is bounded.
[[nodiscard]] DetourAnswer plan_detour(const DetourRequest& request, const CheckOptions& check,
                                       const DetourOptions& options);

/// Runs plan_detour() on a thread of its own, one request at a time.
class DetourPlanner {
 public:
  DetourPlanner(CheckOptions check, DetourOptions options);
  ~DetourPlanner();
  DetourPlanner(const DetourPlanner&) = delete;
  DetourPlanner& operator=(const DetourPlanner&) = delete;

  /// Replaces a request that has not begun.
  void submit(DetourRequest request);
  /// The answer once it is there; never waits.
  [[nodiscard]] std::optional<DetourAnswer> take();

 private:
  void run();

  CheckOptions check_;
  DetourOptions options_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<DetourRequest> request_;
  std::optional<DetourAnswer> answer_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace madori::planning
