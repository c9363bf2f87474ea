#pragma once

#include <string>
#include <vector>

#include "simulation/world/mesh.hpp"
#include "simulation/world/ray_caster.hpp"

namespace madori::simulation {

/// An upright shape that may move: an oriented box or a cylinder.
struct Body {
  std::string name;
  Point2<Building> centre;
  double yaw_rad = 0.0;
  double half_length_m = 0.0;  ///< along its own x axis; the radius of a cylinder
  double half_width_m = 0.0;
  HeightRange z;
  bool round = false;
  Material material = Material::Cloth;

  /// The radius of the circle around its floor outline.
  [[nodiscard]] double reach_m() const;
};

/// A ray of unit direction, Building frame.
struct Ray {
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;
  double dx = 1.0, dy = 0.0, dz = 0.0;
};

/// How far along the ray the body begins; Hit::kNothing when it is missed. A ray that starts inside meets
/// nothing.
[[nodiscard]] float range_to(const Body& body, const Ray& ray);

/// The floor outline as a convex polygon, counter-clockwise; a circle becomes 16 corners on it.
[[nodiscard]] std::vector<Point2<Building>> outline(const Body& body);

}  // namespace madori::simulation
