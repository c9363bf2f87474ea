// A vehicle from an empty folder on.
#include "app/runner/site_run.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "app/panel/panel_vehicle.hpp"
#include "app/panel/reference_lidar.hpp"
#include "app/statistics/work_meter.hpp"
#include "mapping/drawing/import_drawing.hpp"
#include "tests/support/factory_link.hpp"
#include "tests/support/small_hall.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

namespace fs = std::filesystem;

/// Hears nothing but what the drive is made to tell, and remembers whether it was ever enabled.
class SilentLink final : public VehicleLink {
 public:
  SilentLink(bool& enabled, std::optional<control::wire::Status>& drive) : enabled_(enabled), drive_(drive) {}
  void collect(CycleInput& input) override {
    if (!drive_) return;
    drive_->time_us += 20'000;
    input.drive.push_back(*drive_);
  }
  void send(const CycleOutput& output) override { enabled_ = enabled_ || output.enable; }
  [[nodiscard]] std::string problem() const override { return "silent"; }

 private:
  bool& enabled_;
  std::optional<control::wire::Status>& drive_;
};

class SiteRunTest : public testing::Test {
 protected:
  void import() const {
    mapping::ImportOptions options;
    options.drawing = fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
    options.site = site_;
    options.force = true;  // there is a madori.db already
    mapping::import_drawing(options);
  }
  void draw_routes() const {
    fs::copy(fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/routes_factory", site_ / "routes",
             fs::copy_options::overwrite_existing | fs::copy_options::recursive);
  }
  void mount_lidar() const {
    mapping::Site site = mapping::load_site(site_);
    site.sensors = {reference_lidar()};
    mapping::save_site(site_, site);
  }
  void tick_until(const std::function<bool()>& done) {
    while (!done()) {  // the test's own limit ends this
      now_ += std::chrono::milliseconds(20);
      run_.tick(now_);
      std::this_thread::yield();
    }
  }

