// A lidar that no room has ever heard of: what adding one takes, docs/explanation/lidars.md.
#include <gtest/gtest.h>

#include <memory>

#include "app/cycle/stages.hpp"
#include "app/lidars.hpp"
#include "app/runner/socket_link.hpp"
#include "core/angle.hpp"
#include "core/clock.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "tests/support/lidar_models.hpp"
#include "tests/support/toy_vehicle.hpp"

namespace madori::app {
namespace {

using sensors::LidarSettings;
using sensors::LidarSweep;
using sensors::SweepSink;

/// Its telegram: one byte a beam, decimetres, a beam a degree from -90 deg on.
class ToyDecoder final : public sensors::LidarDecoder {
 public:
  explicit ToyDecoder(SweepSink sink) : sink_(std::move(sink)) {}
  void push(std::span<const std::uint8_t> bytes, Stamp received) override {
    LaserScan scan;
    scan.stamp = received;
    scan.angle_min_rad = to_rad(-90.0);
    scan.angle_step_rad = to_rad(1.0);
    scan.range_max_m = 25.0;
    for (const auto byte : bytes) scan.ranges_m.push_back(0.1F * static_cast<float>(byte));
    LidarSweep sweep{std::move(scan), static_cast<std::int64_t>(++sweeps_), ""};
    sink_(sweep);
  }
  [[nodiscard]] sensors::LidarCounters counters() const override { return {sweeps_, 0, 0}; }

 private:
  SweepSink sink_;
  std::uint64_t sweeps_ = 0;
};

/// Its link is the test.
class ToyDriver final : public sensors::LidarDriver {
 public:
  explicit ToyDriver(SweepSink sink) : decoder_(std::move(sink)) { newest = this; }
  ~ToyDriver() override { newest = nullptr; }
  void hear(std::vector<std::uint8_t> bytes) { decoder_.push(bytes, clock_now()); }
  [[nodiscard]] sensors::LidarHealth health() const override {
    return {Duration(0), decoder_.counters(), problem, ""};
  }
  [[nodiscard]] std::string place() const override { return "a toy box"; }
  std::string problem;
  static inline ToyDriver* newest = nullptr;

