#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace madori::mapping {

/// The imported original, and the pixel grid whose lower-left corner is the Map origin.
struct DrawingRecord {
  std::string file;  ///< name inside the site folder
  int width_px = 0;
  int height_px = 0;
  int page = 1;      ///< of a PDF
  double dpi = 0.0;  ///< 0 where the drawing has none
};

/// How large the drawing is, and how that was found.
struct ScaleRecord {
  double m_per_px = 0.0;
  std::string method;                 ///< option, dxf-units, known, control, overlay, paper
  double relative_uncertainty = 0.0;  ///< one sigma; 0 where unknown
  double residual_m = 0.0;            ///< RMS of the fit
  std::string date;                   ///< ISO 8601, UTC
  std::vector<std::string> inputs;    ///< as they were given
  std::vector<double> residuals_m{};  ///< one an input; empty where nothing was fitted
};

/// The place of the Map origin on Earth (WGS84) and the bearing of its x axis.
struct GeoreferenceRecord {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double enu_from_map_yaw_deg = 0.0;
};

/// Shape and drive of the vehicle. Defaults are the reference vehicle's. Everything that drives takes its
/// physics from here.
struct VehicleRecord {
  double wheel_radius_m = 0.1;
  double half_wheel_separation_m = 0.25;  ///< `d` of the layout-map paper's Eq. (1)-(4)
  double length_m = 1.0;
  double width_m = 0.6;
  double height_m = 0.8;        ///< with load
  double base_to_rear_m = 0.2;  ///< from the Base origin back to the rear bumper
  double max_speed_mps = 1.0;
  double max_acceleration_mps2 = 0.5;
  double max_turn_rate_radps = 1.0;
  double max_deceleration_mps2 = 0.8;  ///< that its brakes surely reach, loaded
  double max_turn_acceleration_radps2 = 1.5;
  double reaction_s = 0.25;  ///< from a command until the wheels obey it
};

/// The record's numbers, each once: their names in files and messages, and what is accepted.
struct VehicleField {
  const char* name;
  double VehicleRecord::*value;
  double least, most;
};
inline constexpr std::array kVehicleFields{
    VehicleField{"wheel_radius_m", &VehicleRecord::wheel_radius_m, 0.005, 2.0},
    VehicleField{"half_wheel_separation_m", &VehicleRecord::half_wheel_separation_m, 0.01, 5.0},
    VehicleField{"length_m", &VehicleRecord::length_m, 0.05, 20.0},
    VehicleField{"width_m", &VehicleRecord::width_m, 0.05, 10.0},
    VehicleField{"height_m", &VehicleRecord::height_m, 0.05, 10.0},
    VehicleField{"base_to_rear_m", &VehicleRecord::base_to_rear_m, 0.0, 20.0},
    VehicleField{"max_speed_mps", &VehicleRecord::max_speed_mps, 0.01, 5.0},
    VehicleField{"max_acceleration_mps2", &VehicleRecord::max_acceleration_mps2, 0.01, 10.0},
    VehicleField{"max_turn_rate_radps", &VehicleRecord::max_turn_rate_radps, 0.01, 10.0},
    VehicleField{"max_deceleration_mps2", &VehicleRecord::max_deceleration_mps2, 0.05, 10.0},
    VehicleField{"max_turn_acceleration_radps2", &VehicleRecord::max_turn_acceleration_radps2, 0.05, 20.0},
    VehicleField{"reaction_s", &VehicleRecord::reaction_s, 0.0, 2.0},
};

static_assert(sizeof(VehicleRecord) == kVehicleFields.size() * sizeof(double), "a number is not listed");

/// A sensor and where it is mounted, Base frame.
struct SensorRecord {
  std::string name;
  std::string type;  ///< a kind of lidar: docs/reference/sensors.md lists them
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double yaw_deg = 0.0;
  double protective_m =
      0.0;  ///< of a safety scanner: how far its protective field reaches ahead of the vehicle's front
  std::string address{};                          ///< HOST:PORT or serial port; empty: the kind's usual one
  std::map<std::string, std::string> settings{};  ///< of its kind, e.g. rate_hz
  double protective_side_m = 0.0;                 ///< ... and how far it reaches beside the vehicle

  friend bool operator==(const SensorRecord&, const SensorRecord&) = default;
};

/// site.yaml of a site folder (docs/reference/site-folder.md).
struct Site {
  std::string name;
  DrawingRecord drawing;
  std::optional<ScaleRecord> scale;  ///< absent: unscaled, nothing may drive on it
  std::optional<GeoreferenceRecord> georeference;
  VehicleRecord vehicle;
  std::vector<SensorRecord> sensors;
  bool shortest_routes = false;  ///< least metres; else fewest legs, as published
  /// Where the verification camera's pictures come from: a URL (http, rtsp) or a device such as /dev/video0;
  /// empty: there is no camera.
  std::string camera;
  /// What guards who lies on the floor, where no lidar sees him: a bumper, a safety field that is not
  /// Madori's, people who are kept out. Empty: nothing does, and the vehicle drives as slowly as that asks.
  std::string low_bodies_guarded_by;
};

/// Reads and checks `folder`/site.yaml; throws Error with file, line and mend.
[[nodiscard]] Site load_site(const std::filesystem::path& folder);
/// The same, and throws an Error that says how to scale the drawing while the site is unscaled.
[[nodiscard]] Site load_scaled_site(const std::filesystem::path& folder);
/// The text of site.yaml.
[[nodiscard]] std::string site_yaml(const Site& site);
/// Throws Error, naming `where`, unless a building can be as large as the drawing is at this scale: 1 m to
/// 10 km along its longer side.
void require_possible_size(const std::string& where, const DrawingRecord& drawing, double m_per_px);
/// Writes `folder`/site.yaml atomically.
void save_site(const std::filesystem::path& folder, const Site& site);

}  // namespace madori::mapping
