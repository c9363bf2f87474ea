#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/point2.hpp"
#include "simulation/frames.hpp"

namespace madori::simulation {

enum class Material : std::uint8_t { Wall, Floor, Metal, Wood, Glass, Cloth };
inline constexpr std::size_t kMaterials = 6;

/// What a VLP-16 says of a surface: 0 ... 100 diffuse.
[[nodiscard]] constexpr std::uint8_t reflectivity(Material material) {
  constexpr std::array<std::uint8_t, kMaterials> kValues{45, 20, 70, 35, 8, 30};
  return kValues[static_cast<std::size_t>(material)];
}

struct Vertex {
  float x_m = 0.0F, y_m = 0.0F, z_m = 0.0F;
};

struct Triangle {
  std::array<std::uint32_t, 3> corners{};
};

/// Heights above the floor.
struct HeightRange {
  double low_m = 0.0;
  double high_m = 0.0;
};

/// Triangles of everything that never moves, Building frame, z up.
struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;
  std::vector<Material> materials;  ///< one a triangle

  void add_quad(const std::array<Vertex, 4>& corners, Material material);
  /// A vertical sheet above a line.
  void add_sheet(const Segment2<Building>& line, const HeightRange& z, Material material);
  /// A convex floor outline, extruded, with its top (and its underside when it hovers).
  void add_prism(const std::vector<Point2<Building>>& outline, const HeightRange& z, Material material);
  /// A horizontal rectangle between two opposite corners.
  void add_level(const Point2<Building>& low, const Point2<Building>& high, double z_m, Material material);
};

}  // namespace madori::simulation