 private:
  ToyDecoder decoder_;
};

sensors::LidarRow toy_row() {
  return {"toy",
          "Toy",
          sensors::LidarLink::Serial,
          "/dev/toy",
          false,
          false,
          [](const LidarSettings& settings) {
            LidarModel model = test::planar_lidar(settings.mounting, 1.0);
            model.name = settings.name;
            model.type = "toy";
            model.from_rad = to_rad(-90.0);
            model.to_rad = to_rad(90.0);
            return model;
          },
          [](const LidarSettings&, SweepSink sink) { return std::make_unique<ToyDecoder>(std::move(sink)); },
          [](const LidarSettings&, SweepSink sink, const sensors::BytesTap&) {
            return std::make_unique<ToyDriver>(std::move(sink));
          }};
}

TEST(ToyLidar, ARowIsAllThatTheVehicleNeeds) {
  sensors::add_lidar(toy_row());
  mapping::Site site;
  site.sensors = {{"nose", "toy", 0.7, 0.0, 0.2, 0.0}};
  test::RollingVehicle rolling({});
  CycleConfig config = test::toy_config({});
  config.lidars = lidars_of(site, "hall");
  SocketOptions options;
  options.drive_device = "/dev/no-drive-here";
  SocketLink link(options, WheelGeometry{}, site.sensors);
  ASSERT_NE(ToyDriver::newest, nullptr);
  ToyDriver::newest->hear(std::vector<std::uint8_t>(181, 30));
  CycleInput input;
  input.now = clock_now();
  link.collect(input);
  ASSERT_EQ(input.scans.size(), 1U);
  CycleState state(config, std::make_unique<test::TruePose>(rolling));
  const auto result = step(std::move(state), input, config);
  EXPECT_TRUE(result.output.computed_lidar);
  ASSERT_TRUE(result.state.lidar_heard);
  bool ahead = false;  // 3 m before the lidar
  for (const auto& column : result.state.obstacles.columns())
    ahead = ahead || (std::abs(column.centre().x_m - 3.7) < 0.15 && std::abs(column.centre().y_m) < 0.15);
  EXPECT_TRUE(ahead) << result.state.obstacles.columns().size() << " columns";
  ToyDriver::newest->problem = "the toy is broken";
  EXPECT_NE(link.lidars().front().health.problem, "");
}

CycleState heard_at(const CycleConfig& config, const test::RollingVehicle& rolling,
                    const std::vector<std::optional<double>>& seconds) {
  CycleState state(config, std::make_unique<test::TruePose>(rolling));
  for (const auto& s : seconds)
    state.lidars_heard.push_back({s ? std::optional(stamp_from_seconds(*s)) : std::nullopt, {}});
  return state;
}

/// Returns all around at 5 m, but for a sector (degrees, Base frame).
PointCloud<Base> all_around(double from_deg, double to_deg) {
  PointCloud<Base> sweep;
  for (double deg = -180.0; deg < 180.0; deg += 1.0)
    if (deg < from_deg || deg > to_deg)
      sweep.points.push_back({static_cast<float>(5.0 * std::cos(to_rad(deg))),
                              static_cast<float>(5.0 * std::sin(to_rad(deg))), 0.0F});
  return sweep;
}

TEST(LidarSilence, ADirectionAheadThatWasSeenAndIsNoLongerIsMissing) {
  const test::RollingVehicle rolling({});
  CycleConfig config;
  for (const bool planar : {false, true}) {
    config.lidars = {planar ? test::planar_lidar({}) : test::spinning_lidar({})};
    CycleState state = heard_at(config, rolling, {std::nullopt});
    const auto see = [&](double from_deg, double to_deg, double at_s) {
      note_heard(state.lidars_heard[0], all_around(from_deg, to_deg), config.lidars[0],
                 stamp_from_seconds(at_s));
      return heard_all(state, config, stamp_from_seconds(at_s));
    };
    EXPECT_EQ(see(10.0, 40.0, 1.0), stamp_from_seconds(1.0)) << "never seen: the vehicle's own mast";
    EXPECT_EQ(see(0.0, -1.0, 2.0), stamp_from_seconds(2.0));
    EXPECT_EQ(see(100.0, 180.0, 3.0), stamp_from_seconds(3.0)) << "not ahead";
    EXPECT_EQ(see(16.0, 29.0, 4.0), stamp_from_seconds(4.0)) << "every direction has something left";
    // A level lidar may look into an open hall.
    EXPECT_EQ(see(20.0, 40.0, 5.0), stamp_from_seconds(planar ? 5.0 : 4.0));
    EXPECT_EQ(see(0.0, -1.0, 6.0), stamp_from_seconds(6.0)) << "seen again";
  }
}

TEST(LidarSilence, OneOfTwoMayBeSilentWhereTheOtherSeesTheWayAhead) {
  const test::RollingVehicle rolling({});
  CycleConfig config;
  const auto front = test::planar_lidar({0.7, 0.0, 0.2, 0.0});
  const auto rear = test::planar_lidar({-0.1, 0.0, 0.2, kPi});
  config.lidars = {front, front};
  EXPECT_EQ(heard_all(heard_at(config, rolling, {1.0, 9.0}), config, stamp_from_seconds(10.0)),
            stamp_from_seconds(9.0));
  config.lidars = {front, rear};
  EXPECT_EQ(heard_all(heard_at(config, rolling, {1.0, 9.0}), config, stamp_from_seconds(10.0)),
            stamp_from_seconds(1.0))
      << "the way ahead is unseen";
  EXPECT_EQ(heard_all(heard_at(config, rolling, {9.0, 1.0}), config, stamp_from_seconds(10.0)),
            stamp_from_seconds(9.0));
  EXPECT_EQ(heard_all(heard_at(config, rolling, {std::nullopt, 9.0}), config, stamp_from_seconds(10.0)),
            std::nullopt);
  config.lidars = {test::spinning_lidar({0.3, 0.0, 1.2, 0.0}), front};
  EXPECT_EQ(heard_all(heard_at(config, rolling, {9.0, 1.0}), config, stamp_from_seconds(10.0)),
            stamp_from_seconds(9.0));
  EXPECT_EQ(heard_all(heard_at(config, rolling, {1.0, 9.0}), config, stamp_from_seconds(10.0)),
            stamp_from_seconds(1.0))
      << "by the 3D lidar the vehicle knows its place";
}

TEST(LidarSilence, EachHasThePatienceOfItsRate) {
  const test::RollingVehicle rolling({});
  CycleConfig config;
  auto slow = test::planar_lidar({0.7, 0.0, 0.2, 0.0});
  slow.period_s = 1.0 / 0.3;
  config.lidars = {slow};
  EXPECT_NEAR(patience_s(config, 0), 8.33, 0.01);
  const auto silent_at = [&](double now_s) {
    const Stamp now = stamp_from_seconds(now_s);
    return is_silent(heard_all(heard_at(config, rolling, {1.0}), config, now), now, config.lidar_silent_s);
  };
  EXPECT_FALSE(silent_at(9.0));
  EXPECT_TRUE(silent_at(9.5));
  config.lidars = {test::spinning_lidar({0.3, 0.0, 1.2, 0.0}), slow};
  const Stamp now = stamp_from_seconds(5.0);
  EXPECT_TRUE(
      is_silent(heard_all(heard_at(config, rolling, {4.0, 4.9}), config, now), now, config.lidar_silent_s))
      << "a slow one gives a fast one no patience";
}

TEST(LidarSilence, OneOfTwoIsNamedAndTheOtherAllowsItsOwnSpeed) {
  const auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,60,0\n").graph;
  auto config = test::toy_config(routes);
  auto coarse = test::planar_lidar({0.7, 0.0, 0.9, 0.0}, 2.0);  // a leg is sure to 1.2 m
  coarse.name = "coarse";
  config.lidars.push_back(coarse);
  config.lidars.front() = test::planar_lidar({0.7, 0.0, 0.9, 0.0}, 0.25);
  config.lidars.front().name = "fine";
  config.sure_range_m = sure_ahead_m(config.lidars, 0.8);
  const test::RollingVehicle rolling({});
  const auto state = heard_at(config, rolling, {9.9, 9.9});
  const Stamp now = stamp_from_seconds(10.0);
  EXPECT_NEAR(sure_range_m(state, now, config), 3.1, 0.1);
  const auto one = heard_at(config, rolling, {5.0, 9.9});
  EXPECT_NEAR(sure_range_m(one, now, config), 1.17, 0.1);
  EXPECT_EQ(silent_lidars(one, now, config), "fine");
  EXPECT_EQ(silent_lidars(heard_at(config, rolling, {5.0, 5.0}), now, config), "fine, coarse") << "both";
  CycleState told = heard_at(config, rolling, {5.0, 9.9});
  told.lidar_heard = stamp_from_seconds(9.9);
  CycleInput input;
  input.now = now;
  CycleOutput output;
  say_missed_lidars(told, input, config, output);
  say_missed_lidars(told, input, config, output);
  ASSERT_EQ(output.events.size(), 1U) << "said once";
  EXPECT_EQ(output.events.front(),
            "lidar fine is silent: the vehicle goes on with the others, as fast as they allow");
}

TEST(HeightUnseen, AVehicleThatSeesOnePlaneAsksBeforeADoorAndGoesOnWhenTold) {
  const auto routes =
      planning::parse_routes("ID,EDA\n0,1\n1,0 2\n2,1 3\n3,2\n",
                             "ID,x,y,heading_deg,action\n0,0,0,,\n1,7,0,,door\n2,11,0,,door\n3,18,0,,\n")
          .graph;
  for (const bool planar : {true, false}) {
    auto config = test::toy_config(routes);
    if (planar) config.lidars = {test::planar_lidar({0.0, 0.0, 0.9, 0.0})};
    test::ToyVehicle v(config, {0.0, 0.0, 0.0});
    v.drive_to({{3}});
    v.say(OperatorWord::Resume);
    const auto asks = [&] { return v.state().standstill.cause == notice(Cause::HeightUnseen); };
    if (!planar) {
      EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0));
      EXPECT_TRUE(
          std::ranges::none_of(v.events, [](const auto& e) { return e.find("no lidar sees") != e.npos; }));
      continue;
    }
    ASSERT_TRUE(v.run_until(asks, 30.0)) << v.state().standstill.cause.text;
    EXPECT_EQ(v.state().standstill.remedy, notice(Remedy::LookAndGoOn));
    v.run_until([] { return false; }, 1.0);  // until it stands
    EXPECT_LT(v.rolling.pose().x_m() + v.config.check.vehicle.front_m, 7.0);
    EXPECT_FALSE(v.run_until([&] { return v.rolling.speed().linear_mps > 0.05; }, 20.0))
        << "nobody has said so";
    v.say(OperatorWord::GoOn);
    EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0))
        << "one word is for the whole door: " << v.state().standstill.cause.text;
  }
}

