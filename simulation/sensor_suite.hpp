#pragma once

#include <optional>
#include <vector>

#include "simulation/lidar/plane_scanner.hpp"
#include "simulation/lidar/vlp16_model.hpp"
#include "simulation/mailbox.hpp"

namespace madori::simulation {

/// A VLP-16 on a mast, an LMS1xx at the front, an S300 below it: for sites that list no sensors yet.
[[nodiscard]] std::vector<mapping::SensorRecord> default_sensors(const mapping::VehicleRecord& vehicle);

/// The vehicle's lidars: measures what is due and sends the telegrams. One of each type at most.
class SensorSuite {
 public:
  SensorSuite(const Scenario& scenario, const mapping::VehicleRecord& vehicle,
              const std::vector<mapping::SensorRecord>& sensors, std::uint64_t seed, Stamp epoch);

  /// Everything whose last beam lies at or before `now`.
  void measure_until(Duration now, const View& view, Mailbox& out);
  /// How the sensor of that type is mounted; nothing when there is none.
  [[nodiscard]] std::optional<mapping::SensorRecord> mounting(Device device) const;

 private:
  [[nodiscard]] std::vector<std::uint8_t> lms_telegram(const std::vector<Echo>& echoes, Duration start,
                                                       Duration now);
  [[nodiscard]] std::vector<std::uint8_t> s300_telegram(const std::vector<Echo>& echoes, bool standby);
  [[nodiscard]] std::uint16_t field_bits(float range_m, double angle_rad) const;

  Scenario scenario_;
  mapping::VehicleRecord vehicle_;
  std::vector<mapping::SensorRecord> sensors_;
  std::optional<Vlp16Model> vlp16_;
  std::optional<PlaneScanner> lms_;
  std::optional<PlaneScanner> s300_;
};

}  // namespace madori::simulation
