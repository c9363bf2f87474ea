// Test bodies on the way and persons across it, in the virtual factory: real VLP-16 bytes, real localization,
// the whole cycle, lock-step. The vehicle may stand when touched, never move. Exit 1 where it moved, or where
// a body did not stop it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

#include "app/cycle/stages.hpp"
#include "app/json_output.hpp"
#include "tests/support/lock_step_run.hpp"

namespace madori {
namespace {

using simulation::MoverKind;

constexpr double kStanding_mps = 0.01;

struct Arguments {
  std::string site;
  std::string scenario;
  int placements = 200;
  int carts = 0;
  std::vector<double> speeds{0.4, 0.7, 1.0};
  std::vector<std::string> kinds{"upright body", "lying body", "crossing person"};
  unsigned seed = 1;
  std::string json_file;
  bool verbose = false;
};

/// Whether the vehicle was in motion at the touch: driving, or turning on the spot.
bool moved(const simulation::Collision& c) {
  return c.speed_mps >= kStanding_mps || c.turn_radps >= kStanding_mps;
}

/// What became of one kind of thing in the way.
struct Tally {
  int met = 0;
  int stopped = 0;
  int contacts = 0;
  double nearest_m = 10.0;  ///< while the vehicle moved
  double fastest_mps = 0.0;
};

/// How the vehicle got past carts that stood on its way.
struct CartTally {
  int met = 0;
  int around = 0;       ///< by a detour
  int other_route = 0;  ///< or without one: the rest of the route, or another one, left the cart aside
  int waited = 0;       ///< until it was taken away
  int contacts = 0;
};

/// The plan of one encounter.
struct Placement {
  simulation::MoverSpec mover;
  Point2<Map> at;
  double vehicle_along_m = 0.0;
};

class Encounters {
 public:
  Encounters(const Arguments& arguments, double speed_mps, bool detours)
      : arguments_(arguments), speed_mps_(speed_mps), site_(app::load_for_driving(arguments.site)) {
    random_.seed(arguments.seed + static_cast<unsigned>(speed_mps * 1000.0));
    auto& c = site_.config;
    c.pursuit.speed.max_speed_mps = c.limits.max_speed_mps = speed_mps;
    c.limits.max_wheel_speed_mps = speed_mps + 0.3;
    c.movers.top_speed_mps = speed_mps;
    if (!detours) c.detour_after_s = c.reroute_after_s = 1e6;  // it is stopping that is looked at
    auto setup = simulation::load_setup(arguments.site, arguments.scenario);
    setup.scenario.movers.clear();
    setup.seed = arguments.seed;
    run_ = std::make_unique<test::LockStepRun>(site_, setup);
  }

  void meet(MoverKind kind, int count, Tally& tally) {
    for (int met = 0; met < count;) {
      go_on();
      const auto placement = kind == MoverKind::Person ? crossing() : standing(kind);
      if (!placement) {
        run_->tick();
        continue;
      }
      encounter(*placement, tally);
      ++met;
    }
  }

  /// Carts that were left standing on the way: driven around where there is room.
  void pass_carts(int count, CartTally& tally) {
    while (tally.met < count) {
      go_on();
      const auto placement = standing(MoverKind::Cart);
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
            return run_->run->orders().find(*order)->state == app::OrderState::Done;
          },
          150.0);
      ++tally.met;
      ++(!past ? tally.waited : around ? tally.around : tally.other_route);
      for (std::size_t i = touched; i < run_->factory->collisions().size(); ++i)
        tally.contacts += moved(run_->factory->collisions()[i]);
      if (arguments_.verbose || !past)
        std::printf("%8.2f s cart at (%.2f, %.2f): %s; %s\n", run_->time_s(), placement->at.x_m,
                    placement->at.y_m,
                    !past    ? "waited"
                    : around ? "around"
                             : "past",
                    run_->state().standstill.remedy.text.c_str());
      clear();
    }
  }

