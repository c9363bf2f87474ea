#include "tests/bench/movers/mover_drive.hpp"

namespace madori::bench {
namespace {

/// Movers of the odometry frame, where the vehicle truly was.
std::vector<ToldMover> in_building(const std::vector<planning::Mover<Odom>>& movers,
                                   const Transform2<Building, Odom>& building_from_odom) {
  const Transform2<Building, Odom> turn(0.0, 0.0, building_from_odom.yaw_rad());
  std::vector<ToldMover> told;
  for (const auto& m : movers) {
    const Point2<Building> velocity = turn * Point2<Odom>{m.vx_mps, m.vy_mps};
    told.push_back({building_from_odom * m.at, velocity.x_m, velocity.y_m, m.radius_m});
  }
  return told;
}

}  // namespace

MoverDrive::MoverDrive(const DriveOptions& options)
    : options_(options), site_(app::load_for_driving(options.site)), random_(options.seed) {
  auto setup = simulation::load_setup(options.site, options.site / options.scenario);
  setup.seed = setup.scenario.seed = options.seed;
  run_ = std::make_unique<test::LockStepRun>(site_, setup, [this](const simulation::Factory&) {
    return std::make_unique<ListeningPose>(
        std::make_unique<app::LocalizerPose>(site_.walls, site_.config.lidars), heard_);
  });
  traffic_ = std::make_unique<RoamingTraffic>(*run_->factory, options.seed);
  truth_ = std::make_unique<TruthHistory>(*run_->factory);
  const NearestNeighbour neighbour(site_.config.walls, run_->factory->world().frames(), options.neighbour);
  lidars_.assign(site_.config.lidars.size(),
                 {neighbour, {}, std::vector<MoverScore>(options.thresholds_mps.size()), {}});
  run_->run->set_tap([this](const auto&, const auto&, const auto& state) { look_on(state); });
}

DriveScores MoverDrive::drive() {
  constexpr double kTrafficEveryS = 0.5;
  while (run_->time_s() < 60.0 * options_.minutes) {
    traffic_->advance();
    operate();
    run_->run_until([] { return false; }, kTrafficEveryS);
  }
  return scores();
}

void MoverDrive::look_on(const app::CycleState& state) {
  truth_->note();
  for (const HeardSweep& sweep : heard_) {
    Judged& judged = lidars_[sweep.cloud.lidar];
    const app::MoverWatch& watch = state.movers[sweep.cloud.lidar];
    if (watch.looked == judged.looked || watch.looked != sweep.cloud.stamp) continue;
    judged.looked = watch.looked;
    judge(sweep, watch.objects, judged);
  }
  heard_.clear();
}

void MoverDrive::judge(const HeardSweep& sweep, const planning::MovingObjects& objects, Judged& judged) {
  const Stamp stamp = sweep.cloud.stamp;
  const auto vehicle = truth_->vehicle_at(stamp);
  if (!vehicle) return;
  const LidarModel& model = site_.config.lidars[sweep.cloud.lidar];
  const LidarPlace lidar{model, *vehicle * model.mounting.base_from_lidar()};
  const auto truths = truth_->movers_at(stamp, lidar);
  const Point2<Building> here = lidar.pose.translation();
  judged.tracker.add(stamp, in_building(objects.movers(), *vehicle * sweep.odom_from_base.inverse()), truths,
                     here);
  judged.neighbour.update(sweep.cloud, *vehicle);
  for (std::size_t i = 0; i < judged.baseline.size(); ++i)
    judged.baseline[i].add(stamp, judged.neighbour.faster_than(options_.thresholds_mps[i]), truths, here);
  ++looks_;
}

/// The operator gives the next order, and does what the table of states demands: clears the way, confirms.
void MoverDrive::operate() {
  constexpr double kConfirmsAfterS = 3.0, kLooksAfterS = 30.0, kTellsAfterS = 60.0;
  const auto& state = run_->state();
  if (run_->orders->list(true).empty()) {
    orders_ += run_->station >= 0;
    run_->order_somewhere(random_);
  }
  const std::string because = to_string(state.mode);
  if (because != stands_because_ || app::drives(state.mode)) stands_since_ = run_->factory->now();
  stands_because_ = because;
  const double stood_s = to_seconds(run_->factory->now() - stands_since_);
  const auto truth = run_->factory->truth().map_from_base;
  const auto say = [&](const app::OperatorCommand& command, bool help) {
    run_->run->say(command);
    stands_since_ = run_->factory->now();
    helps_ += help;
  };
  const bool asks = state.mode == app::Mode::EmergencyStop || state.mode == app::Mode::Fault;
  if (asks && stood_s > kConfirmsAfterS) say({app::OperatorWord::Confirm, {}, {}}, true);
  if (state.mode == app::Mode::Paused && stood_s > kConfirmsAfterS)
    say({app::OperatorWord::Resume, {}, {}}, false);
  if (state.standstill.remedy == app::notice(app::Remedy::LookAndGoOn))
    say({app::OperatorWord::GoOn, {}, {}}, false);  // a planar lidar's vehicle asks before every door
  if (state.mode == app::Mode::Waiting && stood_s > kLooksAfterS) {
    traffic_->make_room();
    say({app::OperatorWord::Resume, {}, {}}, true);
  }
  if (state.mode == app::Mode::Localizing && stood_s > kTellsAfterS)
    say({app::OperatorWord::SetPose, {}, {truth.translation(), truth.yaw_rad(), {0.3, 0.1}}}, true);
}

DriveScores MoverDrive::scores() {
  DriveScores all;
  all.baseline.resize(options_.thresholds_mps.size());
  for (Judged& judged : lidars_) {
    judged.tracker.end();
    all.tracker.merge(judged.tracker);
    for (std::size_t i = 0; i < judged.baseline.size(); ++i) {
      judged.baseline[i].end();
      all.baseline[i].merge(judged.baseline[i]);
    }
  }
  all.looks = looks_;
  all.driven_m = run_->factory->distance_driven_m();
  all.orders = orders_;
  all.helps = helps_;
  return all;
}

}  // namespace madori::bench
