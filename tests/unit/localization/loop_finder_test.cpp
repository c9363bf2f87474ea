// Places found again by what they look like, and vehicles that are carried away while they map.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "localization/memory/fuse.hpp"
#include "localization/memory/sights.hpp"
#include "localization/slam/graph_mapper.hpp"
#include "localization/slam/graph_spread.hpp"
#include "localization/slam/joints.hpp"
#include "localization/slam/place_views.hpp"
#include "localization/slam/stretch.hpp"
#include "tests/support/made_up_buildings.hpp"
#include "tests/support/made_up_drive.hpp"
#include "tests/support/scan_at.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

using test::scan_at;

Transform2<Base, Base> from_to(const Pose& a, const Pose& b) {
  return a.inverse() * b;
}

TEST(Sights, AgreeWhereTheScansLieAndContradictElsewhere) {
  std::mt19937 engine(3);
  const mapping::Walls walls = test::laboratory_hall();
  const Pose a(6.0, 1.2, 0.3), b(10.5, 3.2, -1.0);
  const SurfaceScan seen_a = scan_at(walls, a, engine), seen_b = scan_at(walls, b, engine);
  const SightRing ring(seen_a);
  const SightCount right = ring.of(seen_b, from_to(a, b));
  EXPECT_GT(right.both(), 100);
  EXPECT_LT(right.contradiction(), 0.05);
  const SightCount wrong = ring.of(seen_b, from_to(a, b) * Transform2<Base, Base>(2.0, 1.5, 0.8));
  EXPECT_GT(wrong.contradiction(), 0.25);
}

TEST(Sights, SayNothingOfWhatIsHidden) {
  SurfaceScan wall, behind;
  for (int i = -20; i <= 20; ++i) wall.points.push_back({2.0, 0.05 * i, -1.0, 0.0});
  for (int i = -5; i <= 5; ++i) behind.points.push_back({4.0, 0.05 * i, -1.0, 0.0});
  EXPECT_EQ(SightRing(wall).of(behind, {}).both(), 0);
  const SightCount before = SightRing(behind).of(wall, {});  // the wall stands where the other looked through
  EXPECT_EQ(before.through, 5);                              // those of the wall within the other's view
  EXPECT_EQ(before.agree, 0);
}

/// Two keyframes before a joint and two behind it, laid where wheels lead that are wrong by `off`.
/// Each scan meets so many persons, none of whom stands there any more when the next is made.
Memory joined(const std::vector<Pose>& truth, const Transform2<Base, Base>& off, int persons = 0) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> away_m(1.5, 4.0), bearing_rad(-kPi, kPi);
  Memory memory;
  Pose at = truth.front();
  for (std::size_t k = 0; k < truth.size(); ++k) {
    mapping::Walls walls = test::laboratory_hall();
    for (int i = 0; i < persons; ++i) {
      const double away = away_m(engine), bearing = bearing_rad(engine);
      const double x = truth[k].x_m() + away * std::cos(bearing),
                   y = truth[k].y_m() + away * std::sin(bearing);
      test::add_box(walls, x - 0.2, y - 0.2, x + 0.2, y + 0.2);
    }
    auto motion = k > 0 ? from_to(truth[k - 1], truth[k]) : Transform2<Base, Base>();
    if (k == 2) motion = motion * off;
    if (k > 0) at = at * motion;
    memory.add(scan_at(walls, truth[k], engine), 1.0, at,
               MeasuredMotion{motion, 400.0 * Eigen::Matrix3d::Identity(), k == 2 ? 0.1 : 0.9});
  }
  return memory;
}

OdometryStep wheels_to(const Memory& memory, std::size_t k) {
  OdometryStep step;
  step.motion = from_to(memory.poses()[k - 1], memory.poses()[k]);
  step.covariance = Eigen::Vector3d(0.09, 0.09, 0.09).asDiagonal();
  return step;
}