  test::TemporaryFolder folder_;
  fs::path site_ = folder_.path() / "site";
  bool enabled_ = false;
  std::optional<control::wire::Status> drive_;
  int opened_ = 0, closed_ = 0, idle_ = 0;
  Stamp now_ = stamp_from_seconds(1'700'000'000.0);
  SiteRun run_{site_,
               std::make_unique<SilentLink>(enabled_, drive_),
               {.opened = [this](TransportRun&) { ++opened_; },
                .closing = [this] { ++closed_; },
                .idle = [this](const CycleInput&) { ++idle_; }}};
};

TEST_F(SiteRunTest, ARunThatCannotBeBegunIsToldAndTriedAgain) {
  import();
  draw_routes();
  mount_lidar();
  fs::create_directory(site_ / "madori.db");  // what cannot be opened as a database
  run_.reload();
  tick_until([this] { return run_.missing().find("madori.db") != std::string::npos; });
  EXPECT_EQ(opened_, 0);
  EXPECT_FALSE(run_.view());
  fs::remove(site_ / "madori.db");
  tick_until([this] { return run_.view().has_value(); });
  EXPECT_EQ(opened_, 1);
  EXPECT_FALSE(enabled_);
}

TEST_F(SiteRunTest, ItDrivesAsSoonAsNothingIsMissing) {
  const auto told = [this](const char* what) {
    return [this, what] { return run_.missing().find(what) != std::string::npos; };
  };
  tick_until(told("site.yaml"));
  EXPECT_FALSE(run_.say({OperatorWord::Resume, {}, {}}));
  EXPECT_TRUE(run_.may_change_site());
  import();
  run_.reload();
  tick_until(told("path.csv"));
  draw_routes();
  run_.reload();
  tick_until(told("names no lidar"));
  mount_lidar();
  run_.reload();
  tick_until([this] { return run_.view().has_value(); });
  EXPECT_EQ(run_.missing(), "");
  EXPECT_EQ(opened_, 1);
  EXPECT_EQ(closed_, 0);
  EXPECT_GT(idle_, 0);
  EXPECT_EQ(run_.view()->mode, Mode::Paused);
  EXPECT_TRUE(run_.node_name(1));
  EXPECT_FALSE(run_.node_name(4711));
  EXPECT_FALSE(enabled_);
}

TEST_F(SiteRunTest, AChangeIsTakenOverByANewRunAndAFaultySiteEndsIt) {
  import();
  draw_routes();
  mount_lidar();
  tick_until([this] { return opened_ == 1; });
  run_.reload();
  tick_until([this] { return opened_ == 2; });
  EXPECT_EQ(closed_, 1);
  EXPECT_TRUE(run_.view());
  fs::remove(site_ / "routes/tree.csv");
  run_.reload();
  tick_until([this] { return !run_.view(); });
  EXPECT_EQ(closed_, 2);
  EXPECT_NE(run_.missing(), "");
}

TEST_F(SiteRunTest, AnEmergencyStopOutlivesAChangeOfTheSiteUntilItIsConfirmed) {
  import();
  draw_routes();
  mount_lidar();
  tick_until([this] { return opened_ == 1; });
  drive_ = control::wire::Status{.emergency_stop = true};
  tick_until([this] { return run_.view()->mode == Mode::EmergencyStop; });
  drive_->emergency_stop = false;
  EXPECT_TRUE(run_.stands());
  EXPECT_FALSE(run_.may_change_site());
  run_.reload();  // as a change by another program
  for (int i = 0; i < 300; ++i) {
    now_ += std::chrono::milliseconds(20);
    run_.tick(now_);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(opened_, 1);
  EXPECT_EQ(run_.view()->mode, Mode::EmergencyStop);
  run_.say({OperatorWord::Confirm, {}, {}});
  tick_until([this] { return opened_ == 2; });
}

TEST(Statistics, SumsSurviveARestart) {
  const test::TemporaryFolder folder;
  const Stamp now = stamp_from_seconds(1'700'000'000.0);
  {
    StatisticsStore store(folder.path() / "madori.db");
    EXPECT_FALSE(store.since());
    Work work{12.5, 20.0, 5.0, {{"paused", {1, 5.0}}}};
    store.add(work, now);
    work.causes["no-order"] = {2, 1.0};
    store.add(work, now + std::chrono::seconds(5));
  }
  const StatisticsStore store(folder.path() / "madori.db");
  const Work sums = store.sums();
  EXPECT_DOUBLE_EQ(sums.distance_m, 25.0);
  EXPECT_EQ(sums.causes.at("paused").count, 2);
  EXPECT_DOUBLE_EQ(sums.causes.at("paused").seconds, 10.0);
  EXPECT_EQ(sums.causes.at("no-order").count, 2);
  ASSERT_TRUE(store.since());
  EXPECT_NEAR(to_seconds(*store.since() - now), 0.0, 1e-3);
}

/// Drives for the measurement alone: nothing is complete but the vehicle step.
TEST(SiteRunMounting, IsMeasuredBeforeTheSiteCanBeDrivenAndStopsWhenTold) {
  constexpr Duration kStep = std::chrono::milliseconds(20);
  const test::TemporaryFolder folder;
  mapping::ImportOptions import;
  import.drawing = fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
  import.site = folder.path() / "site";
  mapping::import_drawing(import);
  mapping::Site site = mapping::load_site(import.site);
  site.sensors = {{"front", "lms1xx", 0.6, 0.1, 0.25, 10.0}};
  mapping::save_site(import.site, site);
  auto setup = test::small_hall();
  setup.sensors = {{"front", "lms1xx", 0.7, 0.0, 0.25, 0.0}};
  setup.scenario.lms1xx.noise_m = 0.012;
  const auto factory = std::make_shared<simulation::Factory>(setup);
  SiteRun run(import.site, std::make_unique<test::FactoryLink>(factory, WheelGeometry{}, kStep), {});
  const auto tick_until = [&](MountingView::State state) {
    while (run.mounting().state != state) {  // the test's own limit ends this
      run.tick(factory->now() + kStep);
      std::this_thread::yield();
    }
  };
  EXPECT_EQ(run.mounting().state, MountingView::State::Idle);
  run.measure_mounting();
  tick_until(MountingView::State::Done);
  EXPECT_FALSE(run.view()) << "there are no routes";
  const auto findings = run.mounting().findings;
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings.front().measured.known, localization::MountingKnown::All);
  EXPECT_NEAR(findings.front().found.x_m, 0.7, 0.01);
  EXPECT_NEAR(findings.front().found.y_m, 0.0, 0.01);
  EXPECT_NEAR(findings.front().found.yaw_deg, 0.0, 0.3);
  EXPECT_TRUE(factory->collisions().empty());

  run.measure_mounting();
  for (int i = 0; i < 150; ++i) run.tick(factory->now() + kStep);
  EXPECT_GT(factory->truth().linear_mps, 0.1);
  run.stop_measuring();
  tick_until(MountingView::State::Stopped);
  for (int i = 0; i < 100; ++i) run.tick(factory->now() + kStep);
  EXPECT_LT(std::abs(factory->truth().linear_mps), 0.01);
}

/// Panels of a vehicle in a hall of 20 m by 12 m whose site can be driven.
struct PanelsOfAHall {
  PanelsOfAHall() {
    mapping::Site record;
    record.name = "hall";
    record.drawing = {"a.png", 400, 240, 1, 0.0};
    record.scale = mapping::ScaleRecord{0.05, "known", 0.0, 0.0, "", {}, {}};
    record.sensors = setup().sensors;
    mapping::save_site(folder.path(), record);
    folder.write("walls.csv", "id,x1,y1,x2,y2\n1,0,0,20,0\n2,20,0,20,12\n3,20,12,0,12\n4,0,12,0,0\n");
    fs::create_directories(folder.path() / "routes");
    folder.write("routes/path.csv", "ID,x,y\n1,2,4\n2,18,4\n");
    folder.write("routes/tree.csv", "ID,EDA\n1,2\n2,1\n");
    run.load_now();
    tick(50);
  }
  static simulation::FactorySetup setup() {
    auto hall = test::small_hall();
    hall.sensors = {{"front", "lms1xx", 0.6, 0.0, 0.25, 0.0}};
    return hall;
  }
  void opened(TransportRun& begun) {
    ++begun_runs;
    begun.set_tap([this, &begun](const auto& in, const auto& /*output*/, const auto& state) {
      panel.observe(in, state, begun);
    });
  }
  void tick(int times) {
    for (; times > 0; --times) run.tick(factory->now() + kStep);
  }
  [[nodiscard]] double speed() const { return std::abs(factory->truth().linear_mps); }

  static constexpr Duration kStep = std::chrono::milliseconds(20);
  int begun_runs = 0;
  test::TemporaryFolder folder;
  std::shared_ptr<simulation::Factory> factory = std::make_shared<simulation::Factory>(setup());
  SiteRun run{folder.path(),
              std::make_unique<test::FactoryLink>(factory, WheelGeometry{}, kStep),
              {.opened = [this](TransportRun& begun) { opened(begun); }, .closing = {}, .idle = {}}};
  PanelVehicle panel{run, folder.path() / "madori.db", {}};
};

TEST(Panels, WhileTheMountingsAreMeasuredNothingElseIsBegunAndNothingWaitsForItsEnd) {
  PanelsOfAHall hall;
  ASSERT_TRUE(hall.panel.measure_mounting().accepted);
  hall.tick(150);
  ASSERT_GT(hall.speed(), 0.1);
  EXPECT_EQ(hall.panel.start_braking_test(false).reason.code, "measuring");
  EXPECT_EQ(hall.panel.measure_mounting().reason.code, "measuring");
  EXPECT_EQ(hall.panel.may_change_site().reason.code, "measuring");
  EXPECT_EQ(hall.panel.set_pose({}).reason.code, "measuring");
  EXPECT_EQ(hall.panel.command(hmi::Command::Resume).reason.code, "measuring");
  EXPECT_FALSE(hall.run.say({OperatorWord::Resume, {}, {}}));
  hall.tick(10);
  EXPECT_GT(hall.speed(), 0.1) << "it is still measured";
  EXPECT_TRUE(hall.panel.command(hmi::Command::Stop).accepted);
  hall.tick(100);
  const double driven_m = hall.factory->distance_driven_m();
  hall.tick(500);
  EXPECT_NEAR(hall.factory->distance_driven_m(), driven_m, 0.01);
}

TEST(Panels, AChangeOfTheSiteWaitsUntilTheMountingsAreMeasured) {
  PanelsOfAHall hall;
  ASSERT_TRUE(hall.panel.measure_mounting().accepted);
  hall.tick(100);
  hall.run.reload();
  for (int i = 0; i < 40; ++i) {  // a second in which it would have been loaded
    std::this_thread::sleep_for(std::chrono::milliseconds(25));
    hall.tick(1);
  }
  EXPECT_TRUE(hall.run.is_measured());
  EXPECT_TRUE(hall.run.loads());
  EXPECT_EQ(hall.begun_runs, 1);
  hall.run.stop_measuring();
  while (hall.begun_runs == 1) {  // the test's own limit ends this
    hall.tick(1);
    std::this_thread::yield();
  }
  EXPECT_FALSE(hall.run.loads());
}

TEST(Panels, NoMeasurementBeginsBeforeTheChangedSiteIsTakenOver) {
  PanelsOfAHall hall;
  hall.run.reload();  // and nobody ticks
  EXPECT_EQ(hall.panel.measure_mounting().reason.code, "site-loading");
  while (hall.run.loads()) hall.tick(1);
  EXPECT_EQ(hall.begun_runs, 2);
  EXPECT_TRUE(hall.panel.measure_mounting().accepted);
}

TEST(Panels, AnOrderOfTooManyStopsIsCalledThat) {
  PanelsOfAHall hall;
  const std::vector<hmi::StopView> all(100, hmi::StopView{1, "pass", 0.0, false});
  auto more = all;
  more.push_back(all.front());
  EXPECT_EQ(hall.panel.add_order({}, 1).reason.code, "empty-order");
  EXPECT_EQ(hall.panel.add_order(more, 1).reason.code, "long-order");
  EXPECT_TRUE(hall.panel.add_order(all, 1).accepted);
}

TEST(Panels, ABrakingTestHasTheVehicleUntilItEndsOrSomebodyPressesStop) {
  PanelsOfAHall hall;
  ASSERT_TRUE(hall.panel.start_braking_test(false).accepted);
  const auto refused = [&] {
    EXPECT_EQ(hall.panel.start_braking_test(false).reason.code, "driving");
    EXPECT_EQ(hall.panel.measure_mounting().reason.code, "driving");
    EXPECT_EQ(hall.panel.may_change_site().reason.code, "driving");
    EXPECT_EQ(hall.panel.command(hmi::Command::Resume).reason.code, "driving");
    EXPECT_EQ(hall.panel.jog({0.3, 0.0}, &hall).reason.code, "driving");
  };
  refused();  // it has not moved yet
  for (int i = 0; i < 500 && hall.speed() < 0.5; ++i) hall.tick(1);
  ASSERT_GE(hall.speed(), 0.5) << hall.panel.braking().trouble.text;
  refused();
  EXPECT_TRUE(hall.panel.command(hmi::Command::Stop).accepted);
  hall.tick(150);
  EXPECT_FALSE(hall.panel.braking().running);
  EXPECT_LT(hall.speed(), 0.01);
  EXPECT_TRUE(hall.panel.may_change_site().accepted);
}

}  // namespace
}  // namespace madori::app
