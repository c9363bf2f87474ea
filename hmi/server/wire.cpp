#include "hmi/server/wire.hpp"

#include <bit>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

namespace madori::hmi {
namespace {

using nlohmann::json;
static_assert(std::endian::native == std::endian::little, "scan_frame copies the machine's own byte order");

constexpr std::size_t kMostParticles = 400;
constexpr std::size_t kMostPathPoints = 400;

/// At most `most` points, evenly chosen, the last one included: a picture needs no more.
json thinned(const std::vector<Point2<Map>>& points, std::size_t most) {
  json list = json::array();
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  for (std::size_t i = 0; i < points.size(); i += stride) list.push_back({points[i].x_m, points[i].y_m});
  if (!points.empty() && (points.size() - 1) % stride != 0)
    list.push_back({points.back().x_m, points.back().y_m});
  return list;
}

json pose_to_wire(const PoseEstimate& pose, Stamp now) {
  const auto& c = pose.covariance;
  return {{"x", pose.map_from_base.x_m()},          {"y", pose.map_from_base.y_m()},
          {"yaw", pose.map_from_base.yaw_rad()},    {"covariance", {c(0, 0), c(0, 1), c(1, 1), c(2, 2)}},
          {"health", to_string(pose.health.state)}, {"health_reason", pose.health.reason},
          {"age_s", to_seconds(now - pose.stamp)}};
}

json particles_to_wire(const std::vector<Transform2<Map, Base>>& particles) {
  json list = json::array();
  const std::size_t stride = std::max<std::size_t>(1, particles.size() / kMostParticles);
  for (std::size_t i = 0; i < particles.size(); i += stride)
    list.push_back({particles[i].x_m(), particles[i].y_m(), particles[i].yaw_rad()});
  return list;
}

json devices_to_wire(const std::vector<DeviceStatus>& devices) {
  json list = json::array();
  for (const auto& d : devices)
    list.push_back({{"name", d.name},
                    {"type", d.type},
                    {"healthy", d.healthy},
                    {"age_s", d.age_s},
                    {"detail", d.detail}});
  return list;
}

}  // namespace

json to_wire(const Notice& notice) {
  return {{"code", notice.code}, {"values", notice.values}, {"text", notice.text}};
}

json to_wire(const LiveState& live, Stamp now) {
  json wire{{"stamp", to_seconds(live.stamp)},
            {"state", live.state},
            {"cause", to_wire(live.cause)},
            {"remedy", to_wire(live.remedy)},
            {"since", to_seconds(live.since)},
            {"pose", pose_to_wire(live.pose, now)},
            {"speed", live.velocity.linear_mps},
            {"turn_rate", live.velocity.angular_radps},
            {"battery", nullptr},
            {"emergency_stop", live.emergency_stop},
            {"order", nullptr},
            {"goal", live.goal},
            {"path", thinned(live.path, kMostPathPoints)},
            {"blocked", thinned(live.blocked, kMostPathPoints)},
            {"particles", particles_to_wire(live.particles)},
            {"devices", devices_to_wire(live.devices)}};
  if (live.battery_share) wire["battery"] = *live.battery_share;
  if (live.order_id) wire["order"] = *live.order_id;
  return wire;
}

json to_wire(const OrderView& order) {
  return {
      {"id", order.id},         {"stations", order.stations},           {"status", order.status},
      {"repeat", order.repeat}, {"created", to_seconds(order.created)}, {"detail", to_wire(order.detail)}};
}

json to_wire(const EventView& event) {
  return {{"stamp", to_seconds(event.stamp)},
          {"severity", event.severity},
          {"what", to_wire(event.what)},
          {"remedy", to_wire(event.remedy)}};
}

json to_wire(const StatisticsView& statistics) {
  return {{"deliveries", statistics.deliveries}};
}

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string scan_frame(std::span<const Point2<Map>> scan) {
  const auto count = static_cast<std::uint32_t>(scan.size());
  std::string frame(8 + scan.size() * 8, '\0');
  std::memcpy(frame.data(), "MDS1", 4);
  std::memcpy(frame.data() + 4, &count, 4);
  char* out = frame.data() + 8;
  for (const auto& p : scan) {
    const float xy[2] = {static_cast<float>(p.x_m), static_cast<float>(p.y_m)};
    std::memcpy(out, xy, sizeof xy);
    out += sizeof xy;
  }
  return frame;
}

}  // namespace madori::hmi