/// Where a vehicle that sees one plane stands and asks, by its front, on its way to the last node.
double front_where_it_asks_m(const std::string& tree, const std::string& path, double start_m, int goal) {
  auto config = test::toy_config(planning::parse_routes(tree, path).graph);
  config.lidars = {test::planar_lidar({0.0, 0.0, 0.9, 0.0})};
  test::ToyVehicle v(config, {start_m, 0.0, 0.0});
  v.drive_to({{goal}});
  v.say(OperatorWord::Resume);
  const auto asks = [&] { return v.state().standstill.cause == notice(Cause::HeightUnseen); };
  EXPECT_TRUE(v.run_until(asks, 30.0)) << v.state().standstill.cause.text;
  v.run_until([] { return false; }, 1.0);  // until it stands
  const double front_m = v.rolling.pose().x_m() + v.config.check.vehicle.front_m;
  v.say(OperatorWord::GoOn);
  EXPECT_TRUE(v.run_until([&] { return v.delivered(); }, 60.0)) << v.state().standstill.cause.text;
  return front_m;
}

// The sample factory's lift has its node 2.5 m before the door: on the way out the door comes first.
TEST(HeightUnseen, ItAsksBeforeTheDoorOnTheWayOutOfALiftToo) {
  EXPECT_LT(front_where_it_asks_m("ID,EDA\n0,1\n1,0 2\n2,1\n",
                                  "ID,x,y,heading_deg,action\n0,0,0,,\n1,4.5,0,,lift\n2,14,0,,\n", 0.0, 2),
            2.0);
}

