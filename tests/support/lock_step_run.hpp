#pragma once

#include <functional>
#include <memory>
#include <random>
#include <vector>

#include "app/cycle/site_config.hpp"
#include "app/pose/localizer_pose.hpp"
#include "app/runner/transport_run.hpp"
#include "core/segment_distance.hpp"
#include "tests/support/factory_link.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::test {

/// The whole cycle with real localization in the virtual factory: the devices' own bytes, lock-step, steps of
/// 20 ms, no clock.
class LockStepRun {
 public:
  static constexpr Duration kStep = std::chrono::milliseconds(20);

  using SourceMaker = std::function<std::unique_ptr<app::PoseSource>(const simulation::Factory&)>;

  /// Without `make_source` the vehicle localizes as the product does.
  LockStepRun(const app::SiteForDriving& site, const simulation::FactorySetup& setup,
              const SourceMaker& make_source = {})
      : factory(std::make_shared<simulation::Factory>(setup)), begun_(factory->now()) {
    app::TransportOptions options;
    options.site = database_.path();
    options.lock_step = true;
    options.store_poll_s = 0.1;
    run = std::make_unique<app::TransportRun>(
        site.config,
        make_source ? make_source(*factory)
                    : std::make_unique<app::LocalizerPose>(site.walls, site.config.lidars),
        std::make_unique<FactoryLink>(factory, site.config.odometry.wheels, kStep), options);
    orders = std::make_unique<app::OrderStore>(database_.path() / "madori.db");
    run->say({app::OperatorWord::Resume, {}});
  }

  void tick() { run->tick(factory->now() + kStep); }
  /// Steps until `done` or a time of the factory is over; whether it was done.
  bool run_until(const std::function<bool()>& done, double limit_s) {
    for (const Stamp end = factory->now() + duration_from_seconds(limit_s); factory->now() < end;) {
      tick();
      if (done()) return true;
    }
    return false;
  }
  /// An order to a station that another one has not just been given for; its ID.
  std::int64_t order_somewhere(std::mt19937& random) {
    const auto& routes = run->config().routes;
    std::vector<int> stations;
    for (const auto& node : routes.nodes())
      if (node.station && node.id != station && !routes.legs_from(*routes.index_of(node.id)).empty())
        stations.push_back(node.id);
    station = stations[random() % stations.size()];
    return orders->add({{station, app::StopAction::Pass, 0.0}}, 1, factory->now());
  }
  [[nodiscard]] bool stands() const {
    const auto truth = factory->truth();
    return std::abs(truth.linear_mps) < 0.005 && std::abs(truth.angular_radps) < 0.005;
  }
  [[nodiscard]] double time_s() const { return to_seconds(factory->now() - begun_); }
  [[nodiscard]] const app::CycleState& state() const { return run->state(); }

  std::shared_ptr<simulation::Factory> factory;
  std::unique_ptr<app::TransportRun> run;
  std::unique_ptr<app::OrderStore> orders;  ///< as another program has them
  int station = -1;                         ///< of the newest order

 private:
  TemporaryFolder database_;
  Stamp begun_;
};

/// Distance between two outlines on the floor, zero where they meet.
inline double distance_between(const std::vector<Point2<simulation::Building>>& a,
                               const std::vector<Point2<simulation::Building>>& b) {
  if (simulation::overlap(a, b)) return 0.0;
  double nearest_m = std::numeric_limits<double>::infinity();
  const auto corners_to_edges = [&](const auto& corners, const auto& polygon) {
    for (const auto& corner : corners)
      for (std::size_t i = 0; i < polygon.size(); ++i)
        nearest_m =
            std::min(nearest_m,
                     distance_m(Segment2<simulation::Building>{polygon[i], polygon[(i + 1) % polygon.size()]},
                                corner));
  };
  corners_to_edges(a, b);
  corners_to_edges(b, a);
  return nearest_m;
}

}  // namespace madori::test
