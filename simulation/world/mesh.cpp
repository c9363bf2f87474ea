#include "simulation/world/mesh.hpp"

namespace madori::simulation {
namespace {

Vertex vertex(const Point2<Building>& p, double z_m) {
  return {static_cast<float>(p.x_m), static_cast<float>(p.y_m), static_cast<float>(z_m)};
}

}  // namespace

void Mesh::add_quad(const std::array<Vertex, 4>& corners, Material material) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), corners.begin(), corners.end());
  triangles.push_back({{first, first + 1, first + 2}});
  triangles.push_back({{first, first + 2, first + 3}});
  materials.insert(materials.end(), 2, material);
}

void Mesh::add_sheet(const Segment2<Building>& line, const HeightRange& z, Material material) {
  add_quad(
      {vertex(line.a, z.low_m), vertex(line.b, z.low_m), vertex(line.b, z.high_m), vertex(line.a, z.high_m)},
      material);
}

void Mesh::add_prism(const std::vector<Point2<Building>>& outline, const HeightRange& z, Material material) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    add_sheet({outline[i], outline[(i + 1) % outline.size()]}, z, material);
  for (const double level : {z.high_m, z.low_m}) {
    if (level <= 0.0) continue;
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const auto& p : outline) vertices.push_back(vertex(p, level));
    for (std::uint32_t i = 2; i < outline.size(); ++i) {
      triangles.push_back({{first, first + i - 1, first + i}});
      materials.push_back(material);
    }
  }
}

void Mesh::add_level(const Point2<Building>& low, const Point2<Building>& high, double z_m,
                     Material material) {
  add_quad({vertex(low, z_m), vertex({high.x_m, low.y_m}, z_m), vertex(high, z_m),
            vertex({low.x_m, high.y_m}, z_m)},
           material);
}

}  // namespace madori::simulation
