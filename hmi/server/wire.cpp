#include "hmi/server/wire.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/clock.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
constexpr std::size_t kMostParticles = 400;
constexpr std::size_t kMostPathPoints = 100;

/// To the millimetre and milliradian: a panel shows no more, and a network carries less.
json rounded(double value) {
  return std::round(value * 1e3) / 1e3;
}

template <class Value>
json or_null(const std::optional<Value>& value) {
  return value ? json(*value) : json(nullptr);
}

/// At most `most` points, evenly chosen, the last one included: a picture needs no more.
json thinned(const std::vector<Point2<Map>>& points, std::size_t most) {
  json list = json::array();
  const std::size_t stride = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  for (std::size_t i = 0; i < points.size(); i += stride)
    list.push_back({rounded(points[i].x_m), rounded(points[i].y_m)});
  if (!points.empty() && (points.size() - 1) % stride != 0)
    list.push_back({rounded(points.back().x_m), rounded(points.back().y_m)});
  return list;
}

json pose_to_wire(const PoseEstimate& pose, Stamp now) {
  const auto& c = pose.covariance;
  return {{"x", pose.map_from_base.x_m()},
          {"y", pose.map_from_base.y_m()},
          {"yaw", pose.map_from_base.yaw_rad()},
          {"covariance", {c(0, 0), c(0, 1), c(1, 1), c(2, 2)}},
          {"health", to_string(pose.health.state)},
          {"health_reason", pose.health.reason},
          {"place", rounded(pose.health.place)},
          {"age_s", rounded(std::max(0.0, to_seconds(now - pose.stamp)))}};
}

json particles_to_wire(const std::vector<Transform2<Map, Base>>& particles) {
  json list = json::array();
  const std::size_t stride = std::max<std::size_t>(1, particles.size() / kMostParticles);
  for (std::size_t i = 0; i < particles.size(); i += stride)
    list.push_back(
        {rounded(particles[i].x_m()), rounded(particles[i].y_m()), rounded(particles[i].yaw_rad())});
  return list;
}

json devices_to_wire(const std::vector<DeviceStatus>& devices) {
  json list = json::array();
  for (const auto& d : devices)
    list.push_back({{"name", d.name},
                    {"type", d.type},
                    {"title", d.title},
                    {"healthy", d.healthy},
                    {"age_s", rounded(d.age_s)},
                    {"rate_hz", or_null(d.rate_hz)},
                    {"detail", to_wire(d.detail)}});
  return list;
}

}  // namespace

json to_wire(const Notice& notice) {
  return {{"code", notice.code}, {"values", notice.values}, {"text", notice.text}};
}

json to_wire(const LiveState& live, Stamp now) {
  return {{"stamp", to_seconds(time_of_day(live.stamp))},
          {"state", live.state},
          {"cause", to_wire(live.cause)},
          {"remedy", to_wire(live.remedy)},
          {"since", to_seconds(time_of_day(live.since))},
          {"pose", pose_to_wire(live.pose, now)},
          {"speed", live.velocity ? rounded(live.velocity->linear_mps) : json(nullptr)},
          {"turn_rate", live.velocity ? rounded(live.velocity->angular_radps) : json(nullptr)},
          {"battery_v", or_null(live.battery_v)},
          {"score", or_null(live.score)},
          {"odometer_m", live.odometer_m},
          {"drivable", live.drivable},
          {"mapping", live.mapping},
          {"camera", live.camera},
          {"emergency_stop", live.emergency_stop},
          {"order", or_null(live.order_id)},
          {"goal", live.goal},
          {"path", thinned(live.path, kMostPathPoints)},
          {"blocked", thinned(live.blocked, kMostPathPoints)},
          {"particles", particles_to_wire(live.particles)},
          {"devices", devices_to_wire(live.devices)}};
}

