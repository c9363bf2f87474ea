// What the cycle's thread asks of the heap while it is in a step: the whole cycle in lock-step drives orders
// in the virtual factory, and every request between a step's first word to localization and its command is
// counted, with where it came from. What works beside the cycle (a thread's thinking, the disk) is not
// counted.
//   cycle_allocations SITE SCENARIO [--warm-s 120] [--count-s 60] [--limit PER_STEP] [--sites 30]
// Exit 1 where the mean of a step is over the limit.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <map>

#include "app/cycle/site_config.hpp"
#include "app/orders/order_store.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/runner/transport_run.hpp"
#include "tests/end_to_end/allocations/allocation_counter.hpp"
#include "tests/support/factory_link.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::allocations {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(20);

/// What was counted in steps.
struct Tally {
  bool on = false;
  std::uint64_t steps = 0, without = 0, most = 0, all = 0;
  bool looked = false;  ///< a revolution came in this step
  std::uint64_t steps_looked = 0, all_looked = 0;

  void begin() {
    before_ = counted();
    looked = false;
    count_here(on);
  }
  void end() {
    count_here(false);
    if (!on) return;
    const std::uint64_t asked = counted() - before_;
    ++steps;
    all += asked;
    without += asked == 0 ? 1 : 0;
    most = std::max(most, asked);
    steps_looked += looked ? 1 : 0;
    all_looked += looked ? asked : 0;
  }

 private:
  std::uint64_t before_ = 0;
};

/// The product's pose source; a step begins with its first word.
class WatchedPose final : public app::PoseSource {
 public:
  WatchedPose(const app::SiteForDriving& site, Tally& tally)
      : pose_(site.walls, site.config.lidars), tally_(tally) {}
  void set_places(const std::vector<Point2<Map>>& drawn) override { pose_.set_places(drawn); }
  PoseEstimate on_odometry(const OdometryReading& reading) override { return pose_.on_odometry(reading); }
  void on_cloud(const PointCloud<Base>& cloud, const Transform2<Odom, Base>& odom_from_base) override {
    tally_.looked = true;
    pose_.on_cloud(cloud, odom_from_base);
  }
  void set_pose(const Transform2<Map, Base>& pose, const PoseSigma& sigma) override {
    pose_.set_pose(pose, sigma);
  }
  void search_anew() override { pose_.search_anew(); }
  void set_thinking(bool thinking) override {
    tally_.begin();
    pose_.set_thinking(thinking);
  }
  [[nodiscard]] std::vector<PoseHypothesis> hypotheses() const override { return pose_.hypotheses(); }
  [[nodiscard]] std::shared_ptr<const localization::BentDrawing> bent() const override {
    return pose_.bent();
  }

 private:
  app::LocalizerPose pose_;
  Tally& tally_;
};

/// The virtual factory in lock-step; a step ends with its command.
class WatchedLink final : public app::VehicleLink {
 public:
  WatchedLink(std::unique_ptr<app::VehicleLink> link, Tally& tally) : link_(std::move(link)), tally_(tally) {}
  void collect(app::CycleInput& input) override { link_->collect(input); }
  void send(const app::CycleOutput& output) override {
    tally_.end();
    link_->send(output);
  }
  [[nodiscard]] std::string problem() const override { return link_->problem(); }

 private:
  std::unique_ptr<app::VehicleLink> link_;
  Tally& tally_;
};

struct Wishes {
  std::string site, scenario;
  double warm_s = 120.0, count_s = 60.0, limit = 1e9;
  std::size_t sites = 30;
  int depth = 4;
};

void drive(const Wishes& wishes, Tally& tally) {
  const auto site = app::load_for_driving(wishes.site);
  auto factory = std::make_shared<simulation::Factory>(simulation::load_setup(wishes.site, wishes.scenario));
  const test::TemporaryFolder database;
  app::TransportOptions options;
  options.site = database.path();
  options.lock_step = true;
  app::TransportRun run(
      site.config, std::make_unique<WatchedPose>(site, tally),
      std::make_unique<WatchedLink>(
          std::make_unique<test::FactoryLink>(factory, site.config.odometry.wheels, kStep), tally),
      options);
  app::OrderStore orders(database.path() / "madori.db");
  (void)orders.add({{13, app::StopAction::Pass, 0.0}, {15, app::StopAction::Pass, 0.0}}, 900, factory->now());
  run.say({app::OperatorWord::Resume, {}, {}});
  const Stamp begun = factory->now();
  double driven_m = 0.0;
  for (double t = 0.0; t < wishes.warm_s + wishes.count_s; t = to_seconds(factory->now() - begun)) {
    if (!tally.on && t >= wishes.warm_s) {
      tally.on = true;
      driven_m = factory->distance_driven_m();
    }
    run.tick(factory->now() + kStep);
  }
  std::printf("%.0f s, %.0f m driven\n", wishes.count_s, factory->distance_driven_m() - driven_m);
}

void tell(const Wishes& wishes, const Tally& tally) {
  std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> by_name;
  for (const Site& site : sites()) {
    auto& [count, bytes] = by_name[named(site, wishes.depth)];
    count += site.count;
    bytes += site.bytes;
  }
  std::vector<std::pair<std::string, std::pair<std::uint64_t, std::uint64_t>>> all(by_name.begin(),
                                                                                   by_name.end());
  std::ranges::sort(all, [](const auto& a, const auto& b) { return a.second > b.second; });
  const double steps = static_cast<double>(std::max<std::uint64_t>(1, tally.steps));
  for (std::size_t i = 0; i < std::min(wishes.sites, all.size()); ++i)
    std::printf("%9.3f a step, %7.0f bytes each: %s\n", static_cast<double>(all[i].second.first) / steps,
                static_cast<double>(all[i].second.second) / static_cast<double>(all[i].second.first),
                all[i].first.c_str());
  std::printf(
      "%llu steps, %.4f requests a step, most %llu, %llu steps with none; %llu steps with a revolution, %.2f "
      "requests "
      "each\n",
      static_cast<unsigned long long>(tally.steps), static_cast<double>(tally.all) / steps,
      static_cast<unsigned long long>(tally.most), static_cast<unsigned long long>(tally.without),
      static_cast<unsigned long long>(tally.steps_looked),
      static_cast<double>(tally.all_looked) /
          static_cast<double>(std::max<std::uint64_t>(1, tally.steps_looked)));
}

}  // namespace
}  // namespace madori::allocations

int main(int argc, char** argv) {
  using namespace madori::allocations;
  Wishes wishes;
  CLI::App app("Counts what the cycle's thread asks of the heap");
  app.add_option("site", wishes.site)->required();
  app.add_option("scenario", wishes.scenario)->required();
  app.add_option("--warm-s", wishes.warm_s, "seconds that do not count");
  app.add_option("--count-s", wishes.count_s, "seconds that count");
  app.add_option("--limit", wishes.limit, "requests a step, in the mean");
  app.add_option("--sites", wishes.sites, "how many places are told");
  app.add_option("--depth", wishes.depth, "how many functions on the way to a place are told");
  CLI11_PARSE(app, argc, argv);
  Tally tally;
  drive(wishes, tally);
  tell(wishes, tally);
  return static_cast<double>(tally.all) > wishes.limit * static_cast<double>(tally.steps) ? 1 : 0;
}