TEST(HeightUnseen, ItAsksWhereItIsSwitchedOnBetweenTheNodeAndTheDoor) {
  EXPECT_LT(front_where_it_asks_m("ID,EDA\n0,1\n1,0 2\n2,1\n",
                                  "ID,x,y,heading_deg,action\n0,0,0,,\n1,7,0,,lift\n2,14,0,,\n", 8.0, 2),
            9.0);
}

// It has closed meanwhile, and rises as the vehicle comes: the scanner sees no more of it when it is a hand
// high.
TEST(HeightUnseen, AWordForADoorThatWasThenSeenShutHoldsNoMore) {
  auto config = test::toy_config(
      planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y,action\n0,0,0,\n1,4,0,door\n").graph);
  config.lidars = {test::planar_lidar({0.0, 0.0, 0.2, 0.0})};
  for (const Mode mode : {Mode::Driving, Mode::Waiting}) {
    CycleState state(config, nullptr);
    state.mode = mode;
    state.errand.doors = state.block.doors_allowed = {1};
    state.ahead.check.free_m = 3.0;
    state.ahead.check.where = {4.0, 0.0};
    stop_before_doors(state, config);
    EXPECT_EQ(state.block.doors_allowed.size(), 1U) << "it is waited for";
    state.ahead.check = {};
    stop_before_doors(state, config);
    EXPECT_EQ(state.block.doors_allowed.empty(), mode == Mode::Waiting)
        << "a moment's shape of the noise is no door";
  }
}

TEST(SureSight, NoFasterIsDrivenThanALegIsSureToBeSeen) {
  const auto routes = planning::parse_routes("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,0,0\n1,30,0\n").graph;
  auto config = test::toy_config(routes);
  config.pursuit.speed.max_speed_mps = config.limits.max_speed_mps = 2.0;
  config.limits.max_wheel_speed_mps = 3.0;
  config.lidars = {test::planar_lidar({0.7, 0.0, 0.2, 0.0})};
  config.sure_range_m = sure_ahead_m(config.lidars, 0.8);
  EXPECT_NEAR(config.sure_range_m, 2.51, 0.01);
  test::ToyVehicle v(config, {0.0, 0.0, 0.0});
  v.drive_to({{1}});
  v.say(OperatorWord::Resume);
  double fastest_mps = 0.0;
  EXPECT_TRUE(v.run_until(
      [&] {
        fastest_mps = std::max(fastest_mps, v.rolling.speed().linear_mps);
        return v.delivered();
      },
      60.0));
  EXPECT_LE(config.check.braking.horizon_m(fastest_mps), config.sure_range_m + 0.05);
  EXPECT_GT(fastest_mps, 1.5);
}

}  // namespace
}  // namespace madori::app
