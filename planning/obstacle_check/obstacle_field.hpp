#pragma once

#include <utility>
#include <vector>

#include "core/frames.hpp"
#include "core/point_cloud.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/column_layer.hpp"
#include "planning/obstacle_check/ground_plane.hpp"
#include "planning/obstacle_check/sight_history.hpp"

namespace madori::planning {

struct FieldOptions {
  double cell_m = 0.1;
  double reach_m = 8.0;              ///< around the vehicle; beyond it everything is forgotten
  double ground_clearance_m = 0.07;  ///< lower things are driven over
  double top_m = 0.9;     ///< height of vehicle and load with some room; higher things are driven under
  int fewest_points = 3;  ///< within neighbouring cells of one scan, else it is a stray point
  int misses_to_forget = 2;
  double tall_m = 0.5;         ///< what reaches higher is tall
  double foot_memory_s = 1.0;  ///< how long an unseen foot counts after its tall part has gone
  double body_top_m = 1.9;     ///< height of a person: near the lidar only the upper part is in view
  double body_reach_m = 3.0;   ///< around the lidar, where the upper part is looked for
  double hidden_m = 0.4;  ///< so far a body goes on of which only the far side was seen: a person's breadth
  SightOptions sight;
};

/// What stands around the vehicle: from the scans, the floor taken away, single stray points left out. Low
/// things that have come into the sensors' blind zone before the bumper are kept until a sensor sees the
/// place again. What came to a place that was seen empty is marked; where only its part above the vehicle's
/// height is in view, a foot is assumed below it. What was only ever seen from above, where the lowest beam
/// just passes over it, may go on below it towards the lidar.
class ObstacleField {
 public:
  explicit ObstacleField(const FieldOptions& options = {}) : options_(options), sights_(options.sight) {}

  /// Takes one scan. Points and view in the Base frame at the scan, `odom_from_base` the pose at the scan.
  /// `within`: returns that the vehicle's outline holds. They make no obstacle, for the vehicle may see
  /// itself; but a known one that they fall on is there: what stands against the side is noisy, and partly
  /// within.
  void update(const PointCloud<Base>& scan, const SensorView& view,
              const Transform2<Odom, Base>& odom_from_base, const std::vector<Point2<Base>>& within = {});
  /// What stands so near to a place; what is seen comes back with the next scan.
  void forget_near(const Point2<Odom>& place, double radius_m);
  /// What the vehicle has run against without having seen it: low bodies that are remembered like those that
  /// have come too near to be seen.
  void add_felt(const std::vector<Point2<Odom>>& places, Stamp now);
  /// Goes on with what was remembered at another time.
  void restore(std::vector<Column> columns, Ring<SightHistory::Sight> sights) {
    columns_ = std::move(columns);
    sights_.restore(std::move(sights));
  }

  /// Sorted by cell; only confirmed ones count as obstacles.
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const SightHistory& sights() const { return sights_; }
  [[nodiscard]] const GroundPlane& ground() const { return ground_; }
  [[nodiscard]] const FieldOptions& options() const { return options_; }

 private:
  void take_scan(const PointCloud<Base>& scan, const SensorView& view,
                 const Transform2<Odom, Base>& odom_from_base);
  void note_what_stood(const Point2<Odom>& lidar, Stamp now);
  void note_what_came_over(const Point2<Odom>& lidar, double lidar_z_m, Stamp now);
  void take_within(const std::vector<Point2<Base>>& within, const Transform2<Odom, Base>& odom_from_base,
                   Stamp now);
  [[nodiscard]] bool holds_returns_within(const Column& column) const {
    return within_.find(column.cell_x, column.cell_y) != nullptr;
  }
  /// Adds them to seen_.
  void assume_feet(const SensorView& view, const Transform2<Odom, Base>& odom_from_base, Stamp now);
  [[nodiscard]] bool is_under_something(const Column& column) const;
  /// Of merged_: which go on where they cannot be seen.
  void note_hidden_parts(const SensorView& view, const Transform2<Odom, Base>& odom_from_base, Stamp now);
  [[nodiscard]] std::int32_t cell_of(double at_m) const;
  [[nodiscard]] bool is_known(const Point2<Odom>& place) const;
  void keep_unseen_part(Column& fresh, const Column& old, const SensorView& view,
                        const Transform2<Base, Odom>& base_from_odom) const;
  [[nodiscard]] bool may_reach_up(const Column& column, const SensorView& view,
                                  const Transform2<Base, Odom>& base_from_odom) const;
  [[nodiscard]] bool has_entered(const Column& column, const SensorView& view,
                                 const Transform2<Base, Odom>& base_from_odom, Stamp now) const;
  [[nodiscard]] bool keep(Column& old, const SensorView& view, const Transform2<Base, Odom>& base_from_odom,
                          Stamp now) const;

  FieldOptions options_;
  GroundPlane ground_;
  SightHistory sights_;
  std::vector<Column> columns_;
  ColumnLayer low_;                    ///< of the scan at hand: up to the vehicle's height
  ColumnLayer high_;                   ///< ... from there to a person's, near the lidar
  ColumnLayer level_;                  ///< ... as high as the lidar and higher, near it
  ColumnLayer within_;                 ///< ... within the vehicle's outline
  ColumnLayer over_;                   ///< of high_: as high as the lidar, and did not stand there before
  ColumnLayer stood_;                  ///< before the scan at hand, and was never seen to come
  std::vector<Column> seen_, merged_;  ///< room for one update
};

}  // namespace madori::planning
