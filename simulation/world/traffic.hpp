#pragma once

#include <optional>
#include <vector>

#include "simulation/scenario/scenario.hpp"
#include "simulation/world/body.hpp"

namespace madori::simulation {

/// Where the vehicle is, for those who wait for it or open doors.
struct VehicleCircle {
  Point2<Building> centre;
  double reach_m = 0.0;
};

/// Somebody who walks or drives a path.
class Mover {
 public:
  Mover(const MoverSpec& spec, const PlanFrames& frames);
  void advance(double now_s, double dt_s, const VehicleCircle& vehicle);
  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] const std::string& name() const { return spec_.name; }

 private:
  void place();
  [[nodiscard]] bool waits_for(const VehicleCircle& vehicle) const;
  [[nodiscard]] double length_m() const { return ends_m_.empty() ? 0.0 : ends_m_.back(); }

  MoverSpec spec_;
  std::vector<Point2<Building>> path_;
  std::vector<double> ends_m_;  ///< way at the end of each leg
  Body body_;
  double way_m_ = 0.0;
  int direction_ = 1;
  double paused_until_s_ = 0.0;
  double waited_s_ = 0.0;  ///< before the vehicle
};

/// An automatic door; its leaf is a thin box, none while it is fully open.
class Door {
 public:
  Door(const DoorSpec& spec, const PlanFrames& frames);
  void advance(double now_s, double dt_s, const VehicleCircle& vehicle, const std::vector<Mover>& movers);
  [[nodiscard]] std::optional<Body> leaf() const;
  /// 0 shut, 1 open.
  [[nodiscard]] double openness() const { return openness_; }
  [[nodiscard]] const std::string& name() const { return spec_.name; }
  /// The opening.
  [[nodiscard]] const Segment2<Building>& line() const { return line_; }

 private:
  [[nodiscard]] double distance_to(const Point2<Building>& p) const;

  DoorSpec spec_;
  Segment2<Building> line_;
  double openness_ = 0.0;
  double wanted_until_s_ = -1.0;
};

}  // namespace madori::simulation
