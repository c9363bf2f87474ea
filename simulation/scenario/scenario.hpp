#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/point2.hpp"
#include "simulation/frames.hpp"

/// What a scenario file says (docs/reference/scenario.md). Positions are Plan coordinates, as they are read
/// off the drawing; sizes and heights are true metres. The defaults here are the documented ones.
namespace madori::simulation {

struct MovedWalls {
  std::vector<int> ids;
  double dx_m = 0.0, dy_m = 0.0;
};

/// How the true building differs from its drawing.
struct BuildingSpec {
  std::filesystem::path walls_file;  ///< true walls, Plan frame; empty: those of the site, Map frame
  double wall_height_m = 6.0;
  double ceiling_height_m = 6.0;
  double scale_error_x_percent = 0.0;  ///< how much longer the building is than its drawing
  double scale_error_y_percent = 0.0;
  std::vector<int> missing_walls;
  std::vector<MovedWalls> moved_walls;
  std::vector<Segment2<Plan>> added_walls;
};

enum class SolidKind { Machine, Shelf, Pallet, Pillar, Desk, Clutter };

/// A thing that stands on the floor.
struct SolidSpec {
  SolidKind kind = SolidKind::Machine;
  std::string name;
  Point2<Plan> centre;
  double yaw_deg = 0.0;
  double length_m = 1.0, width_m = 1.0, height_m = 1.0;
};

/// A prefabricated office: four thin walls with a doorway in the side that lies at its own -y.
struct OfficeSpec {
  std::string name;
  Point2<Plan> centre;
  double yaw_deg = 0.0;
  double length_m = 6.0, width_m = 4.0, height_m = 2.8, doorway_m = 1.0;
};

struct GlassSpec {
  Segment2<Plan> line;
  double low_m = 0.0, high_m = 2.5;
};

/// A slope that rises along its own x axis and may be driven on.
struct RampSpec {
  Point2<Plan> centre;
  double yaw_deg = 0.0;
  double length_m = 4.0, width_m = 2.0, rise_m = 0.2;
};

/// What stands elsewhere every day. One number of the day gives one arrangement.
struct FurnitureSpec {
  int day = 0;
  int count = 0;                    ///< pallets and carts on free floor
  double hide_walls_percent = 0.0;  ///< share of the walls' length behind clutter
  double clutter_height_m = 1.8;
  double keep_clear_m = 1.2;  ///< from the start and from these lines
  std::vector<std::vector<Point2<Plan>>> keep_clear;
};

enum class DoorKind { Sliding, Lift };

/// A door in the opening between two points. A sliding leaf draws back towards `line.b`; a lift door rises.
struct DoorSpec {
  DoorKind kind = DoorKind::Sliding;
  std::string name;
  Segment2<Plan> line;
  double height_m = 3.0;
  double opening_s = 3.0;      ///< from shut to open
  double trigger_m = 3.0;      ///< opens for vehicle and movers this near; 0: by the clock
  double hold_s = 4.0;         ///< stays open after the last trigger
  double period_s = 30.0;      ///< by the clock: opens every so often, for hold_s
  double stuck_at = 1.0;       ///< share of its opening that it does not get beyond ...
  double stuck_until_s = 0.0;  ///< ... until then
};

enum class MoverKind { Person, Forklift, Cart, Pallet, UprightBody, LyingBody };

/// Walks a path to and fro, or round and round. A path of one point stands.
struct MoverSpec {
  MoverKind kind = MoverKind::Person;
  std::string name;
  std::vector<Point2<Plan>> path;
  double speed_mps = 1.2;
  bool loop = false;
  double pause_s = 0.0;     ///< at the ends
  double start_s = 0.0;     ///< stands until then
  double polite_m = 0.8;    ///< stops this far before the vehicle; 0: walks into it
  double patience_s = 0.0;  ///< turns back after standing so long before the vehicle; 0: stands for ever
  double yaw_deg = 0.0;     ///< of one that stands, Plan frame
};

/// The vehicle as it really is; the site's vehicle record is what everybody believes.
struct VehicleSpec {
  double left_radius_error_percent = 0.0;
  double right_radius_error_percent = 0.0;
  double separation_error_percent = 0.0;
  bool as_recorded = false;  ///< brakes, turns and answers just as the site's record says, no better
  double dead_time_s = 0.0;  ///< from a command until the motors begin to obey
  double motor_lag_s = 0.06;
  double acceleration_mps2 = 1.5;  ///< of an empty vehicle's driven wheels
  double braking_mps2 = 2.5;
  double slip_percent = 0.0;   ///< of both wheels, always
  double slip_noise = 0.0005;  ///< one sigma of a wheel's way, metres a root-metre
  double empty_mass_kg = 150.0;
  double load_kg = 0.0;
  double squat_percent_per_100kg = 0.05;  ///< how much a load shrinks the wheels
  double ground_clearance_m = 0.03;
  int battery_mv = 25'600;
};

/// How a lidar errs. All zero: a perfect one.
struct LidarErrors {
  double noise_m = 0.0;  ///< one sigma
  double dropout = 0.0;  ///< share of the beams that come back empty
  double bias_m = 0.0;   ///< systematic error of a range, at most; of this one device (RangeBias)
  double rain = 0.0;     ///< share of the beams that end at nothing on their way: dust, insects, stray light
  double beam_m = 0.0;   ///< diameter where the beam leaves the device
  double beam_spread_rad = 0.0;  ///< how it grows with the range
  double pitch_deg = 0.0;        ///< nose down: how it truly leans, which site.yaml does not know
  double roll_deg = 0.0;         ///< left side up
};

struct Vlp16Spec : LidarErrors {
  Vlp16Spec()
      : LidarErrors{.noise_m = 0.03,  // data sheet: +-3 cm
                    .dropout = 0.002,
                    .bias_m = 0.03,
                    .rain = 0.0002,
                    .beam_m = 0.0095,
                    .beam_spread_rad = 0.003} {}
  double range_max_m = 100.0;
  double rate_hz = 10.0;
  bool dual_return = false;
  int keep_every_firing = 1;  ///< 4: three of four firings come back empty, for fast soak runs
};

/// Data sheet: statistical 12 mm, systematic 30 mm, beam 8 mm and 15 mrad.
struct Lms1xxSpec : LidarErrors {
  Lms1xxSpec()
      : LidarErrors{.noise_m = 0.012,
                    .dropout = 0.001,
                    .bias_m = 0.03,
                    .rain = 0.0005,
                    .beam_m = 0.008,
                    .beam_spread_rad = 0.015} {}
  double range_max_m = 20.0;
  bool binary = true;  ///< CoLa B; false: CoLa A
};

struct S300Spec : LidarErrors {
  S300Spec()
      : LidarErrors{.noise_m = 0.02,
                    .dropout = 0.001,
                    .bias_m = 0.03,
                    .rain = 0.0005,
                    .beam_m = 0.008,
                    .beam_spread_rad = 0.015} {}
  double range_max_m = 29.9;
  double protective_m = 0.7;  ///< ahead of the vehicle's front
  double warning_m = 1.8;
  double side_m = 0.05;  ///< beside it
};

enum class Device { Vlp16, Lms1xx, S300, Drive };
inline constexpr int kDevices = 4;
[[nodiscard]] const char* to_string(Device device);

enum class FaultKind {
  Silence,        ///< nothing comes from the device
  Drop,           ///< `share` of its packets are lost
  Corrupt,        ///< `share` of its packets have a byte changed
  Checksum,       ///< `share` of its packets carry a wrong checksum (not the VLP-16, which has none)
  Delay,          ///< packets come `delay_s` late
  Duplicate,      ///< `share` of its packets come twice
  Standby,        ///< S300: all values 0x4004
  StuckEncoder,   ///< drive: the angle of `wheel` does not change
  Slip,           ///< drive: `wheel` slips by `share` of its way
  EmergencyStop,  ///< drive: the input is open
  DriveFault,     ///< drive: over-temperature
  Kidnap,         ///< the vehicle is put to `pose` at once
};

enum class Wheel { Left, Right, Both };

struct FaultSpec {
  FaultKind kind = FaultKind::Silence;
  Device device = Device::Vlp16;
  double at_s = 0.0;
  double for_s = 1.0;
  double share = 1.0;
  double delay_s = 0.1;
  Wheel wheel = Wheel::Left;
  Transform2<Plan, Base> pose;
};

struct Scenario {
  std::string name;
  std::uint64_t seed = 1;
  double duration_s = 0.0;  ///< 0: until it is stopped
  Transform2<Map, Plan> map_from_plan;
  Transform2<Plan, Base> start;
  BuildingSpec building;
  std::vector<SolidSpec> solids;
  std::vector<OfficeSpec> offices;
  std::vector<GlassSpec> glass;
  std::vector<RampSpec> ramps;
  FurnitureSpec furniture;
  std::vector<DoorSpec> doors;
  std::vector<MoverSpec> movers;
  VehicleSpec vehicle;
  Vlp16Spec vlp16;
  Lms1xxSpec lms1xx;
  S300Spec s300;
  std::vector<FaultSpec> faults;

  [[nodiscard]] PlanFrames frames() const;
};

/// Reads a scenario file; throws Error with file, line and mend. Unknown keys are refused.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file);

}  // namespace madori::simulation
