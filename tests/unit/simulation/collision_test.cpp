// Collision against brute force: do points sampled densely on one outline lie in the other?
#include "simulation/world/collision.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "simulation/random.hpp"
#include "simulation/world/world.hpp"
#include "tests/support/small_hall.hpp"

namespace madori::simulation {
namespace {

using Outline = std::vector<Point2<Building>>;

/// Least distance between the edges of two outlines, sampled every centimetre; negative when a corner of one
/// lies within the other.
double gap(const Outline& a, const Outline& b) {
  const auto inside = [](const Outline& polygon, const Point2<Building>& p) {
    if (polygon.size() < 3) return false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const auto &u = polygon[i], &v = polygon[(i + 1) % polygon.size()];
      if ((v.x_m - u.x_m) * (p.y_m - u.y_m) - (v.y_m - u.y_m) * (p.x_m - u.x_m) < 0.0) return false;
    }
    return true;
  };
  const auto sample = [](const Outline& o) {
    Outline points;
    for (std::size_t i = 0; i < o.size(); ++i) {
      const auto &u = o[i], &v = o[(i + 1) % o.size()];
      const int steps = std::max(1, static_cast<int>(distance_m(u, v) / 0.01));
      for (int k = 0; k <= steps; ++k)
        points.push_back({u.x_m + (v.x_m - u.x_m) * k / steps, u.y_m + (v.y_m - u.y_m) * k / steps});
    }
    return points;
  };
  double least = 1e9;
  const Outline pa = sample(a), pb = sample(b);
  for (const auto& p : pa) {
    if (inside(b, p)) return -1.0;
    for (const auto& q : pb) least = std::min(least, distance_m(p, q));
  }
  for (const auto& q : pb)
    if (inside(a, q)) return -1.0;
  return least;
}

TEST(Collision, AgreesWithBruteForce) {
  Random random(5, 0, 0);
  int touching = 0, apart = 0;
  for (int i = 0; i < 250; ++i) {
    const Outline vehicle = rectangle({0.0, 0.0}, random.uniform(0, 6.28), 1.0, 0.6);
    const Point2<Building> at{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
    const double yaw = random.uniform(0, 6.28);
    const Outline other = i % 2 == 0 ? rectangle(at, yaw, random.uniform(0.1, 1.0), random.uniform(0.1, 1.0))
                                     : Outline{at, {at.x_m + std::cos(yaw), at.y_m + std::sin(yaw)}};
    const double distance = gap(vehicle, other);
    if (distance < 0.0) {
      EXPECT_TRUE(overlap(vehicle, other));
      ++touching;
    } else if (distance > 0.015) {
      EXPECT_FALSE(overlap(vehicle, other)) << distance;
      ++apart;
    }
  }
  EXPECT_GT(touching, 50);
  EXPECT_GT(apart, 50);
}

TEST(Collision, TheIndexFindsWhatALinearSearchFinds) {
  Random random(6, 0, 0);
  ObstacleIndex index;
  for (int i = 0; i < 200; ++i)
    index.add({std::to_string(i),
               rectangle({random.uniform(-15, 15), random.uniform(-15, 15)}, random.uniform(0, 6), 2.0, 0.5),
               {0.0, random.uniform(0.01, 1.0)}});
  int found = 0;
  for (int i = 0; i < 500; ++i) {
    const Outline vehicle =
        rectangle({random.uniform(-15, 15), random.uniform(-15, 15)}, random.uniform(0, 6), 1.0, 0.6);
    const Obstacle* expected = nullptr;
    for (const Obstacle& o : index.all())
      if (expected == nullptr && o.z.high_m > 0.1 && overlap(vehicle, o.outline)) expected = &o;
    EXPECT_EQ(index.find(vehicle, {0.1, 0.8}), expected);
    found += expected != nullptr ? 1 : 0;
  }
  EXPECT_GT(found, 50);
}

TEST(Collision, DrivingIntoAWallIsRecordedWithSpeedAndStopsThere) {
  FactorySetup setup = test::small_hall(20.0, 12.0, 15.0, 6.0);
  Factory factory(setup);
  for (int i = 0; i < 800; ++i) factory.step(std::chrono::milliseconds(10), {10.0, 10.0});
  ASSERT_FALSE(factory.collisions().empty());
  const Collision& first = factory.collisions().front();
  EXPECT_EQ(first.what, "wall");
  EXPECT_NEAR(first.speed_mps, 1.0, 0.01);
  const double front = factory.truth().map_from_base.x_m() + 0.8;
  EXPECT_LE(front, 20.0);
  EXPECT_GT(front, 19.99);
}

TEST(Collision, APersonWhoWalksIntoAStandingVehicleIsNoFaultOfTheVehicle) {
  FactorySetup setup = test::small_hall();
  MoverSpec person;
  person.name = "walker";
  person.path = {{5.3, 1.0}, {5.3, 9.0}};
  person.polite_m = 0.0;
  setup.scenario.movers = {person};
  Factory factory(setup);
  factory.step(std::chrono::seconds(4));
  ASSERT_EQ(factory.collisions().size(), 1U);
  EXPECT_EQ(factory.collisions()[0].what, "walker");
  EXPECT_LT(factory.collisions()[0].speed_mps, 0.01);
}

}  // namespace
}  // namespace madori::simulation
