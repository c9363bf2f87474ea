#include "tests/bench/buildings/building_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "core/fnv1a.hpp"
#include "tests/bench/buildings/pose_source_choice.hpp"

namespace madori::bench {
namespace {

double cpu_seconds() {
  timespec used{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

std::filesystem::path trace_file(const DriveOptions& options, std::string name) {
  std::replace(name.begin(), name.end(), '/', '_');
  return options.trace.empty() ? "" : options.trace / (name + ".csv");
}

app::SiteForDriving site_of(const BuildingStart& start, const std::filesystem::path& folder,
                            const std::filesystem::path& hand_made) {
  make_site(start, folder);
  if (!hand_made.empty()) use_hand_made_walls(start, hand_made / start.building() / "walls.csv", folder);
  return app::load_for_driving(folder);
}

/// What the check of the way met: a body that was seen, or a wall that is drawn.
std::string blocked_by(const app::CycleState& state) {
  std::string text = state.ahead.turn_free ? "" : ", no turn";
  if (state.ahead.held) text += ", held";
  if (state.ahead.check.blocked())
    text += fmt::format(", {} at ({:.2f}, {:.2f}), {:.2f} m before it",
                        state.ahead.check.by_wall ? "wall" : "body", state.ahead.check.where.x_m,
                        state.ahead.check.where.y_m, state.ahead.check.free_m);
  return text + fmt::format(", margins {:.1f}", state.block.squeeze.share);
}

}  // namespace

BuildingDrive::BuildingDrive(const BuildingStart& start, const DriveOptions& options)
    : options_(options),
      site_(site_of(start, folder_.path() / "site", options.hand_made)),
      random_(options.seed, fnv1a(start.name), 0) {
  figures_.name = start.name;
  figures_.source = options.source + "/" + options.sensor;
  const auto setup = simulation::load_setup(folder_.path() / "site", folder_.path() / "site/start.yaml");
  run_ = std::make_unique<test::LockStepRun>(site_, setup, [&](const simulation::Factory& factory) {
    return make_pose_source(options.source, options.sensor, site_, factory);
  });
  watch_ = std::make_unique<DriveWatch>(*run_->factory, figures_, trace_file(options, start.name));
  operator_ = std::make_unique<BuildingOperator>(*run_, figures_, random_);
  run_->run->set_tap(
      [this](const auto& /*in*/, const auto& out, const auto& state) { watch_->observe(out, state); });
  for (const auto& wall : site_.walls) drawn_.push_back(wall.segment);
}

DriveFigures BuildingDrive::drive() {
  const double cpu_before_s = cpu_seconds();
  drive_laps();
  figures_.simulated_s = run_->time_s();
  figures_.cpu_s = cpu_seconds() - cpu_before_s;
  figures_.driven_m = run_->factory->distance_driven_m();
  return std::move(figures_);
}

void BuildingDrive::drive_laps() {
  constexpr int kFailuresInARow = 3;  // then nothing more will come of it
  int last = -1, failed = 0;
  for (int lap = 0; lap < options_.laps; ++lap) {
    if (lap == 1) watch_->lap_is_over();
    for (const int station : stations_in_turn(last)) {
      last = station;
      ++figures_.asked;
      if (figures_.gave_up) continue;
      failed = deliver(station, lap) ? 0 : failed + 1;
      if (operator_->gives_up() || failed == kFailuresInARow) figures_.gave_up = true;
    }
  }
}

/// Every station once, in an order drawn anew, `last` not first.
std::vector<int> BuildingDrive::stations_in_turn(int last) {
  const auto& routes = site_.config.routes;
  std::vector<int> stations;
  for (const std::size_t node : routes.stations()) stations.push_back(routes.nodes()[node].id);
  for (std::size_t i = stations.size(); i > 1; --i) std::swap(stations[i - 1], stations[random_.below(i)]);
  if (stations.front() == last) std::swap(stations.front(), stations.back());
  return stations;
}

bool BuildingDrive::tick() {
  run_->tick();
  operator_->look();
  return !operator_->gives_up();
}

bool BuildingDrive::deliver(int station, int lap) {
  constexpr int kLookEvery = 10;
  auto& orders = *run_->orders;
  const auto order = orders.add({{station, app::StopAction::Load, 1.0}}, 1, run_->factory->now());
  const double began_s = run_->time_s();
  for (int step = 1; run_->time_s() - began_s < options_.limit_s; ++step) {
    if (!tick()) return note_undelivered(station, order, "given up"), false;
    if (step % kLookEvery != 0) continue;
    const auto found = orders.find(order);
    if (found->state == app::OrderState::Done)
      return note_visit(station, lap, run_->time_s() - began_s), true;
    if (found->state == app::OrderState::Refused || found->state == app::OrderState::Cancelled)
      return note_undelivered(station, order, found->note), false;
  }
  return note_undelivered(station, order, "not within the time"), false;
}

void BuildingDrive::note_visit(int station, int lap, double after_s) {
  const auto& routes = site_.config.routes;
  const Point2<Map> drawn_at = routes.nodes()[*routes.index_of(station)].position;
  const auto& walls = run_->factory->world().walls();
  const auto truth = run_->factory->truth();
  const auto building_from_map = truth.building_from_base * truth.map_from_base.inverse();
  const double turn = building_from_map.yaw_rad();
  const auto drawn = clearances(drawn_, drawn_at);
  StationVisit visit{.station = station, .lap = lap, .after_s = after_s};
  visit.from_drawn_m = distance_m(truth.map_from_base.translation(), drawn_at);
  visit.drawn = drawn;
  visit.at = truth.building_from_base.translation();
  visit.in_truth = clearances(walls, visit.at, turn);
  visit.fit = compare(drawn, visit.in_truth);
  visit.possible = can_hold(drawn, walls, building_from_map * drawn_at, turn);
  figures_.visits.push_back(visit);
}

void BuildingDrive::note_undelivered(int station, std::int64_t order, const std::string& why) {
  const auto& state = run_->state();
  const auto truth = run_->factory->truth().map_from_base;
  const auto& pose = state.pose.map_from_base;
  figures_.undelivered.push_back(fmt::format(
      "to {}: {}; {}: {}{}; at ({:.2f}, {:.2f}), believes ({:.2f}, {:.2f}) {}: {}", station, why,
      to_string(state.mode), state.standstill.cause.text, blocked_by(state), truth.x_m(), truth.y_m(),
      pose.x_m(), pose.y_m(), to_string(state.pose.health.state), state.pose.health.reason));
  run_->orders->close(order, app::OrderState::Cancelled, "bench: not delivered", run_->factory->now());
}

}  // namespace madori::bench