/// The scans lie on nothing where the wheels lead, and see through each other.
TEST(Joints, AreLaidAnewWhereTheWheelsAreOnlyWrong) {
  const std::vector<Pose> truth{{5.0, 1.2, 0.0}, {6.0, 1.2, 0.1}, {9.0, 1.3, 0.4}, {10.0, 1.6, 0.3}};
  const Memory right = joined(truth, {}), wrong = joined(truth, {-0.4, 0.3, 0.25});
  EXPECT_EQ(judge_joint(right, 2, wheels_to(right, 2), 0.0).joint, Joint::Holds);
  const JointVerdict verdict = judge_joint(wrong, 2, wheels_to(wrong, 2), 0.0);
  ASSERT_EQ(verdict.joint, Joint::Otherwise);
  const Transform2<Base, Base> off = verdict.motion.motion.inverse() * from_to(truth[1], truth[2]);
  EXPECT_LT(std::hypot(off.x_m(), off.y_m()), 0.05);
  EXPECT_LT(std::abs(off.yaw_rad()), to_rad(1.0));
}

TEST(Joints, AreFalseWhereTheVehicleWasCarried) {
  const std::vector<Pose> truth{{5.0, 1.2, 0.0}, {6.0, 1.2, 0.1}, {13.5, 7.6, 2.4}, {13.0, 8.2, 2.6}};
  const Memory carried = joined(truth, from_to(truth[1], truth[2]).inverse());  // the wheels stood still
  EXPECT_EQ(judge_joint(carried, 2, wheels_to(carried, 2), 0.0).joint, Joint::False);
}

/// Persons contradict before the joint and behind it as they do at it.
TEST(Joints, MayContradictAsTheirNeighboursDo) {
  constexpr int kPersons = 10;
  const std::vector<Pose> truth{{5.0, 1.2, 0.0}, {6.0, 1.2, 0.1}, {9.0, 1.3, 0.4}, {10.0, 1.6, 0.3}};
  const Memory crowded = joined(truth, {-0.1, 0.1, 0.05}, kPersons);
  const JointVerdict verdict = judge_joint(crowded, 2, wheels_to(crowded, 2), 0.0);
  ASSERT_EQ(verdict.joint, Joint::Otherwise);
  const Transform2<Base, Base> off = verdict.motion.motion.inverse() * from_to(truth[1], truth[2]);
  EXPECT_LT(std::hypot(off.x_m(), off.y_m()), 0.05);
  EXPECT_LT(std::abs(off.yaw_rad()), to_rad(1.0));
  const std::vector<Pose> there{{5.0, 1.2, 0.0}, {6.0, 1.2, 0.1}, {13.5, 7.6, 2.4}, {13.0, 8.2, 2.6}};
  const Memory carried = joined(there, from_to(there[1], there[2]).inverse(), kPersons);
  EXPECT_EQ(judge_joint(carried, 2, wheels_to(carried, 2), 0.0).joint, Joint::False);
}

/// What is laid is not followed to wheels that jumped by a thousand kilometres.
TEST(Joints, AreSoughtWithinReachOfTheScans) {
  const std::vector<Pose> truth{{5.0, 1.2, 0.0}, {6.0, 1.2, 0.1}, {9.0, 1.3, 0.4}, {10.0, 1.6, 0.3}};
  const Memory memory = joined(truth, {});
  const StretchOptions options;
  const auto laid = from_to(truth[1], truth[2]);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.09, 0.09, 0.09).asDiagonal();
  const StretchMatch led = lean_stretches(memory, {0, 1, 1}, {2, 2, 3}, {1e6, 0.0, 0.0}, covariance, laid);
  const Transform2<Base, Base>& found = led.factor.motion;
  EXPECT_LE(std::min(std::abs(found.x_m() - 1e6), std::abs(found.x_m() - laid.x_m())), options.map_radius_m);
}

TEST(PlaceViews, TellTheTurnAndThePlace) {
  std::mt19937 engine(4);
  const mapping::Walls walls = test::laboratory_hall();
  const Pose here(6.2, 1.3, 0.2), turned(6.2, 1.3, 0.2 + 10.0 * 2.0 * kPi / 64.0), other(14.5, 4.2, 0.2);
  const PlaceView old = place_view(scan_at(walls, here, engine));
  const ViewDifference same = compare_views(place_view(scan_at(walls, turned, engine)), old);
  EXPECT_NEAR(same.turn_rad(), 10.0 * 2.0 * kPi / 64.0, 2.0 * kPi / 64.0);
  EXPECT_LT(same.difference, 0.15);
  EXPECT_GT(compare_views(place_view(scan_at(walls, other, engine)), old).difference, same.difference + 0.15);
}

