#pragma once

#include <vector>

#include "control/drive_link/wire.hpp"
#include "control/limits/limits.hpp"
#include "control/pure_pursuit/pure_pursuit.hpp"
#include "core/velocity_command.hpp"
#include "planning/route_graph/route_graph.hpp"
#include "sensors/vlp16/assembler.hpp"
#include "simulation/drive/drive_device.hpp"
#include "simulation/vehicle/vehicle.hpp"
#include "simulation/world/traffic.hpp"
#include "simulation/world/world.hpp"
#include "tests/support/upper_lasers.hpp"

namespace madori::test {

/// What reaches the vehicle in 20 ms.
struct FloorInput {
  Stamp now{};
  std::vector<control::wire::Status> drive;
  std::vector<PointCloud<Lidar>> clouds;
};

/// The virtual factory for localization alone, some hundred times as fast as time: no sockets, no collisions,
/// one VLP-16 of which only the lasers that aim upwards are measured, since wall extraction looks above the
/// equipment. Wheels, encoders, packets and their decoding are the real ones. Deterministic.
class VirtualFloor {
 public:
  /// `walls` and all poses in the Map frame.
  VirtualFloor(const mapping::Walls& walls, const simulation::Scenario& scenario, std::uint64_t seed);

  /// Goes on by 20 ms with the wheels asked to turn so, and hands out what the cycle would receive.
  [[nodiscard]] FloorInput step(const VelocityCommand& command);
  /// Carries the vehicle there at once; the wheels notice nothing.
  void set_pose(const Transform2<Map, Base>& map_from_base);

  [[nodiscard]] Stamp now() const { return kEpoch + now_; }
  [[nodiscard]] Transform2<Map, Base> truth() const { return truth_at(now()); }
  /// The last 200 ms are known.
  [[nodiscard]] Transform2<Map, Base> truth_at(Stamp stamp) const;
  [[nodiscard]] double driven_m() const { return driven_m_; }
  /// Whether somebody or a door's leaf stands within `reach_m` of the circle `ahead_m` before the vehicle.
  [[nodiscard]] bool is_blocked(double ahead_m, double reach_m) const;
  [[nodiscard]] const simulation::World& world() const { return world_; }
  [[nodiscard]] const mapping::SensorRecord& lidar() const { return lidar_; }

 private:
  static constexpr Stamp kEpoch = Stamp(std::chrono::seconds(1'767'225'600));
  void tick(const control::WheelSpeeds& asked, Duration dt);
  void advance_traffic(double dt_s);

  mapping::VehicleRecord record_;
  mapping::SensorRecord lidar_;
  simulation::World world_;
  simulation::Vehicle vehicle_;
  simulation::DriveDevice drive_;
  UpperLasers vlp16_;
  std::vector<simulation::Mover> movers_;
  std::vector<simulation::Door> doors_;
  std::vector<simulation::Body> bodies_;
  simulation::PoseTrack track_;
  simulation::VehicleState state_;
  std::vector<PointCloud<Lidar>> clouds_;
  sensors::vlp16::Assembler assembler_;
  control::wire::FrameCutter cutter_;
  Duration now_{0};
  std::uint64_t ticks_ = 0;
  double driven_m_ = 0.0;
};

/// Drives a VirtualFloor from station to station along the routes, on the true pose.
class TrueDriver {
 public:
  TrueDriver(const planning::RouteGraph& routes, std::uint64_t seed)
      : routes_(routes), random_(seed, 0xD21, 0) {}

  [[nodiscard]] VelocityCommand command(const VirtualFloor& floor);
  /// After a kidnapping: the way is sought anew.
  void forget() { path_ = {}, turns_back_ = false; }

 private:
  [[nodiscard]] std::size_t start_node(const Transform2<Map, Base>& from, bool is_blocked) const;
  void choose(const Transform2<Map, Base>& from, bool is_blocked);

  const planning::RouteGraph& routes_;
  simulation::Random random_;
  control::PursuitOptions options_;
  control::TrackedPath path_;
  control::PursuitState pursuit_;
  control::LimitState limits_;
  double waited_s_ = 0.0;
  bool turns_back_ = false;
};

}  // namespace madori::test
