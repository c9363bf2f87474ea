#include "localization/self_calibration/self_calibration.hpp"

#include <gtest/gtest.h>

#include <random>

#include "localization/scan_points.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"

namespace madori::localization {
namespace {

/// The building as drawn with these errors: x and y too large by a share, sheared.
mapping::Walls drawn(const mapping::Walls& walls, const Eigen::Vector3d& strain) {
  mapping::Walls drawing = walls;
  for (mapping::Wall& wall : drawing)
    for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b})
      *p = {p->x_m * (1.0 + strain[0]) + 0.5 * strain[2] * p->y_m,
            p->y_m * (1.0 + strain[1]) + 0.5 * strain[2] * p->x_m};
  return drawing;
}

void move_some(mapping::Walls& walls, std::mt19937& engine) {
  std::uniform_real_distribution<double> far(0.3, 1.0);
  for (std::size_t i = 0; i < walls.size(); i += 5) {
    Segment2<Map>& s = walls[i].segment;
    const double length = s.length_m();
    const double d = i % 2 == 0 ? far(engine) : -far(engine);
    const double nx = -(s.b.y_m - s.a.y_m) / length * d;
    const double ny = (s.b.x_m - s.a.x_m) / length * d;
    for (Point2<Map>* p : {&s.a, &s.b}) *p = {p->x_m + nx, p->y_m + ny};
  }
  for (std::size_t i = 3; i < walls.size(); i += 12) walls.erase(walls.begin() + static_cast<long>(i));
}

SurfaceScan far_surfaces(const LaserScan& scan) {
  const ScanPoints points = scan_points(scan, {});
  std::vector<Point2<Base>> list;
  for (std::size_t i = 0; i < points.size(); ++i) list.push_back(points.point(i));
  return make_surface_scan(scan.stamp, {}, list, {.range_max_m = 60.0});
}

/// Scans from random places of `building`, each at about where a localizer has it on the drawing.
std::vector<CalibrationKeyframe> keyframes(const mapping::Walls& building, const Eigen::Vector3d& strain,
                                           int count, double range_max_m, std::mt19937& engine) {
  const mapping::DistanceField field(building);
  std::normal_distribution<double> noise;
  test::ScanSettings lidar = test::full_turn(720, range_max_m);
  lidar.range_sigma_m = 0.015;
  lidar.clutter = 0.3;
  std::vector<CalibrationKeyframe> result;
  for (int i = 0; i < count; ++i) {
    const auto pose = test::random_pose(building, field, 0.6, 6.0, engine);
    const auto scan = test::simulate_scan(building, pose, lidar, engine);
    const double x = pose.x_m() * (1.0 + strain[0]) + 0.5 * strain[2] * pose.y_m() + 0.1 * noise(engine);
    const double y = pose.y_m() * (1.0 + strain[1]) + 0.5 * strain[2] * pose.x_m() + 0.1 * noise(engine);
    result.push_back({{x, y, pose.yaw_rad() + 0.01 * noise(engine)}, surface_pieces(far_surfaces(scan))});
  }
  return result;
}

TEST(SurfacePieces, LieOnTheWallsAndFaceTheSensor) {
  const mapping::Walls walls = test::laboratory_hall();
  std::mt19937 engine(2);
  const Transform2<Map, Base> pose(7.0, 3.0, 0.4);
  const auto pieces =
      surface_pieces(far_surfaces(test::simulate_scan(walls, pose, test::full_turn(720, 30.0), engine)));
  EXPECT_GT(pieces.size(), 15U);
  for (const SurfacePiece& piece : pieces) {
    double nearest = 1e9;
    for (const auto& wall : walls)
      nearest = std::min(nearest, std::sqrt(mapping::squared_distance_m2(wall.segment, pose * piece.centre)));
    EXPECT_LT(nearest, 0.03);
    EXPECT_LT(piece.normal_x * piece.centre.x_m + piece.normal_y * piece.centre.y_m, 0.0);
    EXPECT_LE(piece.length_m, 1.0 + 1e-9);
  }
}

TEST(SelfCalibration, FindsTheStrainOfADrawingWithWallsMovedAndMissing) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::mt19937 engine(seed);
    const Eigen::Vector3d strain(0.010, -0.006, 0.004);
    const mapping::Walls drawing = test::factory_floor();
    const double a = 1.0 + strain[0], b = 0.5 * strain[2], d = 1.0 + strain[1];
    mapping::Walls building = drawing;  // such that the drawing is the building, strained
    for (mapping::Wall& wall : building)
      for (Point2<Map>* p : {&wall.segment.a, &wall.segment.b}) {
        *p = {(d * p->x_m - b * p->y_m) / (a * d - b * b), (a * p->y_m - b * p->x_m) / (a * d - b * b)};
      }
    move_some(building, engine);
    const auto seen = keyframes(building, strain, 120, 60.0, engine);
    const SelfCalibration found = self_calibrate(WallIndex(drawing), seen);
    ASSERT_TRUE(found.converged) << seed;
    for (int k = 0; k < 3; ++k) {
      const double sigma = std::sqrt(found.covariance(k, k));
      EXPECT_NEAR(found.strain[k], strain[k], 1e-3) << seed << ' ' << k;
      EXPECT_LT(std::abs(found.strain[k] - strain[k]), 4.0 * sigma) << seed << ' ' << k;
      EXPECT_LT(sigma, 1e-3);
    }
    EXPECT_GT(found.displaced, 5);
  }
}