/// Along a chain the Dijkstra projection is exact: what chaining the factors gives.
TEST(GraphSpread, OfAChainIsTheChain) {
  const Eigen::Matrix3d information = Eigen::Vector3d(2500.0, 1600.0, 40000.0).asDiagonal();
  std::vector<Pose> poses{{}};
  std::vector<RelativeFactor> factors;
  RelativeFactor all;
  for (int k = 0; k < 6; ++k) {
    const RelativeFactor f{k, k + 1, {0.8, 0.1, 0.3}, information, false};
    poses.push_back(poses.back() * f.motion);
    all = k == 0 ? f : chained(all, f);
    factors.push_back(f);
  }
  const GraphSpread spread(0, poses, factors);
  EXPECT_LT((*spread.at(6) - all.information.inverse()).norm(), 1e-3 * spread.at(6)->norm());
  EXPECT_NEAR(spread.chi_squared(6, all.motion, Eigen::Matrix3d::Zero()), 0.0, 1e-6);
  const double sigma_m = std::sqrt((*spread.at(6))(0, 0));
  const Transform2<Base, Base> off(all.motion.x_m() + 8.0 * sigma_m, all.motion.y_m(), all.motion.yaw_rad());
  EXPECT_GT(spread.chi_squared(6, off, Eigen::Matrix3d::Zero()), 16.3);
  // A second, better chain is taken; a loop that the poses contradict is not.
  factors.push_back({0, 6, all.motion, 100.0 * information, true});
  EXPECT_LT((*GraphSpread(0, poses, factors).at(6))(0, 0), 0.1 * (*spread.at(6))(0, 0));
  factors.back().motion = off * off;
  EXPECT_NEAR((*GraphSpread(0, poses, factors).at(6))(0, 0), (*spread.at(6))(0, 0), 1e-12);
  EXPECT_FALSE(GraphSpread(0, {{}, {}}, {}).at(1).has_value());
}

/// Two rounds; the vehicle is carried from one end of the hall to the other in the midst of them.
struct CarriedDrive {
  std::vector<test::DriveMoment> moments;
  std::vector<std::size_t> starts;
};

CarriedDrive carried_drive(const mapping::Walls& walls, const std::vector<std::vector<Point2<Map>>>& ways) {
  std::mt19937 engine(11);
  test::DriveSettings settings;
  settings.sigma_rad_per_m = 0.02;
  settings.sigma_distance = 0.02;
  CarriedDrive drive;
  Transform2<Odom, Base> odom;
  double seconds = 0.0;
  for (const auto& way : ways) {
    auto piece = test::drive(walls, way, settings, engine);
    const Transform2<Odom, Base> start = piece.front().odometry.odom_from_base;
    drive.starts.push_back(drive.moments.size());
    for (auto& m : piece) {
      const auto since = start.inverse() * m.odometry.odom_from_base;
      m.odometry.odom_from_base = odom * since;
      m.odometry.stamp = stamp_from_seconds(seconds += 0.1);
      m.scan.stamp = m.odometry.stamp;
      drive.moments.push_back(std::move(m));
    }
    odom = drive.moments.back().odometry.odom_from_base;
  }
  return drive;
}

struct Mapped {
  FinishedMap map;
  double worst_m = 0.0;  ///< of the scans' poses, the map laid on the truth by its first scan
};

