#include "tests/end_to_end/encounters/meetings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "app/cycle/stages.hpp"
#include "planning/obstacle_check/sure_sight.hpp"

namespace madori::encounters {
namespace {

using simulation::MoverKind;

constexpr double kStanding_mps = 0.01;
constexpr double kRounding_mps = 0.01;  ///< of a speed that is kept: wheels slip
constexpr double kTick_s = 0.02;

/// What the vehicle did over the last tenth of a second: a single step of the factory is all slip.
class Pace {
 public:
  void add(const Transform2<Map, Base>& pose) {
    poses_.push_back(pose);
    if (poses_.size() > kSteps + 1) poses_.erase(poses_.begin());
  }
  [[nodiscard]] VelocityCommand now() const {
    if (poses_.size() < 2) return {};
    const double time_s = kTick_s * static_cast<double>(poses_.size() - 1);
    const auto way = poses_.front().inverse() * poses_.back();
    return {std::hypot(way.x_m(), way.y_m()) / time_s, std::abs(way.yaw_rad()) / time_s};
  }

 private:
  static constexpr std::size_t kSteps = 5;
  std::vector<Transform2<Map, Base>> poses_;
};

/// Whether the vehicle was in motion at the touch: driving, or turning on the spot.
bool moved(const simulation::Collision& c) {
  return c.speed_mps >= kStanding_mps || c.turn_radps >= kStanding_mps;
}

/// Whether nobody sees who lies before the vehicle, so that it drives as slowly as that asks.
bool looks_over(const app::CycleConfig& config) {
  return config.sure_low_m <= 0.0 && config.low_bodies_guarded_by.empty();
}

}  // namespace

Meetings::Meetings(const MeetingOptions& options)
    : options_(options), site_(app::load_for_driving(options.site)) {
  random_.seed(options.seed + static_cast<unsigned>(options.speed_mps * 1000.0));
  auto& c = site_.config;
  c.pursuit.speed.max_speed_mps = c.limits.max_speed_mps = c.movers.top_speed_mps = options.speed_mps;
  c.limits.max_wheel_speed_mps = options.speed_mps + 0.3;
  if (!options.detours) c.detour_after_s = c.reroute_after_s = 1e6;  // it is stopping that is looked at
  auto setup = simulation::load_setup(options.site, options.scenario);
  setup.scenario.movers.clear();
  setup.seed = options.seed;
  run_ = std::make_unique<test::LockStepRun>(site_, setup);
}

void Meetings::meet(MoverKind kind, int count, Tally& tally) {
  Placements placements(*run_, random_, driven_mps());
  for (int met = 0; met < count;) {
    go_on();
    const auto placement = kind == MoverKind::Person ? placements.crossing() : placements.standing(kind);
    if (!placement) {
      run_->tick();
      continue;
    }
    encounter(*placement, tally);
    ++met;
  }
}

void Meetings::pass_carts(int count, CartTally& tally) {
  Placements placements(*run_, random_, driven_mps());
  while (tally.met < count) {
    go_on();
    const auto placement = placements.standing(MoverKind::Cart);
    if (!placement) {
      run_->tick();
      continue;
    }
    const std::size_t touched = run_->factory->collisions().size();
    const auto order = order_;
    bool around = false;
    run_->factory->add_mover(placement->mover);
    const bool past = run_->run_until(
        [&] {
          around = around || run_->state().mode == app::Mode::Detouring;
          return run_->orders->find(*order)->state == app::OrderState::Done;
        },
        150.0);
    ++tally.met;
    ++(!past ? tally.waited : around ? tally.around : tally.other_route);
    tally.contacts += contacts_since(touched);
    if (options_.verbose || !past)
      std::printf("%8.2f s cart at (%.2f, %.2f): %s; %s\n", run_->time_s(), placement->at.x_m,
                  placement->at.y_m, past ? (around ? "around" : "past") : "waited",
                  run_->state().standstill.remedy.text.c_str());
    clear();
  }
}

/// Drives until the vehicle is on its way at speed. Throws Error, with what the vehicle says, where it is not
/// within ten minutes: an operator would have been called long before.
void Meetings::go_on() {
  constexpr double kPatience_s = 600.0;
  const bool on_its_way = run_->run_until(
      [&] {
        if (!order_ || run_->orders->find(*order_)->state != app::OrderState::Running)
          if (run_->orders->list(true).empty()) order_ = run_->order_somewhere(random_);
        if (run_->state().standstill.remedy == app::notice(app::Remedy::LookAndGoOn))
          run_->run->say({app::OperatorWord::GoOn, {}});  // a planar lidar's vehicle asks before every door
        return run_->state().mode == app::Mode::Driving &&
               run_->factory->truth().linear_mps > 0.5 * driven_mps();
      },
      kPatience_s);
  if (on_its_way) return;
  const auto& state = run_->state();
  const auto at = run_->factory->truth().map_from_base;
  char where[80] = "";
  std::snprintf(where, sizeof where, "vehicle at (%.2f, %.2f, %.0f deg), %.0f s", at.x_m(), at.y_m(),
                to_deg(at.yaw_rad()), run_->time_s());
  throw Error(where, std::string(to_string(state.mode)) + ": " + state.standstill.remedy.text,
              "the vehicle does not go on");
}

int Meetings::contacts_since(std::size_t before) const {
  const auto& all = run_->factory->collisions();
  return static_cast<int>(std::count_if(all.begin() + static_cast<std::ptrdiff_t>(before), all.end(), moved));
}

double Meetings::driven_mps() const {
  return looks_over(site_.config) ? std::min(options_.speed_mps, planning::kUnseenPersonMps)
                                  : options_.speed_mps;
}

void Meetings::encounter(const Placement& placement, Tally& tally) {
  auto& factory = *run_->factory;
  const bool walks = placement.mover.kind == MoverKind::Person;
  const std::size_t touched = factory.collisions().size();
  double nearest_m = 10.0, fastest_mps = 0.0, stood_s = 0.0;
  bool stopped = false;
  Pace pace;
  factory.add_mover(placement.mover);
  run_->run_until(
      [&] {
        const auto truth = factory.truth();
        const auto outline = simulation::outline(factory.bodies().front());
        const double away_m =
            test::distance_between(factory.vehicle().footprint(truth.building_from_base), outline);
        const bool moves =
            std::abs(truth.linear_mps) > kStanding_mps || std::abs(truth.angular_radps) > kStanding_mps;
        pace.add(truth.map_from_base);
        fastest_mps = std::max(fastest_mps, pace.now().linear_mps);
        if (moves) nearest_m = std::min(nearest_m, away_m);
        stood_s = run_->stands() ? stood_s + kTick_s : 0.0;
        stopped = stopped || (run_->stands() && run_->state().mode == app::Mode::Waiting);
        return (!walks && stopped && stood_s > 1.0) || factory.collisions().size() > touched;
      },
      walks ? 9.0 : 45.0);
  const int contacts = contacts_since(touched);
  ++tally.met;
  tally.stopped += stopped;
  tally.contacts += contacts > 0;
  const double touch_mps = contacts > 0 ? app::outline_mps(site_.config.check.vehicle, pace.now()) : 0.0;
  tally.touch_mps = std::max(tally.touch_mps, touch_mps);
  tally.refused += contacts > 0 && placement.mover.kind == MoverKind::LyingBody && looks_over(site_.config) &&
                   touch_mps <= planning::kUnseenPersonMps + kRounding_mps;
  tally.others_touched += contacts == 0 && factory.collisions().size() > touched;
  tally.nearest_m = std::min(tally.nearest_m, nearest_m);
  tally.fastest_mps = std::max(tally.fastest_mps, fastest_mps);
  if (contacts > 0 || (!stopped && !walks) || options_.verbose)
    report(placement, stopped, touch_mps, nearest_m);
  clear();
}

void Meetings::report(const Placement& placement, bool stopped, double touch_mps, double nearest_m) const {
  char touch[60] = "";
  if (touch_mps > 0.0) std::snprintf(touch, sizeof touch, ", CONTACT at %.2f m/s", touch_mps);
  const auto truth = run_->factory->truth().map_from_base;
  std::printf("%8.2f s %s at (%.2f, %.2f), %.2f m/s: %s%s, nearest %.3f m; vehicle (%.2f, %.2f, %.0f deg)\n",
              run_->time_s(), placement.mover.name.c_str(), placement.at.x_m, placement.at.y_m,
              placement.mover.kind == MoverKind::Person ? placement.mover.speed_mps : 0.0,
              stopped ? "stopped" : "NOT STOPPED", touch, nearest_m, truth.x_m(), truth.y_m(),
              to_deg(truth.yaw_rad()));
  std::fflush(stdout);
}

/// Takes the body away, and plays the operator who has looked.
void Meetings::clear() {
  run_->factory->clear_movers();
  run_->run_until([] { return false; }, 0.5);
  const app::Mode mode = run_->state().mode;
  if (mode == app::Mode::EmergencyStop || mode == app::Mode::Fault) {
    run_->run->say({app::OperatorWord::Confirm, {}});
    run_->tick();
  }
  run_->run->say({app::OperatorWord::Resume, {}});  // also: forget what no sensor sees any more
  run_->tick();
}

}  // namespace madori::encounters