TEST(SelfCalibration, AnExactDrawingIsFoundExact) {
  std::mt19937 engine(5);
  const mapping::Walls drawing = test::factory_floor();
  const auto found =
      self_calibrate(WallIndex(drawing), keyframes(drawing, Eigen::Vector3d::Zero(), 80, 60.0, engine));
  EXPECT_NEAR(found.uniform(), 0.0, 2e-4);
  EXPECT_LT(found.stretch_chi2(), 9.2);
  EXPECT_LE(found.displaced, found.walls / 20);  // furniture along a wall that is hardly seen
}

TEST(SelfCalibration, ItsUncertaintyIsHonest) {
  // Walls misdrawn by 5 cm each by itself: over many such drawings the errors spread as foretold.
  const mapping::Walls building = test::laboratory_hall();
  double squares = 0.0;
  int count = 0;
  for (unsigned seed = 0; seed < 25; ++seed) {
    std::mt19937 engine(100 + seed);
    std::normal_distribution<double> off(0.0, 0.05);
    mapping::Walls drawing = building;
    for (mapping::Wall& wall : drawing) {
      Segment2<Map>& s = wall.segment;
      const double length = s.length_m();
      const double d = off(engine);
      for (Point2<Map>* p : {&s.a, &s.b})
        *p = {p->x_m - (s.b.y_m - s.a.y_m) / length * d, p->y_m + (s.b.x_m - s.a.x_m) / length * d};
    }
    const auto found =
        self_calibrate(WallIndex(drawing), keyframes(building, Eigen::Vector3d::Zero(), 40, 30.0, engine));
    for (int k = 0; k < 2; ++k) {
      squares += found.strain[k] * found.strain[k] / found.covariance(k, k);
      ++count;
    }
  }
  const double ratio = std::sqrt(squares / count);  // 1 where sigma is right
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 1.7);
}

TEST(SelfCalibration, MotionsTellLengthsThatNoScanSees) {
  // Two rooms 40 m apart, each scan sees one: only the motions between them tell the building's length.
  mapping::Walls building;
  for (int i = 0; i < 5; ++i) test::add_box(building, 10.0 * i, 0.0, 10.0 * i + 6.0, 5.0);
  const Eigen::Vector3d strain(0.012, 0.0, 0.0);
  const mapping::Walls drawing = drawn(building, strain);
  std::mt19937 engine(8);
  std::vector<CalibrationKeyframe> seen;
  std::vector<RelativeFactor> motions;
  Transform2<Map, Base> before;
  for (int i = 0; i < 5; ++i) {
    const Transform2<Map, Base> truth(10.0 * i + 2.5, 2.0, 0.3 * i);
    test::ScanSettings lidar = test::full_turn(360, 8.0);
    lidar.range_sigma_m = 0.01;
    seen.push_back({{truth.x_m() * 1.012, 2.0, 0.3 * i},
                    surface_pieces(far_surfaces(test::simulate_scan(building, truth, lidar, engine)))});
    if (i > 0) {
      RelativeFactor f;
      f.from = i - 1;
      f.to = i;
      f.motion = before.inverse() * truth;
      f.information = Eigen::Vector3d(1e4, 1e4, 1e5).asDiagonal();
      motions.push_back(f);
    }
    before = truth;
  }
  const auto alone = self_calibrate(WallIndex(drawing), seen);
  const auto tied = self_calibrate(WallIndex(drawing), seen, motions);
  EXPECT_NEAR(tied.strain[0], 0.012, 1e-3);
  EXPECT_LT(std::sqrt(tied.covariance(0, 0)), 0.5 * std::sqrt(alone.covariance(0, 0)));
}

TEST(SelfCalibration, KnowsWhatItDoesNotSee) {
  mapping::Walls corridor;  // nothing across: the length cannot be told
  test::add_wall(corridor, 0.0, 0.0, 60.0, 0.0);
  test::add_wall(corridor, 0.0, 3.0, 60.0, 3.0);
  std::mt19937 engine(9);
  std::vector<CalibrationKeyframe> seen;
  for (int i = 0; i < 30; ++i) {
    const Transform2<Map, Base> pose(20.0 + 0.5 * i, 1.4, 0.0);
    seen.push_back({pose, surface_pieces(far_surfaces(
                              test::simulate_scan(corridor, pose, test::full_turn(720, 15.0), engine)))});
  }
  const auto found = self_calibrate(WallIndex(corridor), seen);
  EXPECT_GT(std::sqrt(found.covariance(0, 0)), 0.04);
  const auto nothing = self_calibrate(WallIndex(corridor), {});
  EXPECT_FALSE(nothing.converged);
}

}  // namespace
}  // namespace madori::localization
