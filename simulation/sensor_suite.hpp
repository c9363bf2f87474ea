#pragma once

#include <optional>
#include <vector>

#include "simulation/lidar/plane_scanner.hpp"
#include "simulation/lidar/vlp16_model.hpp"
#include "simulation/mailbox.hpp"

namespace madori::simulation {

/// A VLP-16 on a mast, an LMS1xx at the front, an S300 below it: for sites that list no sensors yet.
[[nodiscard]] std::vector<mapping::SensorRecord> default_sensors(const mapping::VehicleRecord& vehicle);

/// The vehicle's lidars: measures what is due and sends the telegrams. A kind that the simulation does not
/// know stays silent.
class SensorSuite {
 public:
  SensorSuite(const Scenario& scenario, const mapping::VehicleRecord& vehicle,
              const std::vector<mapping::SensorRecord>& sensors, std::uint64_t seed, Stamp epoch);

  /// Everything whose last beam lies at or before `now`.
  void measure_until(Duration now, const View& view, Mailbox& out);
  /// How the first sensor of that type is mounted; nothing when there is none.
  [[nodiscard]] std::optional<mapping::SensorRecord> mounting(Device device) const;
  /// All of them, with the settings that they measure by.
  [[nodiscard]] const std::vector<mapping::SensorRecord>& sensors() const { return sensors_; }

 private:
  struct Scanner {
    mapping::SensorRecord record;
    std::size_t unit;  ///< among those of its kind
    PlaneScanner scanner;
    std::vector<std::uint16_t> in_fields;  ///< which field each beam of the scan before ended in
  };
  void add(Device device, const mapping::SensorRecord& record, std::size_t unit, std::uint64_t seed,
           Duration hour_offset);
  [[nodiscard]] std::vector<std::uint8_t> lms_telegram(const Scanner& lms, const std::vector<Echo>& echoes,
                                                       Duration start, Duration now);
  [[nodiscard]] std::vector<std::uint8_t> s300_telegram(Scanner& s300, const std::vector<Echo>& echoes,
                                                        bool standby);
  /// The fields that each beam of this scan reports.
  [[nodiscard]] std::vector<std::uint16_t> sampled_fields(Scanner& s300,
                                                          const std::vector<Echo>& echoes) const;
  [[nodiscard]] std::uint16_t field_bits(const mapping::SensorRecord& at, float range_m,
                                         double angle_rad) const;

  Scenario scenario_;
  mapping::VehicleRecord vehicle_;
  std::vector<mapping::SensorRecord> sensors_;
  std::vector<Vlp16Model> vlp16_;
  std::vector<Scanner> lms_;
  std::vector<Scanner> s300_;
};

}  // namespace madori::simulation