/// `asked_at`: the moment at which a map is asked for that nobody takes.
Mapped mapped(const CarriedDrive& drive, std::optional<std::size_t> asked_at = {}) {
  GraphMapper mapper;
  std::vector<std::pair<Stamp, Pose>> truth;
  for (const auto& m : drive.moments) {
    if (asked_at && &m == &drive.moments[*asked_at]) (void)mapper.finish();
    (void)mapper.on_odometry(m.odometry);
    if (!m.has_scan) continue;
    (void)mapper.on_scan(m.scan.stamp, scan_points(m.scan, {}), {});
    truth.emplace_back(m.scan.stamp, m.truth);
  }
  Mapped result{mapper.finish()};
  std::optional<Transform2<Map, Map>> by;
  std::size_t next = 0;
  for (const MomentPose& scan : result.map.scans) {
    while (truth[next].first != scan.stamp) ++next;
    if (!by) by = truth[next].second * scan.map_from_base.inverse();
    const Pose placed = *by * scan.map_from_base;
    result.worst_m =
        std::max(result.worst_m, distance_m(placed.translation(), truth[next].second.translation()));
  }
  return result;
}

const std::vector<Point2<Map>> kRound{{2.5, 1.2},  {11.0, 1.2}, {14.4, 1.0}, {14.4, 4.2}, {14.4, 8.2},
                                      {12.5, 8.2}, {11.0, 7.2}, {7.0, 7.8},  {6.5, 3.8},  {6.5, 1.2}};
const std::vector<Point2<Map>> kBackAgain{{14.4, 8.2}, {14.4, 4.2}, {14.4, 1.0}, {11.0, 1.2},
                                          {6.5, 1.2},  {6.5, 3.8},  {7.0, 7.8}};

TEST(GraphMapper, TiesThePiecesOfAVehicleThatWasCarriedAway) {
  const CarriedDrive drive = carried_drive(test::laboratory_hall(), {kRound, kBackAgain});
  const Mapped result = mapped(drive);
  EXPECT_EQ(result.map.lost_scans, 0);
  ASSERT_EQ(result.map.carried.size(), 1U);
  EXPECT_LT(std::abs(to_seconds(result.map.carried.front() - drive.moments[drive.starts[1]].odometry.stamp)),
            0.7);  // a scan comes every 0.3 s
  EXPECT_LT(result.worst_m, 0.08);
}

/// A map is asked for while a piece is tied to nothing yet, and nobody takes it: the drive goes on behind it.
TEST(GraphMapper, GoesOnBehindAFinishAsIfNobodyHadAsked) {
  const CarriedDrive drive = carried_drive(test::laboratory_hall(), {kRound, kBackAgain});
  const Mapped unasked = mapped(drive), asked = mapped(drive, drive.starts[1] + 30);
  EXPECT_EQ(asked.map.lost_scans, 0);
  ASSERT_EQ(asked.map.scans.size(), unasked.map.scans.size());
  for (std::size_t i = 0; i < asked.map.scans.size(); ++i) {
    const Pose &a = asked.map.scans[i].map_from_base, &b = unasked.map.scans[i].map_from_base;
    ASSERT_DOUBLE_EQ(a.x_m(), b.x_m()) << i;
    ASSERT_DOUBLE_EQ(a.y_m(), b.y_m()) << i;
  }
}

/// A building that it has never seen is no part of the map, and is said to be lost.
TEST(GraphMapper, LosesAPieceThatNothingTies) {
  mapping::Walls walls = test::laboratory_hall();
  test::add_box(walls, 100.0, 0.0, 109.0, 7.0);
  test::add_box(walls, 103.0, 2.0, 104.0, 2.8);
  const CarriedDrive drive =
      carried_drive(walls, {kRound, {{101.5, 1.2}, {107.0, 1.2}, {107.5, 5.5}, {102.0, 5.5}}});
  const Mapped result = mapped(drive);
  int scans = 0, elsewhere = 0;
  for (std::size_t i = 0; i < drive.moments.size(); ++i) {
    scans += drive.moments[i].has_scan;
    elsewhere += drive.moments[i].has_scan && i >= drive.starts[1];
  }
  EXPECT_NEAR(result.map.lost_scans, elsewhere, 2);
  EXPECT_EQ(static_cast<int>(result.map.scans.size()) + result.map.lost_scans, scans);
  EXPECT_LT(result.worst_m, 0.08);
}

}  // namespace
}  // namespace madori::localization
