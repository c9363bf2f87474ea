// Rays against a brute-force oracle: every triangle, one by one, in double precision.
#include "simulation/world/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/random.hpp"
#include "simulation/world/body.hpp"

namespace madori::simulation {
namespace {

constexpr std::size_t kLanes = RayPacket::kLanes;
using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Moeller-Trumbore; infinity on a miss.
double range_to_triangle(const Vector& origin, const Vector& direction, const std::array<Vector, 3>& t) {
  const Vector e1 = minus(t[1], t[0]), e2 = minus(t[2], t[0]), p = cross(direction, e2);
  const double determinant = dot(e1, p);
  if (std::abs(determinant) < 1e-15) return Hit::kNothing;
  const Vector s = minus(origin, t[0]), q = cross(s, e1);
  const double u = dot(s, p) / determinant, v = dot(direction, q) / determinant;
  const double range = dot(e2, q) / determinant;
  const bool inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && range > 0.0;
  return inside ? range : static_cast<double>(Hit::kNothing);
}

double brute_force(const Mesh& mesh, const Vector& origin, const Vector& direction, bool glass) {
  double best = Hit::kNothing;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if ((mesh.materials[i] == Material::Glass) != glass) continue;
    std::array<Vector, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vertex& v = mesh.vertices[mesh.triangles[i].corners[k]];
      corners[k] = {v.x_m, v.y_m, v.z_m};
    }
    best = std::min(best, range_to_triangle(origin, direction, corners));
  }
  return best;
}

Mesh random_mesh(Random& random) {
  Mesh mesh;
  for (int i = 0; i < 120; ++i) {
    const Point2<Building> a{random.uniform(-20, 20), random.uniform(-20, 20)};
    const Point2<Building> b{a.x_m + random.uniform(-4, 4), a.y_m + random.uniform(-4, 4)};
    mesh.add_sheet({a, b}, {0.0, random.uniform(0.5, 5.0)}, i % 5 == 0 ? Material::Glass : Material::Wall);
  }
  for (int i = 0; i < 20; ++i) {
    const Body box{"",
                   {random.uniform(-20, 20), random.uniform(-20, 20)},
                   random.uniform(0, 3),
                   0.8,
                   0.4,
                   {0.0, 1.0},
                   false,
                   Material::Wood};
    mesh.add_prism(outline(box), {0.0, random.uniform(0.2, 2.0)}, Material::Wood);
  }
  mesh.add_level({-25, -25}, {25, 25}, 0.0, Material::Floor);
  return mesh;
}

struct Aim {
  Vector origin{}, direction{};
};

Aim random_aim(Random& random) {
  const double azimuth = random.uniform(0.0, 6.28), elevation = random.uniform(-0.4, 0.4);
  // Through float, as the caster sees them.
  const auto f = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  return {{f(random.uniform(-18, 18)), f(random.uniform(-18, 18)), f(random.uniform(0.1, 3.0))},
          {f(std::cos(elevation) * std::cos(azimuth)), f(std::cos(elevation) * std::sin(azimuth)),
           f(std::sin(elevation))}};
}

TEST(RayCaster, MeetsWhatBruteForceMeets) {
  Random random(3, 0, 0);
  int missed = 0, through_glass = 0, different = 0, rays_cast = 0;
  for (int round = 0; round < 5; ++round) {
    const Mesh mesh = random_mesh(random);
    const RayCaster caster(mesh);
    for (int batch = 0; batch < 60; ++batch) {
      RayPacket rays;
      std::array<Aim, kLanes> aims;
      for (std::size_t i = 0; i < kLanes; ++i) {
        aims[i] = random_aim(random);
        const auto& [o, d] = aims[i];
        rays.x_m[i] = static_cast<float>(o[0]), rays.y_m[i] = static_cast<float>(o[1]);
        rays.z_m[i] = static_cast<float>(o[2]), rays.dx[i] = static_cast<float>(d[0]);
        rays.dy[i] = static_cast<float>(d[1]), rays.dz[i] = static_cast<float>(d[2]);
      }
      std::array<Hit, kLanes> hits;
      caster.cast(rays, hits);
      for (std::size_t i = 0; i < kLanes; ++i) {
        const double solid = brute_force(mesh, aims[i].origin, aims[i].direction, false);
        double glass = brute_force(mesh, aims[i].origin, aims[i].direction, true);
        if (glass > solid) glass = Hit::kNothing;
        const auto same = [](double a, double b) { return a == b || std::abs(a - b) < 2e-4; };
        // A ray along an edge may fall on either side of it; that is all that may differ.
        different += same(hits[i].range_m, solid) && same(hits[i].glass_m, glass) ? 0 : 1;
        missed += hits[i].range_m == Hit::kNothing ? 1 : 0;
        through_glass += hits[i].glass_m < hits[i].range_m ? 1 : 0;
        ++rays_cast;
      }
    }
  }
  EXPECT_EQ(rays_cast, 2400);
  EXPECT_LE(different, 2);
  EXPECT_GT(missed, 50);
  EXPECT_GT(through_glass, 50);
}

TEST(RayCaster, AnEmptyMeshMeetsNothing) {
  const RayCaster caster{Mesh{}};
  RayPacket rays;
  rays.dx.fill(1.0F);
  std::array<Hit, kLanes> hits;
  caster.cast(rays, hits);
  for (const Hit& hit : hits) EXPECT_EQ(hit.range_m, Hit::kNothing);
}

/// The first point along the ray that lies in the body, by small steps.
double walk_to(const Body& body, const Ray& ray) {
  for (double t = 0.0; t < 12.0; t += 1e-3) {
    const double x = ray.x_m + t * ray.dx - body.centre.x_m, y = ray.y_m + t * ray.dy - body.centre.y_m;
    const double z = ray.z_m + t * ray.dz;
    const double c = std::cos(body.yaw_rad), s = std::sin(body.yaw_rad);
    const bool in_floor = body.round ? std::hypot(x, y) < body.half_length_m
                                     : std::abs(c * x + s * y) < body.half_length_m &&
                                           std::abs(c * y - s * x) < body.half_width_m;
    if (in_floor && z > body.z.low_m && z < body.z.high_m) return t == 0.0 ? Hit::kNothing : t;
  }
  return Hit::kNothing;
}

TEST(Body, RaysMeetItWhereSmallStepsDo) {
  Random random(11, 0, 0);
  int met = 0;
  for (int i = 0; i < 300; ++i) {
    Body body{
        "",  {random.uniform(-3, 3), random.uniform(-3, 3)},       random.uniform(0, 3), 1.2,
        0.7, {random.uniform(0.0, 0.5), random.uniform(0.8, 2.0)}, i % 2 == 0,           Material::Cloth};
    const Aim aim = random_aim(random);
    const Ray ray{random.uniform(-4, 4), random.uniform(-4, 4), 1.0,
                  aim.direction[0],      aim.direction[1],      aim.direction[2]};
    const double expected = walk_to(body, ray), got = range_to(body, ray);
    if (expected == Hit::kNothing && got != Hit::kNothing) {
      EXPECT_LT(walk_to(body, ray), 12.0) << "only a touched corner may be met by one of the two";
      continue;
    }
    if (expected != Hit::kNothing) {
      EXPECT_NEAR(got, expected, 2e-3);
    }
    met += expected != Hit::kNothing ? 1 : 0;
  }
  EXPECT_GT(met, 30);
}

}  // namespace
}  // namespace madori::simulation