json to_wire(const OrderView& order) {
  json stops = json::array();
  json stations = json::array();
  for (const auto& stop : order.stops) {
    stations.push_back(stop.node);
    stops.push_back(
        {{"node", stop.node}, {"action", stop.action}, {"wait_s", stop.wait_s}, {"gone", stop.gone}});
  }
  return {{"id", order.id},
          {"stations", stations},
          {"stops", stops},
          {"round", order.round},
          {"next_stop", order.next_stop},
          {"status", order.status},
          {"repeat", order.repeat},
          {"created", to_seconds(order.created)},
          {"detail", to_wire(order.detail)}};
}

json to_wire(const EventView& event) {
  return {{"stamp", to_seconds(event.stamp)},
          {"severity", event.severity},
          {"what", to_wire(event.what)},
          {"remedy", to_wire(event.remedy)}};
}

json to_wire(const StatisticsView& statistics) {
  json causes = json::array();
  for (const auto& c : statistics.causes)
    causes.push_back({{"cause", to_wire(c.cause)}, {"count", c.count}, {"seconds", c.seconds}});
  return {{"deliveries", statistics.deliveries},
          {"distance_m", statistics.distance_m},
          {"driving_s", statistics.driving_s},
          {"standing_s", statistics.standing_s},
          {"since", statistics.since ? json(to_seconds(*statistics.since)) : json(nullptr)},
          {"stops", causes}};
}

json to_wire(const LocateView& locate) {
  json places = json::array();
  for (const auto& p : locate.places)
    places.push_back({{"x", p.map_from_base.x_m()},
                      {"y", p.map_from_base.y_m()},
                      {"yaw", p.map_from_base.yaw_rad()},
                      {"score", p.score}});
  return {{"state", locate.state}, {"hypotheses", places}};
}

json to_wire(const WallView& wall) {
  const auto& [a, b] = wall.segment;
  return {{"id", wall.id},
          {"segment", {a.x_m, a.y_m, b.x_m, b.y_m}},
          {"state", wall.state},
          {"share", wall.share},
          {"offset_m", wall.offset_m}};
}

json to_wire(const mapping::SensorRecord& s) {
  json wire{{"name", s.name}, {"type", s.type}, {"x_m", s.x_m},
            {"y_m", s.y_m},   {"z_m", s.z_m},   {"yaw_deg", s.yaw_deg}};
  if (!s.address.empty()) wire["address"] = s.address;
  return wire;
}

json to_wire(const FoundDevice& device) {
  return {{"type", device.type},
          {"title", device.title},
          {"address", device.address},
          {"heard", device.heard},
          {"detail", to_wire(device.detail)},
          {"sensor", device.sensor ? to_wire(*device.sensor) : json(nullptr)}};
}

json to_wire(const LidarView& lidar) {
  json points = json::array();
  for (const auto& p : lidar.points) {
    points.push_back(std::round(p.x_m * 100.0) / 100.0);
    points.push_back(std::round(p.y_m * 100.0) / 100.0);
  }
  return {{"name", lidar.name},
          {"type", lidar.type},
          {"place", lidar.place},
          {"rate_hz", rounded(lidar.rate_hz)},
          {"silence_s", rounded(lidar.silence_s)},
          {"lost", lidar.lost},
          {"refused", lidar.refused},
          {"state", to_wire(lidar.state)},
          {"points", points}};
}

json to_wire(const MountingState& mounting) {
  json rows = json::array();
  for (const auto& row : mounting.rows)
    rows.push_back({{"typed", to_wire(row.typed)},
                    {"found", to_wire(row.found)},
                    {"known", row.known},
                    {"height_known", row.height_known},
                    {"sigma_m", row.sigma_m},
                    {"sigma_deg", row.sigma_deg},
                    {"residual_m", row.residual_m},
                    {"tilt_deg", row.tilt_deg},
                    {"lack", to_wire(row.lack)}});
  return {{"state", mounting.state},
          {"progress", rounded(mounting.progress)},
          {"notice", to_wire(mounting.notice)},
          {"rows", rows}};
}

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace madori::hmi
