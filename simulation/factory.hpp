#pragma once

#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "control/diff_drive/kinematics.hpp"
#include "mapping/site/site.hpp"
#include "mapping/wall_map/wall.hpp"
#include "simulation/drive/drive_device.hpp"
#include "simulation/mailbox.hpp"
#include "simulation/sensor_suite.hpp"
#include "simulation/vehicle/vehicle.hpp"
#include "simulation/world/traffic.hpp"
#include "simulation/world/world.hpp"

namespace madori::simulation {

using WheelCommand = control::WheelSpeeds;

/// Where the vehicle really is.
struct GroundTruth {
  Stamp stamp{};
  Transform2<Map, Base> map_from_base;            ///< on the drawing (PlanFrames::map_pose)
  Transform2<Building, Base> building_from_base;  ///< in true metres
  double linear_mps = 0.0;
  double angular_radps = 0.0;
};

/// The beginning of a contact of the vehicle with something.
struct Collision {
  Stamp stamp{};
  std::string what;
  double speed_mps = 0.0;  ///< of the vehicle's Base; below 0.01 the other one has run into it
  Transform2<Map, Base> map_from_base;
  double turn_radps = 0.0;  ///< of the vehicle, magnitude
};

struct FactorySetup {
  mapping::Walls walls;  ///< Map frame; not looked at where the scenario names true walls
  Scenario scenario;
  mapping::VehicleRecord vehicle;
  std::vector<mapping::SensorRecord> sensors;  ///< empty: default_sensors()
  std::uint64_t seed = 1;
  Stamp epoch = Stamp(std::chrono::seconds(1'767'225'600));  ///< 2026-01-01: the time at the start
};
/// Walls, vehicle and sensors of a site folder with a scenario file; the seed is the scenario's. Throws
/// Error.
[[nodiscard]] FactorySetup load_setup(const std::filesystem::path& site,
                                      const std::filesystem::path& scenario);

/// The virtual factory, in one thread and without a clock of its own: time goes on in step() alone, by ticks
/// of 1 ms, and the same setup and calls give the same bytes. The vehicle obeys either a wheel command given
/// here, or the bytes on its drive link.
class Factory {
 public:
  static constexpr Duration kTick = std::chrono::milliseconds(1);

  explicit Factory(const FactorySetup& setup);

  /// Goes on by `dt` (what is no whole tick is kept for the next call); the drive controller obeys the bytes
  /// of drive_write() and stops by itself after 200 ms without.
  void step(Duration dt);
  /// The same with the wheels asked directly, past the drive controller. Bumper, emergency stop and watchdog
  /// do not hold them.
  void step(Duration dt, const WheelCommand& command);

  /// Bytes from the PC to the drive controller.
  void drive_write(std::span<const std::uint8_t> bytes);
  /// What the devices have sent since the last call, in order of arrival: see Receiver for core types.
  [[nodiscard]] std::vector<DevicePacket> take_packets();

  [[nodiscard]] Stamp now() const { return epoch_ + now_; }
  [[nodiscard]] GroundTruth truth() const;
  [[nodiscard]] const std::vector<Collision>& collisions() const { return collisions_; }
  [[nodiscard]] double distance_driven_m() const { return driven_m_; }
  [[nodiscard]] control::wire::DriveState drive_state() const { return drive_.state(); }
  [[nodiscard]] const VehicleState& vehicle_state() const { return state_; }
  [[nodiscard]] const World& world() const { return world_; }
  [[nodiscard]] const Vehicle& vehicle() const { return vehicle_; }
  [[nodiscard]] const std::vector<Door>& doors() const { return doors_; }
  /// Movers and door leaves as they are now.
  [[nodiscard]] const std::vector<Body>& bodies() const { return bodies_; }
  [[nodiscard]] std::optional<mapping::SensorRecord> mounting(Device device) const {
    return sensors_.mounting(device);
  }

  /// As the site lists them, with the settings that they measure by.
  [[nodiscard]] const std::vector<mapping::SensorRecord>& sensors() const { return sensors_.sensors(); }

  /// Puts the vehicle there at once, standing still; the encoders notice nothing.
  void set_pose(const Transform2<Map, Base>& map_from_base);
  /// From now on, whatever at_s says; at_s and for_s count from now.
  void inject(FaultSpec fault);
  /// Somebody more (Plan coordinates); start_s counts from the start of the simulation.
  void add_mover(const MoverSpec& spec);
  void clear_movers() { movers_.clear(); }
  void remove_mover(const std::string& name);
  /// Whether the vehicle could stand there without touching anything.
  [[nodiscard]] bool is_free(const Transform2<Map, Base>& map_from_base) const;

 private:
  void tick(const WheelCommand* command);
  void apply_kidnapping();
  void advance_traffic();
  void advance_vehicle(const WheelCommand* command);
  [[nodiscard]] std::string touched_at(const Transform2<Building, Base>& pose, bool with_walls) const;
  void look_around(const Transform2<Building, Base>& pose);
  [[nodiscard]] bool is_clear(const Transform2<Building, Base>& pose) const;
  [[nodiscard]] DriveTrouble trouble() const;
  [[nodiscard]] ExtraSlip extra_slip() const;
  [[nodiscard]] WheelCommand obeyed(const WheelCommand& asked);

  FactorySetup setup_;
  Stamp epoch_;
  World world_;
  Vehicle vehicle_;
  SensorSuite sensors_;
  Mailbox mailbox_;
  DriveDevice drive_;
  std::deque<WheelCommand> unheard_;  ///< one a tick, of the last dead time
  std::vector<Mover> movers_;
  std::vector<Door> doors_;
  std::vector<Body> bodies_;
  PoseTrack track_;
  VehicleState state_;
  std::vector<Collision> collisions_;
  std::string touching_;  ///< what the vehicle is in contact with
  double driven_m_ = 0.0;
  Duration now_{0};
  Duration target_{0};
  std::optional<Transform2<Building, Base>> clear_around_;  ///< nothing stands near the vehicle there
};

}  // namespace madori::simulation
