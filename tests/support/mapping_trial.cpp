#include "tests/support/mapping_trial.hpp"

#include <algorithm>
#include <chrono>
#include <random>

#include "app/map_comparison.hpp"
#include "core/segment_distance.hpp"

namespace madori::test {
namespace {

namespace fs = std::filesystem;
using Random = std::mt19937_64;
using Round = std::vector<Point2<Map>>;

const fs::path kRooms = fs::path(MADORI_SOURCE_DIR) / "data/two_rooms";
const fs::path kRoomsTruth = kRooms / "true_walls.csv";
constexpr double kOffM = 0.1;

double between(Random& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// Room of the plan in which the vehicle turns freely: 1.1 m from every wall.
struct Free {
  double x0, x1, y0, y1;
};
constexpr Free kWest{1.1, 5.9, 1.1, 5.4}, kWestTop{2.6, 5.9, 5.4, 6.9}, kEast{8.3, 10.9, 1.1, 6.9};

Point2<Map> somewhere(Random& random, const Free& free) {
  return {between(random, free.x0, free.x1), between(random, free.y0, free.y1)};
}

/// Places in both rooms, the door passed along its middle: from the start in the west, to the east, and back.
Round random_round(Random& random) {
  const auto west = [&](Round& round, int count) {
    for (int i = 0; i < count; ++i)
      round.push_back(somewhere(random, between(random, 0.0, 1.0) < 0.25 ? kWestTop : kWest));
  };
  const auto several = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
  Round round;
  west(round, several(1, 3));
  const Point2<Map> before{between(random, 5.3, 6.0), 4.0}, behind{between(random, 8.3, 9.5), 4.0};
  round.push_back(before);
  round.push_back(behind);
  for (int i = several(2, 4); i > 0; --i) round.push_back(somewhere(random, kEast));
  round.push_back(behind);
  round.push_back(before);
  west(round, several(1, 3));
  return round;
}

Hand random_hand(Random& random) {
  Hand hand;
  hand.speed_mps = between(random, 0.2, 0.6);
  hand.turn_gain = between(random, 0.8, 2.0);
  hand.turn_radps = between(random, 0.4, 1.0);
  hand.turn_first_rad = between(random, 0.4, 0.8);
  hand.arrived_m = between(random, 0.15, 0.3);
  hand.rest_s = between(random, 0.0, 0.8);
  return hand;
}

simulation::FactorySetup rooms(const MappingTrial& trial, Random& random) {
  simulation::FactorySetup setup;
  setup.scenario = simulation::load_scenario(kRooms / "scenario.yaml");
  setup.scenario.vlp16.keep_every_firing = trial.keep_every_firing;
  setup.seed = setup.scenario.seed = trial.seed;
  setup.scenario.vehicle.left_radius_error_percent = between(random, -0.3, 0.3);
  setup.scenario.vehicle.right_radius_error_percent = between(random, -0.3, 0.3);
  setup.sensors = {trial.lidar};
  for (int i = 0; i < trial.persons; ++i) {
    simulation::MoverSpec person;
    person.name = "person " + std::to_string(i);
    const Free& room = i % 2 == 0 ? kWest : kEast;
    for (int k = 0; k < 4; ++k) {
      const auto at = somewhere(random, room);
      person.path.push_back({at.x_m, at.y_m});
    }
    person.loop = true;
    person.patience_s = 3.0;
    setup.scenario.movers.push_back(person);
  }
  return setup;
}

double off_m(const Point2<Map>& p, const mapping::Walls& truth) {
  double nearest_m = 1e9;
  for (const auto& wall : truth) nearest_m = std::min(nearest_m, distance_m(wall.segment, p));
  return nearest_m;
}

/// The stretches of the walls, laid on the building, that lie off all true ones.
std::vector<PhantomPiece> phantoms_of(const mapping::Walls& walls, const mapping::Walls& truth) {
  constexpr double kStepM = 0.05;
  std::vector<PhantomPiece> found;
  for (const auto& wall : walls) {
    const auto& [a, b] = wall.segment;
    const int steps = std::max(1, static_cast<int>(wall.segment.length_m() / kStepM));
    bool goes_on = false;
    for (int i = 0; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      const Point2<Map> p{a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)};
      const double off = off_m(p, truth);
      if (off > kOffM && !goes_on) found.push_back({{p, p}, off});
      goes_on = off > kOffM;
      if (!goes_on) continue;
      found.back().where.b = p;
      found.back().off_m = std::max(found.back().off_m, off);
    }
  }
  return found;
}

void score(const fs::path& site, MappingTrialResult& result) {
  const auto found = compared_with_rooms(site);
  result.map_to_building_m = found["map_to_building"]["mean_m"];
  result.building_to_map_m = found["building_to_map"]["mean_m"];
  const auto& at = found["building_from_map"];
  const Transform2<Map, Map> building_from_map(at["x_m"], at["y_m"], to_rad(at["yaw_deg"].get<double>()));
  mapping::Walls walls = mapping::load_walls(site / "walls.csv");
  result.walls = walls.size();
  for (auto& wall : walls) wall.segment = building_from_map * wall.segment;
  result.phantoms = phantoms_of(walls, mapping::load_walls(kRoomsTruth));
}

}  // namespace

nlohmann::json compared_with_rooms(const fs::path& site) {
  app::MapComparisonOptions options;
  options.alignment = app::MapAlignment::Anywhere;
  return app::compare_maps(app::occupied_places(site, options.cell_m),
                           app::occupied_places(kRoomsTruth, options.cell_m), options);
}

MappingTrialResult run_mapping_trial(const MappingTrial& trial) {
  Random random(trial.seed * 7919 + 29);
  const auto setup = rooms(trial, random);
  const auto round = random_round(random);
  HandDrive drive(setup, random_hand(random));
  drive.map();
  MappingTrialResult result;
  constexpr double kPatienceS = 40.0;  // somebody or a corner is in the way: back, another goal
  for (const auto& goal : round) {
    if (drive.drive_to(goal, kPatienceS)) continue;
    ++result.missed;
    drive.jog_for(2.0, {-0.3, 0.0});
  }
  const auto begun = std::chrono::steady_clock::now();
  (void)drive.finish();
  result.finish_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  const auto progress = drive.run().mapping()->progress();
  result.driven_m = progress.driven_m;
  result.keyframes = progress.keyframes;
  score(drive.site(), result);
  if (!trial.keep.empty()) {
    fs::create_directories(trial.keep);
    fs::copy(drive.site(), trial.keep, fs::copy_options::recursive | fs::copy_options::overwrite_existing);
  }
  return result;
}

}  // namespace madori::test
