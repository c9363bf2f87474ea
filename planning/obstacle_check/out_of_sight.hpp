#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/lidar_model.hpp"
#include "core/transform2.hpp"
#include "planning/obstacle_check/moving_objects.hpp"

namespace madori::planning {

/// Who walked to where no lidar can see him: beside a mast whose lowest laser passes over his head. Whoever
/// leaves such a place is seen leaving it; until then he is believed anywhere on the way he had, as far as he
/// could have come by now; and for a while somewhere near, if he turned.
class OutOfSight {
 public:
  /// After a look of one lidar at what moves.
  void update(const MovingObjects& objects, std::span<const LidarModel> lidars,
              const Transform2<Odom, Base>& odom_from_base, Stamp now);
  /// Outlines of all places where somebody may stand.
  [[nodiscard]] const std::vector<Point2<Odom>>& points() const { return points_; }
  /// Whether somebody may be near, unseen.
  [[nodiscard]] bool anyone() const { return !walkers_.empty(); }
  void clear();
  /// What is remembered, and going on with what was remembered at another time.
  [[nodiscard]] const std::vector<LostMover>& walkers() const { return walkers_; }
  void restore(std::vector<LostMover> walkers, std::vector<Point2<Odom>> points) {
    walkers_ = std::move(walkers), points_ = std::move(points);
  }

 private:
  std::vector<LostMover> walkers_;
  std::vector<Point2<Odom>> points_;
};

}  // namespace madori::planning
