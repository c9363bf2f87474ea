#pragma once

#include <cstdint>
#include <vector>

#include "core/frames.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/ground_plane.hpp"

namespace madori::planning {

/// Which heights a sensor can see, Base frame. A 2D lidar has both elevations zero.
struct SensorView {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double min_elevation_rad = 0.0;
  double max_elevation_rad = 0.0;

  /// Whether something from `low_m` to `high_m` above the floor would be hit by this sensor at that place.
  [[nodiscard]] bool sees(const Point2<Base>& place, double low_m, double high_m) const;
};

/// What stands on a small square of the floor, Odom frame.
struct Column {
  std::int32_t cell_x = 0;
  std::int32_t cell_y = 0;
  float min_x_m = 0.0F, max_x_m = 0.0F, min_y_m = 0.0F, max_y_m = 0.0F;
  float low_m = 0.0F, high_m = 0.0F;  ///< above the floor
  std::int16_t hits = 0;              ///< points of the last scan that saw it
  std::int16_t misses = 0;            ///< scans in a row that should have seen it and did not
  bool confirmed = false;             ///< no stray point
  bool part_of_tall = false;  ///< stood beside something high: the foot of a person, not a body on the floor
  Stamp seen{};               ///< last
  Stamp since{};              ///< first, without a gap

  friend bool operator==(const Column&, const Column&) = default;
};

struct FieldOptions {
  double cell_m = 0.1;
  double reach_m = 8.0;              ///< around the vehicle; beyond it everything is forgotten
  double ground_clearance_m = 0.07;  ///< lower things are driven over
  double top_m = 0.9;         ///< height of vehicle and load with some room; higher things are driven under
  double self_reach_m = 0.0;  ///< returns nearer to the sensor's mount are the vehicle itself
  int fewest_points = 3;      ///< within neighbouring cells of one scan, else it is a stray point
  int misses_to_forget = 2;
  double tall_m = 0.5;         ///< what reaches higher is tall
  double foot_memory_s = 1.0;  ///< how long an unseen foot of something tall counts
  GroundOptions ground;
};

/// What stands around the vehicle: from the scans, the floor taken away, single stray points left out. Low
/// things that have come into the sensors' blind zone before the bumper are kept until a sensor sees the
/// place again.
class ObstacleField {
 public:
  explicit ObstacleField(const FieldOptions& options = {}) : options_(options) {}

  /// Takes one scan. Points and view in the Base frame at the scan, `odom_from_base` the pose at the scan.
  void update(const PointCloud<Base>& scan, const SensorView& view,
              const Transform2<Odom, Base>& odom_from_base);
  void clear() { columns_.clear(); }

  /// Sorted by cell; only confirmed ones count as obstacles.
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const GroundPlane& ground() const { return ground_; }
  [[nodiscard]] const FieldOptions& options() const { return options_; }

 private:
  [[nodiscard]] std::vector<Column> columns_of(const PointCloud<Base>& scan, const SensorView& view,
                                               const Transform2<Odom, Base>& odom_from_base);
  [[nodiscard]] bool keep(Column& old, const SensorView& view, const Transform2<Odom, Base>& odom_from_base,
                          Stamp now) const;

  FieldOptions options_;
  GroundPlane ground_;
  std::vector<Column> columns_;
  std::vector<std::int32_t> scratch_;  ///< cell to column of the scan at hand, -1 where empty
};

}  // namespace madori::planning