 private:
  /// Drives until the vehicle is on its way at speed.
  void go_on() {
    run_->run_until(
        [&] {
          if (!order_ || run_->run->orders().find(*order_)->state != app::OrderState::Running)
            if (run_->run->orders().list(true).empty()) order_ = run_->order_somewhere(random_);
          return run_->state().mode == app::Mode::Driving &&
                 run_->factory->truth().linear_mps > 0.5 * speed_mps_;
        },
        120.0);
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  [[nodiscard]] bool is_free(const Point2<Map>& at, double radius_m) const {
    const auto centre = run_->factory->world().frames().building_pose({at.x_m, at.y_m, 0.0}).translation();
    return run_->factory->world().obstacles().find(
               simulation::rectangle(centre, 0.0, 2.0 * radius_m, 2.0 * radius_m), {0.05, 1.7}) == nullptr;
  }
  [[nodiscard]] Point2<simulation::Plan> on_plan(const Point2<Map>& at) const {
    return run_->factory->world().frames().map_from_plan.inverse() * at;
  }

  /// A point of the way `ahead_m` further, with its heading; nothing where the way ends or a door is near.
  [[nodiscard]] std::optional<PathPoint> way_point(double ahead_m) const {
    const auto& way = run_->state().way;
    const double along_m = way.along_m + ahead_m;
    if (along_m > way.path.length_m()) return std::nullopt;
    std::size_t i = way.pursuit.index;
    while (i + 1 < way.path.points().size() && way.path.along_m(i) < along_m) ++i;
    if (app::is_at_door(run_->run->config(), way.path.points()[i].position)) return std::nullopt;
    return way.path.points()[i];
  }

  /// A body on the way, a little aside of it, beyond the lidar's blind zone.
  std::optional<Placement> standing(MoverKind kind) {
    constexpr double kInView_m = 4.6;
    const auto point = way_point(uniform(4.0, 9.0));
    if (!point) return std::nullopt;
    const double aside_m = uniform(-0.3, 0.3);
    const double across = point->heading_rad + kPi / 2.0;
    const Point2<Map> at{point->position.x_m + aside_m * std::cos(across),
                         point->position.y_m + aside_m * std::sin(across)};
    const double half_m = kind == MoverKind::Cart ? 0.65 : 0.35;
    const Point2<Map> beside{at.x_m + 0.1 * std::cos(across), at.y_m + 0.1 * std::sin(across)};
    const auto here = run_->factory->truth().map_from_base.translation();
    if (distance_m(here, at) < kInView_m || !is_free(at, half_m)) return std::nullopt;
    simulation::MoverSpec mover;
    mover.kind = kind;
    mover.name = kind == MoverKind::Cart ? "cart" : "test body";
    mover.path = {on_plan(at), on_plan(beside)};  // two points give it its direction
    mover.start_s = 1e9;
    return Placement{mover, at, run_->state().way.along_m};
  }

  /// A person who comes at the way from one side, about when the vehicle does.
  std::optional<Placement> crossing() {
    constexpr double kFurthest_m = 6.0;
    constexpr double kStep_m = 0.25;
    const double ahead_m = uniform(2.5, 7.0);
    const auto point = way_point(ahead_m);
    if (!point) return std::nullopt;
    simulation::MoverSpec mover;
    mover.name = "person";
    mover.speed_mps = uniform(0.6, 1.6);
    mover.polite_m = 0.0;
    mover.pause_s = 1e9;
    const double side = random_() % 2 == 0 ? 1.0 : -1.0;
    const double direction = point->heading_rad + side * uniform(kPi / 3.0, 2.0 * kPi / 3.0);
    const double wanted_m =
        std::min(kFurthest_m, std::max(1.5, mover.speed_mps * (ahead_m / speed_mps_ + uniform(-1.0, 1.0))));
    const auto along = [&](double way_m) {
      return Point2<Map>{point->position.x_m - way_m * std::cos(direction),
                         point->position.y_m - way_m * std::sin(direction)};
    };
    double before_m = 0.0, after_m = 0.0;
    while (before_m < wanted_m && is_free(along(before_m + kStep_m), 0.25)) before_m += kStep_m;
    while (after_m < 3.0 && is_free(along(-after_m - kStep_m), 0.25)) after_m += kStep_m;
    const auto here = run_->factory->truth().map_from_base.translation();
    if (before_m < 1.5 || after_m < 1.0 || distance_m(here, along(before_m)) < 2.0) return std::nullopt;
    mover.path = {on_plan(along(before_m)), on_plan(along(-after_m))};
    mover.start_s = run_->time_s();
    return Placement{mover, point->position, run_->state().way.along_m};
  }

  void encounter(const Placement& placement, Tally& tally) {
    auto& factory = *run_->factory;
    const std::size_t touched = factory.collisions().size();
    double nearest_m = 10.0, fastest_mps = 0.0, stood_s = 0.0;
    bool stopped = false;
    factory.add_mover(placement.mover);
    run_->run_until(
        [&] {
          const auto truth = factory.truth();
          const auto outline = simulation::outline(factory.bodies().front());
          const double away_m =
              test::distance_between(factory.vehicle().footprint(truth.building_from_base), outline);
          const bool moves = std::abs(truth.linear_mps) > kStanding_mps;
          fastest_mps = std::max(fastest_mps, std::abs(truth.linear_mps));
          if (moves || std::abs(truth.angular_radps) > kStanding_mps) nearest_m = std::min(nearest_m, away_m);
          stood_s = run_->stands() ? stood_s + 0.02 : 0.0;
          stopped = stopped || (run_->stands() && run_->state().mode == app::Mode::Waiting);
          const bool done = placement.mover.kind != MoverKind::Person && stopped && stood_s > 1.0;
          return done || factory.collisions().size() > touched;
        },
        placement.mover.kind == MoverKind::Person ? 9.0 : 45.0);
    bool contact = false;
    for (std::size_t i = touched; i < factory.collisions().size(); ++i)
      contact = contact || moved(factory.collisions()[i]);
    ++tally.met;
    tally.stopped += stopped;
    tally.contacts += contact;
    tally.nearest_m = std::min(tally.nearest_m, nearest_m);
    tally.fastest_mps = std::max(tally.fastest_mps, fastest_mps);
    if (contact || (!stopped && placement.mover.kind != MoverKind::Person) || arguments_.verbose)
      report(placement, stopped, contact, nearest_m);
    clear();
  }

  void report(const Placement& placement, bool stopped, bool contact, double nearest_m) const {
    const auto truth = run_->factory->truth().map_from_base;
    std::printf(
        "%8.2f s %s at (%.2f, %.2f), %.2f m/s: %s%s, nearest %.3f m; vehicle (%.2f, %.2f, %.0f deg)\n",
        run_->time_s(), placement.mover.name.c_str(), placement.at.x_m, placement.at.y_m,
        placement.mover.kind == MoverKind::Person ? placement.mover.speed_mps : 0.0,
        stopped ? "stopped" : "NOT STOPPED", contact ? ", CONTACT" : "", nearest_m, truth.x_m(), truth.y_m(),
        to_deg(truth.yaw_rad()));
  }

  /// Takes the body away, and plays the operator who has looked.
  void clear() {
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

  const Arguments& arguments_;
  double speed_mps_;
  app::SiteForDriving site_;
  std::mt19937 random_;
  std::unique_ptr<test::LockStepRun> run_;
  std::optional<std::int64_t> order_;
};

int run(const Arguments& arguments) {
  const std::map<std::string, MoverKind> kinds{{"upright body", MoverKind::UprightBody},
                                               {"lying body", MoverKind::LyingBody},
                                               {"crossing person", MoverKind::Person}};
  std::map<std::string, Tally> tallies;
  const int parts = static_cast<int>(arguments.speeds.size());
  for (int part = 0; part < parts; ++part) {
    Encounters encounters(arguments, arguments.speeds[static_cast<std::size_t>(part)], false);
    const int count = arguments.placements * (part + 1) / parts - arguments.placements * part / parts;
    for (const auto& name : arguments.kinds) encounters.meet(kinds.at(name), count, tallies[name]);
  }
  nlohmann::json figures;
  bool good = true;
  for (const auto& [name, t] : tallies) {
    std::printf(
        "%s: %d met at up to %.2f m/s, %d stopped the vehicle, %d touched it moving, nearest %.3f m\n",
        name.c_str(), t.met, t.fastest_mps, t.stopped, t.contacts, t.nearest_m);
    figures[name] = {{"met", t.met},
                     {"stopped", t.stopped},
                     {"contacts", t.contacts},
                     {"nearest_m", t.nearest_m},
                     {"fastest_mps", t.fastest_mps}};
    good = good && t.contacts == 0 && (kinds.at(name) == MoverKind::Person || t.stopped == t.met);
  }
  if (arguments.carts > 0) {
    CartTally t;
    Encounters(arguments, arguments.speeds.back(), true).pass_carts(arguments.carts, t);
    std::printf(
        "carts on the way: %d met, %d driven around, %d past by themselves, %d waited for, %d touched\n",
        t.met, t.around, t.other_route, t.waited, t.contacts);
    figures["cart"] = {{"met", t.met}, {"around", t.around}, {"waited", t.waited}, {"contacts", t.contacts}};
    good = good && t.contacts == 0;
  }
  app::write_json(arguments.json_file, figures);
  return good ? 0 : 1;
}

}  // namespace
}  // namespace madori

int main(int argc, char** argv) {
  CLI::App app("Test bodies on the way and persons across it, in the virtual factory, lock-step");
  madori::Arguments arguments;
  app.add_option("SITE", arguments.site, "site folder with routes")->required();
  app.add_option("SCENARIO", arguments.scenario, "scenario file; its movers stay at home")->required();
  app.add_option("--placements", arguments.placements, "of each kind")->capture_default_str();
  app.add_option("--carts", arguments.carts, "left standing on the way, at the last of the speeds");
  app.add_option("--speeds", arguments.speeds, "m/s: the vehicle's limit, in equal parts of the placements")
      ->delimiter(',');
  app.add_option("--kinds", arguments.kinds, "of what is in the way")
      ->delimiter(',')
      ->check(CLI::IsMember({"upright body", "lying body", "crossing person"}));
  app.add_option("--seed", arguments.seed, "of everything left to chance");
  app.add_option("--json", arguments.json_file, "the figures; - for stdout");
  app.add_flag("--verbose", arguments.verbose, "print every encounter");
  CLI11_PARSE(app, argc, argv);
  try {
    return madori::run(arguments);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "encounters: %s\n", e.what());
    return 1;
  }
}
