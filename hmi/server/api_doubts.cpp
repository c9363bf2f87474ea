#include <algorithm>
#include <memory>
#include <mutex>

#include "hmi/server/api.hpp"
#include "hmi/server/api_support.hpp"
#include "hmi/server/doubted_walls.hpp"
#include "hmi/server/site_files.hpp"
#include "hmi/server/standing_walls.hpp"
#include "mapping/days/map_frame.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
using Segment = Segment2<Map>;

json to_wire(const DoubtedWall& wall) {
  json segments = json::array();
  for (const auto& [a, b] : wall.segments) segments.push_back({a.x_m, a.y_m, b.x_m, b.y_m});
  return {{"segments", segments}, {"length_m", wall.segments.front().length_m()}, {"looks", wall.missed}};
}

/// The walls that a person is asked about, and the answers of before.
class Doubts {
 public:
  Doubts(ApiContext& context) : folder_(context.editor.folder()), vehicle_(context.vehicle) {}

  [[nodiscard]] std::vector<DoubtedWall> now() const {
    return doubted_walls(vehicle_.walls_seen(), standing_walls(folder_, frame()));
  }
  /// Only what is asked now can be answered: that bounds the file. False where it is not.
  bool keep_standing(const json& segments, const std::string& date) {
    const std::scoped_lock lock(mutex_);
    const auto asked = now();
    const auto found = std::ranges::find_if(
        asked, [&](const DoubtedWall& wall) { return to_wire(wall)["segments"] == segments; });
    if (found == asked.end()) return false;
    add_standing_walls(folder_, frame(), found->segments, date);
    return true;
  }

 private:
  [[nodiscard]] std::string frame() const { return mapping::map_frame(folder_, mapping::load_site(folder_)); }

  std::filesystem::path folder_;
  Vehicle& vehicle_;
  std::mutex mutex_;  ///< of the file
};

}  // namespace

void add_doubt_routes(Router& router, ApiContext& context) {
  const auto doubts = std::make_shared<Doubts>(context);
  const std::filesystem::path folder = context.editor.folder();
  router.add("GET", "/api/site/walls/doubted", Role::Viewer, answering([doubts, folder](const Request&) {
               json list = json::array();
               if (has_site(folder))
                 for (const DoubtedWall& wall : doubts->now()) list.push_back(to_wire(wall));
               return list;
             }),
             Work::Worker);
  router.add("POST", "/api/site/walls/standing", Role::Operator,
             guarded([doubts, folder, &context](const Request& request) {
               const json segments = body_of(request).at("segments");
               if (!has_site(folder) || !doubts->keep_standing(segments, context.iso_time()))
                 return Response::error(404, "not-found", "nobody asks about this wall any more");
               return answer(json::object());
             }),
             Work::Worker);
}

}  // namespace madori::hmi
