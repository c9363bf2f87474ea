#include "tests/end_to_end/soak/working_day.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/learned/kept_memory.hpp"
#include "app/learned/living_map_file.hpp"
#include "app/pose/localizer_pose.hpp"
#include "mapping/wall_map/wall_files.hpp"
#include "planning/route_graph/route_csv.hpp"
#include "tests/support/factory_link.hpp"

namespace madori::soak {
namespace {

constexpr Duration kStep = std::chrono::milliseconds(20);
constexpr double kConfirmsAfterS = 3.0;     ///< an operator comes to a vehicle that asks for one
constexpr double kLooksAfterS = 30.0;       ///< to a vehicle that cannot see what stands before it
constexpr double kTakesAwayAfterS = 120.0;  ///< to a vehicle that stands before something
constexpr double kCarriesAfterS = 120.0;    ///< to a vehicle that does not know where it is

app::SiteForDriving load(const DayOptions& options) {
  auto loaded = app::load_for_driving(options.site);
  if (!options.routes.empty()) app::take_routes(planning::load_routes(options.routes), loaded.config);
  return loaded;
}

simulation::FactorySetup setup_of(const DayOptions& options, const Wishes& wishes, const Day& day,
                                  const planning::RouteGraph& routes) {
  auto setup = simulation::load_setup(options.site, options.scenario);
  setup.seed = setup.scenario.seed = wishes.seed * 100'000ULL + static_cast<std::uint64_t>(day.number);
  setup.scenario.furniture.day = day.number;
  setup.epoch += std::chrono::hours(24) * day.number;
  const auto& node = routes.nodes()[*routes.index_of(day.first_station)];
  const Transform2<Map, Base> start(node.position.x_m, node.position.y_m, node.heading_rad.value_or(0.0));
  setup.scenario.start = setup.scenario.map_from_plan.inverse() * start;
  return setup;
}

}  // namespace

WorkingDay::WorkingDay(const DayOptions& options, const Wishes& wishes, int number)
    : options_(options),
      wishes_(wishes),
      loaded_(load(options)),
      plan_(plan_day(number, wishes, loaded_.config.routes)),
      chance_(chance_of(wishes, number, 0)) {
  figures_.day = number;
  const auto setup = setup_of(options, wishes, plan_, loaded_.config.routes);
  factory_ = std::make_shared<simulation::Factory>(setup);
  app::TransportOptions transport;
  transport.site = options.database;
  transport.lock_step = true;
  transport.store_poll_s = 0.5;
  app::LocalizerPoseOptions pose;
  if (!options.living_map.empty()) watch_map(pose);
  if (!options.memory.empty()) pose.memory = app::load_memory(options.memory, loaded_.walls).memory;
  run_ = std::make_unique<app::TransportRun>(
      loaded_.config, std::make_unique<app::LocalizerPose>(loaded_.walls, loaded_.config.lidars, pose),
      std::make_unique<test::FactoryLink>(factory_, loaded_.config.odometry.wheels, kStep), transport);
  orders_ = std::make_unique<app::OrderStore>(options.database / "madori.db");
  surprises_ = std::make_unique<Surprises>(*factory_, setup.scenario, run_->config());
  witness_ = std::make_unique<Witness>(*factory_, figures_, options.verbose, options.trace_s);
  run_->set_tap(
      [this](const auto& in, const auto& out, const auto& state) { witness_->observe(in, out, state); });
  if (plan_.closed_aisle) surprises_->close_aisle(*plan_.closed_aisle);
}

/// In lock-step, so that the same day gives the same map.
void WorkingDay::watch_map(app::LocalizerPoseOptions& options) {
  localization::HybridMap map = app::begin_living_map(options_.living_map, loaded_.walls).map;
  map.draw(loaded_.walls, mapping::load_other_lines(options_.site));
  map_learner_ = std::make_unique<localization::MapLearner>(std::move(map));
  map_truth_ = std::make_unique<MapTruth>(*factory_);
  options.sweep_onlooker = [this](const auto& sweep, const auto& lidar, const auto& pose) {
    map_truth_->look();
    if (!map_learner_->is_due(pose)) return;
    const double before = cpu_seconds();
    map_learner_->look(localization::beams_of(sweep, lidar), pose);
    map_cpu_s_ += cpu_seconds() - before;
  };
}

void WorkingDay::end_map() {
  figures_.living_map = map_truth_->compare(map_learner_->map());
  figures_.living_map["looks"] = map_learner_->looks();
  figures_.living_map["ms_a_look"] =
      1e3 * map_cpu_s_ / std::max(1.0, static_cast<double>(map_learner_->looks()));
  app::save_living_map(options_.living_map, map_learner_->map(), loaded_.walls);
  figures_.living_map["file_bytes"] = std::filesystem::file_size(options_.living_map / app::kLivingMapFile);
}

Figures WorkingDay::work(const std::atomic<bool>& stop) {
  const auto before = std::chrono::steady_clock::now();
  const double cpu_before = cpu_seconds();
  const Stamp morning = factory_->now();
  run_->say({app::OperatorWord::Resume, {}, {}});  // every start of the program waits for it
  for (const Delivery& delivery : plan_.deliveries)
    if (!stop) deliver(delivery);
  if (map_learner_) end_map();
  if (const auto parts = run_->state().localization->remembered(); parts && !options_.memory.empty())
    app::save_memory(options_.memory, parts->together(), loaded_.walls);
  figures_.driven_m = factory_->distance_driven_m();
  figures_.simulated_s = to_seconds(factory_->now() - morning);
  figures_.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  figures_.cpu_s = cpu_seconds() - cpu_before;
  figures_.memory_kib = resident_kib();
  for (const auto& entry : std::filesystem::directory_iterator(options_.database))
    figures_.database_bytes += static_cast<long>(entry.file_size());
  return figures_;
}

void WorkingDay::deliver(const Delivery& delivery) {
  ++figures_.asked;
  carried_ = false;
  chance_ = chance_of(wishes_, plan_.number, wishes_.deliveries + 1 + delivery.number);
  if (delivery.kidnapping && delivery.kidnapping->while_idle) {
    surprises_->carry_away(chance_);
    witness_->kidnapped();
    carried_ = true;
    wait(delivery.kidnapping->after_s);
  }
  kidnapping_due_ = delivery.kidnapping && !delivery.kidnapping->while_idle;
  pallet_due_ = delivery.pallet_on_way;
  person_due_ = delivery.person_crosses;
  const std::size_t helped = figures_.help.size();
  const int delivered = figures_.delivered;
  if (delivery.dropout) {
    factory_->inject(delivery.dropout->fault);
    ++figures_.dropouts;
  }
  const auto order = orders_->add({{delivery.station, app::StopAction::Load, 1.0}}, 1, factory_->now());
  const Stamp began = factory_->now();
  while (!follow(delivery, order, began)) {
  }
  if (delivery.dropout && figures_.help.size() == helped && figures_.delivered > delivered)
    ++figures_.dropouts_survived;
  surprises_->clear();
}

bool WorkingDay::follow(const Delivery& delivery, std::int64_t order, Stamp began) {
  tick();
  befall(delivery, began);
  look_after(delivery);
  if (ticks_ % 10 != 0) return false;
  const auto state = orders_->find(order);
  if (state->state == app::OrderState::Done) return note_delivered(delivery, began), true;
  if (state->state == app::OrderState::Refused || state->state == app::OrderState::Cancelled)
    return note_undelivered(delivery, order, state->note), true;
  if (to_seconds(factory_->now() - began) < options_.limit_s) return false;
  return note_undelivered(delivery, order, "not within the time"), true;
}

/// What the plan has in store, once the vehicle is on its way.
void WorkingDay::befall(const Delivery& delivery, Stamp began) {
  const auto& state = run_->state();
  const double since_s = to_seconds(factory_->now() - began);
  if (kidnapping_due_ && since_s > delivery.kidnapping->after_s && state.mode == app::Mode::Driving) {
    kidnapping_due_ = false;
    surprises_->carry_away(chance_);
    witness_->kidnapped();
    carried_ = true;
  }
  if (!app::drives(state.mode) || ticks_ % 50 != 0) return;
  if (pallet_due_ && surprises_->put_pallet(state, chance_)) pallet_due_ = false, ++figures_.pallets;
  if (person_due_ && surprises_->send_person(state, chance_)) person_due_ = false, ++figures_.persons;
}

/// The operator: confirms what only a person may confirm, and takes away what blocks every way.
void WorkingDay::look_after(const Delivery& delivery) {
  if (by_hand_) return drive_back(delivery);
  const auto& state = run_->state();
  pressed_ = state.mode == app::Mode::EmergencyStop && (pressed_ || state.drive.bumper);
  const std::string because = std::string(to_string(state.mode)) + ": " + state.standstill.cause.text;
  // While it localizes the reasons change from scan to scan; it is one standstill nevertheless.
  const std::string one_standstill = state.mode == app::Mode::Localizing ? to_string(state.mode) : because;
  if (app::drives(state.mode)) told_place_ = false;
  if (one_standstill != stands_because_ || app::drives(state.mode)) {
    stands_because_ = one_standstill;
    stands_since_ = factory_->now();
    return;
  }
  const double stood_s = to_seconds(factory_->now() - stands_since_);
  const bool asks = state.mode == app::Mode::EmergencyStop || state.mode == app::Mode::Fault;
  if (state.mode == app::Mode::Paused && stood_s > 1.0) {
    run_->say({app::OperatorWord::Resume, {}, {}});
    if (state.elsewhere && !carried_) help(delivery, because, false);
    stands_since_ = factory_->now();
  } else if (asks && stood_s > kConfirmsAfterS) {
    if (pressed_) surprises_->carry_away(chance_, true);  // "free the vehicle, then confirm"
    run_->say({app::OperatorWord::Confirm, {}, {}});
    help(delivery, because, false);
  } else if (state.mode == app::Mode::Waiting && state.block.height_unseen && stood_s > kLooksAfterS) {
    run_->say({app::OperatorWord::GoOn, {}, {}});  // a planar lidar's vehicle asks before every door
    stands_since_ = factory_->now();
  } else if (state.mode == app::Mode::Waiting && stood_s > kLooksAfterS &&
             state.standstill.cause == app::notice(app::Cause::ProtectiveField)) {
    free_field(delivery, because);
  } else if (state.mode == app::Mode::Waiting && (state.block.unseen || state.block.felt) &&
             stood_s > kLooksAfterS) {
    // "look, clear the way, then press Resume": who cannot clear it does not press.
    const auto where =
        state.block.felt ? factory_->truth().map_from_base.translation() : state.ahead.check.where;
    surprises_->take_away_near(where);
    if (surprises_->stands_at(state.ahead.check.where)) return;
    run_->say({app::OperatorWord::Resume, {}, {}});
    help(delivery, because, false);
  } else if (state.mode == app::Mode::Waiting && stood_s > kLooksAfterS &&
             state.standstill.cause.code == app::entry(app::Cause::StopUnsure).code) {
    look_at_stop(delivery);
    help(delivery, because, false);
  } else if (state.mode == app::Mode::Waiting && stood_s > kTakesAwayAfterS) {
    const auto goal = loaded_.config.routes.index_of(delivery.station);
    const bool blocked = !surprises_->another_way(*goal);
    if (surprises_->take_away_near(state.ahead.check.where)) help(delivery, because, blocked);
    stands_since_ = factory_->now();
  } else if (state.mode == app::Mode::Localizing && stood_s > kCarriesAfterS) {
    // Says on the map where the vehicle is; moves it where that does not help.
    if (std::exchange(told_place_, !told_place_))
      surprises_->carry_away(chance_, true);
    else
      tell_place();
    help(delivery, because, false);
  }
}

void WorkingDay::free_field(const Delivery& delivery, const std::string& because) {
  constexpr double kInFieldM = 0.4;
  const auto truth = factory_->truth().map_from_base;
  const double front_m = run_->config().check.vehicle.front_m;
  help(delivery, because, false);
  if (surprises_->take_away_near(truth * Point2<Base>{front_m + kInFieldM, 0.0})) return;
  run_->say({app::OperatorWord::ManualOn, {}, {}});
  by_hand_ = {factory_->now(), truth};
}

/// Straight back, as long as a person who stands beside it sees room behind it.
void WorkingDay::drive_back(const Delivery& delivery) {
  constexpr double kFarM = 0.6, kLongS = 10.0, kRoomM = 0.06, kNothingM = 0.1;
  const auto truth = factory_->truth().map_from_base;
  const double gone_m = distance_m(truth.translation(), by_hand_->second.translation());
  const bool over = to_seconds(factory_->now() - by_hand_->first) > kLongS;
  if (gone_m < kFarM && !over && (gone_m < kNothingM || clearance_m(*factory_) > kRoomM))
    return run_->say({app::OperatorWord::Jog, {-run_->config().out_of_field_mps, 0.0}, {}});
  by_hand_.reset();
  run_->say({app::OperatorWord::ManualOff, {}, {}});
  if (gone_m >= kNothingM) return;
  surprises_->carry_away(chance_, true);  // wedged: pushed to where it can turn
  help(delivery, "it did not get out of the field by hand", false);
}

/// "Look whether it is": it is the station, or the person shows where the vehicle stands.
void WorkingDay::look_at_stop(const Delivery& delivery) {
  constexpr double kAtStationM = 0.5;
  const auto& routes = loaded_.config.routes;
  const auto& station = routes.nodes()[*routes.index_of(delivery.station)].position;
  if (distance_m(factory_->truth().map_from_base.translation(), station) < kAtStationM)
    return run_->say({app::OperatorWord::GoOn, {}, {}});
  tell_place();
}

/// As a person taps it: not exactly.
void WorkingDay::tell_place() {
  constexpr double kTapM = 0.3, kTapRad = 0.1;
  const auto truth = factory_->truth().map_from_base;
  const Transform2<Map, Base> tapped(truth.x_m() + chance_.uniform(-kTapM, kTapM),
                                     truth.y_m() + chance_.uniform(-kTapM, kTapM),
                                     truth.yaw_rad() + chance_.uniform(-kTapRad, kTapRad));
  run_->say({app::OperatorWord::SetPose, {}, {tapped.translation(), tapped.yaw_rad(), {kTapM, kTapRad}}});
}

void WorkingDay::help(const Delivery& delivery, const std::string& reason, bool every_way_blocked) {
  figures_.help.push_back({delivery.number, reason, every_way_blocked});
  stands_since_ = factory_->now();
  const auto truth = factory_->truth().map_from_base;
  std::printf("help, day %d delivery %d: %s%s; at (%.2f, %.2f)\n", plan_.number, delivery.number,
              reason.c_str(), every_way_blocked ? " (every way blocked)" : "", truth.x_m(), truth.y_m());
}

void WorkingDay::tick() {
  ++ticks_;
  run_->tick(factory_->now() + kStep);
}

void WorkingDay::wait(double seconds) {
  for (const Stamp end = factory_->now() + duration_from_seconds(seconds); factory_->now() < end;) tick();
}

void WorkingDay::note_delivered(const Delivery& delivery, Stamp began) {
  ++figures_.delivered;
  const auto& routes = loaded_.config.routes;
  const auto& goal = routes.nodes()[*routes.index_of(delivery.station)];
  const auto truth = factory_->truth().map_from_base;
  const double off_m = distance_m(truth.translation(), goal.position);
  figures_.goal_error.add(off_m);
  figures_.delivery_s.push_back(to_seconds(factory_->now() - began));
  if (goal.heading_rad)
    figures_.goal_error_deg.push_back(to_deg(std::abs(wrap_angle(truth.yaw_rad() - *goal.heading_rad))));
  // A delivery is one only where the goods stand at the station.
  if (off_m > 0.5) {
    --figures_.delivered;
    figures_.undelivered.push_back("delivery " + std::to_string(delivery.number) + ": reported done " +
                                   std::to_string(off_m) + " m away");
    std::printf("%s\n", figures_.undelivered.back().c_str());
  }
  if (options_.verbose)
    std::printf("day %d delivery %d to %d in %.1f s, %.3f m\n", plan_.number, delivery.number,
                delivery.station, figures_.delivery_s.back(), off_m);
}

void WorkingDay::note_undelivered(const Delivery& delivery, std::int64_t order, const std::string& why) {
  const auto truth = factory_->truth().map_from_base;
  const auto& state = run_->state();
  const auto& check = state.ahead.check;
  const char* by = !check.blocked()       ? "nothing"
                   : check.by_wall        ? "wall"
                   : state.block.by_mover ? "mover"
                                          : "body";
  char text[500];
  std::snprintf(
      text, sizeof text,
      "delivery %d to node %d: %s; %s: %s; at (%.2f, %.2f, %.0f deg); %s; blocked by %s at (%.2f, %.2f)%s%s",
      delivery.number, delivery.station, why.c_str(), to_string(state.mode),
      state.standstill.cause.text.c_str(), truth.x_m(), truth.y_m(), to_deg(truth.yaw_rad()),
      state.pose.health.reason.c_str(), by, check.where.x_m, check.where.y_m,
      state.ahead.turn_free ? "" : ", no room to turn", state.detour.pending ? ", detour pending" : "");
  figures_.undelivered.emplace_back(text);
  std::printf("NOT delivered, day %d, %s\n", plan_.number, text);
  orders_->close(order, app::OrderState::Cancelled, "soak: not delivered", factory_->now());
}

}  // namespace madori::soak
