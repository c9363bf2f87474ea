#include "tests/bench/buildings/building_operator.hpp"

namespace madori::bench {
namespace {

using app::Mode;
using app::OperatorWord;

constexpr double kConfirmsAfterS = 3.0;  ///< an operator comes to a vehicle that asks for one
constexpr double kTapsAfterS = 30.0;     ///< to a vehicle that does not know where it is
constexpr double kLooksAfterS = 30.0;    ///< to a vehicle that cannot see what stands before it
constexpr double kGivesUpAfterS = 120.0;
constexpr double kTapOffM = 0.3;  ///< of the issue
constexpr double kTapOffRad = to_rad(6.0);

}  // namespace

void BuildingOperator::look() {
  keep_trail();
  const auto& state = run_.state();
  // While it localizes the reasons change from scan to scan, and a distance by the way; it is one standstill.
  const bool searches = state.mode == Mode::Localizing;
  const std::string because = to_string(state.mode) + (searches ? "" : ": " + state.standstill.cause.code);
  if (because != stands_because_ || app::drives(state.mode)) {
    stands_because_ = because;
    since_ = run_.factory->now();
    return;
  }
  const bool asks = state.mode == Mode::EmergencyStop || state.mode == Mode::Fault;
  const bool unseen = state.mode == Mode::Waiting && (state.block.unseen || state.block.felt);
  if (state.mode == Mode::Paused && stood_s() > 1.0) {
    if (state.elsewhere) help();
    say(OperatorWord::Resume);
  } else if (asks && stood_s() > kConfirmsAfterS) {
    pull_back();
    say(OperatorWord::Confirm);
    help();
  } else if (unseen && stood_s() > kLooksAfterS && is_free_there(state.ahead.check.where)) {
    say(OperatorWord::Resume);
    help();
  } else if ((state.standstill.cause.code == app::entry(app::Cause::StopUnsure).code ||
              state.standstill.cause.code == app::entry(app::Cause::StopTaken).code) &&
             stood_s() > kLooksAfterS) {
    say(OperatorWord::GoOn);  // counted as delivered only where it is near its station
    help();
  } else if (searches && stood_s() > kTapsAfterS && figures_.taps == 0) {
    tap();
  }
}

bool BuildingOperator::gives_up() const {
  return run_.state().mode == Mode::Localizing && stood_s() > kGivesUpAfterS;
}

void BuildingOperator::say(OperatorWord word) {
  run_.run->say({word, {}, {}});
  if (run_.state().mode != Mode::Localizing) since_ = run_.factory->now();
}

void BuildingOperator::help() {
  const auto truth = run_.factory->truth().map_from_base;
  char at[48];
  std::snprintf(at, sizeof at, ", at %.0f s (%.2f, %.2f)", run_.time_s(), truth.x_m(), truth.y_m());
  figures_.helps.push_back(stands_because_ + at);
}

/// Where the vehicle truly stands, as well as a person sees it.
void BuildingOperator::tap() {
  const auto truth = run_.factory->truth().map_from_base;
  const double direction = random_.uniform(-kPi, kPi);
  const double turn = random_.below(2) == 0 ? kTapOffRad : -kTapOffRad;
  app::GivenPose given;
  given.position = {truth.x_m() + kTapOffM * std::cos(direction),
                    truth.y_m() + kTapOffM * std::sin(direction)};
  given.yaw_rad = wrap_angle(truth.yaw_rad() + turn);
  run_.run->say({OperatorWord::SetPose, {}, given});
  say(OperatorWord::Resume);
  ++figures_.taps;
}

bool BuildingOperator::is_free_there(const Point2<Map>& place) const {
  constexpr double kStepM = 0.5;
  const auto& factory = *run_.factory;
  const auto truth = factory.truth();
  const auto at = truth.building_from_base * (truth.map_from_base.inverse() * place);
  const auto outline = simulation::rectangle(at, 0.0, 2.0 * kStepM, 2.0 * kStepM);
  return factory.world().obstacles().find(outline, factory.vehicle().body()) == nullptr;
}

/// By hand, the way it came, until the bumper is free.
void BuildingOperator::pull_back() {
  if (!run_.state().drive.bumper || trail_.empty()) return;
  run_.factory->set_pose(trail_.front());
  trail_.clear();
}

void BuildingOperator::keep_trail() {
  constexpr double kEveryM = 0.05;
  constexpr std::size_t kLength = 10;
  const auto truth = run_.factory->truth().map_from_base;
  if (!trail_.empty() && distance_m(trail_.back().translation(), truth.translation()) < kEveryM) return;
  trail_.push_back(truth);
  if (trail_.size() > kLength) trail_.pop_front();
}

}  // namespace madori::bench
