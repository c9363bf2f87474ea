#include "localization/ndt_map/hybrid_map.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "localization/byte_stream.hpp"
#include "localization/ndt_map/hybrid_map_file.hpp"
#include "localization/ndt_map/map_registration.hpp"
#include "tests/support/made_up_buildings.hpp"

namespace madori::localization {
namespace {

/// A vehicle that stands in a bare room of 8 m x 6 m, and looks ten times a second.
class Room {
 public:
  Room() { test::add_box(walls_, 0.0, 0.0, 8.0, 6.0); }

  void look_for(double seconds, const mapping::Walls& things = {}) {
    mapping::Walls all = walls_;
    all.insert(all.end(), things.begin(), things.end());
    for (int i = 0; i < static_cast<int>(seconds * 10.0); ++i, now_s_ += 0.1) {
      const LaserScan scan = test::simulate_scan(all, kPose, settings_, engine_);
      map.look(beams_of(scan_points(scan, {}), {}, 0.5), kPose, stamp_from_seconds(now_s_));
    }
  }
  void next_day() { now_s_ += 86'400.0; }
  [[nodiscard]] const mapping::Walls& walls() const { return walls_; }

  HybridMap map;

 private:
  static inline const Transform2<Map, Base> kPose{2.0, 3.03, 0.2};
  mapping::Walls walls_;
  test::ScanSettings settings_ = [] {
    auto s = test::full_turn(720, 30.0);
    s.range_sigma_m = 0.015;
    return s;
  }();
  std::mt19937 engine_{5};
  double now_s_ = 1e6;
};

mapping::Walls box_at(double x_m, double y_m, double half_m = 0.4) {
  mapping::Walls box;
  test::add_box(box, x_m - half_m, y_m - half_m, x_m + half_m, y_m + half_m);
  return box;
}

constexpr Point2<Map> kBeforeTheWall{7.9, 3.1};
constexpr Point2<Map> kFaceOfTheBox{4.61, 3.1};  // of a box at (5, 3.03)
constexpr Point2<Map> kFloor{4.0, 3.1};

TEST(HybridMap, WhatIsDrawnIsStaticAtOnceAndTheRestOnTheSecondDayAfter) {
  Room drawn, undrawn;
  drawn.map.draw(drawn.walls());
  drawn.look_for(3.0);
  undrawn.look_for(3.0);
  EXPECT_EQ(drawn.map.state_at(kBeforeTheWall), CellState::Static);
  EXPECT_EQ(undrawn.map.state_at(kBeforeTheWall), CellState::SemiStatic);
  EXPECT_EQ(drawn.map.state_at(kFloor), CellState::Free);
  EXPECT_EQ(drawn.map.state_at({9.0, 3.0}), CellState::Unseen);
  undrawn.next_day();
  undrawn.look_for(3.0);
  EXPECT_EQ(undrawn.map.state_at(kBeforeTheWall), CellState::SemiStatic);  // it may be back by chance
  undrawn.next_day();
  undrawn.look_for(3.0);
  EXPECT_EQ(undrawn.map.state_at(kBeforeTheWall), CellState::Static);
}

TEST(HybridMap, WhatStandsWhereALineIsDrawnIsStaticAsSoonAsItStands) {
  Room room;
  const mapping::Walls machine = box_at(5.0, 3.03);
  mapping::Walls lines = machine;
  test::add_wall(lines, 2.9, 4.9, 3.3, 4.9);  // as short as a letter
  room.map.draw(room.walls(), lines);
  room.look_for(0.3, machine);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Moving);  // who walks over a line is no machine
  mapping::Walls things = machine;
  const mapping::Walls letter = box_at(3.1, 5.0, 0.1), pallet = box_at(5.0, 1.0);
  things.insert(things.end(), letter.begin(), letter.end());
  things.insert(things.end(), pallet.begin(), pallet.end());
  room.look_for(20.0, things);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Static);
  EXPECT_EQ(room.map.state_at({4.61, 1.1}), CellState::SemiStatic);
  EXPECT_EQ(room.map.state_at({3.1, 4.9}), CellState::SemiStatic);
  EXPECT_EQ(room.map.state_at({0.1, 3.1}), CellState::Static);
  EXPECT_EQ(room.map.state_at(kFloor), CellState::Free);
}

TEST(HybridMap, ASideOfWhatStandsBeforeAWallIsNoWall) {
  Room room;
  room.map.draw(room.walls());
  mapping::Walls cupboard;
  test::add_box(cupboard, 4.6, 0.02, 6.0, 0.9);
  room.look_for(20.0, cupboard);
  EXPECT_EQ(room.map.state_at({4.6 + 0.01, 0.6}), CellState::SemiStatic);
  EXPECT_EQ(room.map.state_at({4.6 + 0.01, 0.14}), CellState::SemiStatic);
  EXPECT_EQ(room.map.state_at({3.1, 0.1}), CellState::Static);
}

TEST(HybridMap, AThingThatIsPutDownMovesFirstAndStandsLater) {
  Room room;
  room.look_for(20.0);
  room.look_for(1.0, box_at(5.0, 3.03));
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Moving);
  room.look_for(60.0, box_at(5.0, 3.03));
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::SemiStatic);
  room.look_for(1.0);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::TakenAway);
  room.look_for(60.0);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Free);
}

TEST(HybridMap, WhoWalksThroughLeavesNothingBehind) {
  Room room;
  room.look_for(5.0);
  for (double x = 3.0; x < 7.0; x += 0.12) room.look_for(0.1, box_at(x, 3.03, 0.2));
  room.look_for(0.5);
  for (double x = 3.0; x < 7.0; x += 0.25) EXPECT_EQ(room.map.state_at({x, 3.1}), CellState::Free) << x;
}

TEST(HybridMap, WhoWalksOutOfSightIsForgotten) {
  Room room;
  room.look_for(10.0);
  room.look_for(0.3, box_at(5.0, 3.03));  // and then a wall before it
  mapping::Walls screen = box_at(5.0, 3.03);
  test::add_wall(screen, 3.5, 0.0, 3.5, 6.0);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Moving);
  room.look_for(60.0, screen);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Free);
}

TEST(HybridMap, WhatWasSeenToBeGoneDoesNotComeBackOutOfSight) {
  Room room;
  for (int day = 0; day < 2; ++day) {
    room.look_for(60.0, box_at(5.0, 3.03));
    room.next_day();
  }
  room.look_for(1.0);  // in passing
  mapping::Walls screen;
  test::add_wall(screen, 3.5, 0.0, 3.5, 6.0);
  room.look_for(120.0, screen);
  EXPECT_NE(room.map.state_at(kFaceOfTheBox), CellState::SemiStatic);
  EXPECT_NE(room.map.state_at(kFaceOfTheBox), CellState::Static);
}

TEST(HybridMap, WhatStoodOnTwoDaysIsNotKnownToStandOnAThirdOneUnseen) {
  Room room;
  mapping::Walls screen;
  test::add_wall(screen, 3.5, 0.0, 3.5, 6.0);
  for (int day = 0; day < 2; ++day) {
    room.look_for(60.0, box_at(5.0, 3.03));
    room.next_day();
  }
  room.look_for(3.0, screen);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Unseen);
  room.next_day();
  room.look_for(60.0, box_at(5.0, 3.03));
  room.next_day();
  room.look_for(3.0, screen);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Static);  // it was there on three days of three
}

TEST(HybridMap, AWallThatIsGoneIsMissedForDays) {
  Room room;
  const mapping::Walls screen{{7, {{4.6, 1.0}, {4.6, 5.0}}}};
  for (int day = 0; day < 4; ++day) {
    room.look_for(3.0, screen);
    room.next_day();
  }
  room.look_for(3.0);
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::TakenAway);
  EXPECT_EQ(room.map.state_at(kBeforeTheWall), CellState::SemiStatic);  // behind the screen until today
  for (int day = 0; day < 4; ++day) {
    room.next_day();
    room.look_for(3.0);
  }
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Free);
}

TEST(HybridMap, WhatWasPutDownOvernightStandsAtOnce) {
  Room room;
  room.look_for(40.0);
  room.next_day();
  room.look_for(2.5, box_at(5.0, 3.03));
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::SemiStatic);
}

/// Clutter that stands on every third day is never taken for a wall; a new wall is, after three days.
TEST(HybridMap, WhatComesAndGoesIsNotPermanent) {
  Room room;
  for (int day = 0; day < 9; ++day) {
    room.look_for(2.0, day % 3 == 0 ? box_at(5.0, 3.03) : mapping::Walls{});
    EXPECT_NE(room.map.state_at(kFaceOfTheBox), CellState::Static) << day;
    room.next_day();
  }
  for (int day = 0; day < 4; ++day) {
    room.look_for(2.0, box_at(5.0, 3.03));
    room.next_day();
  }
  EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::Static);
}

/// What stands close before a wall shares its cell; the wall is known again when it is gone.
TEST(HybridMap, WhatStandsCloseBeforeAWallIsNotTheWall) {
  const mapping::Walls boards{{7, {{7.86, 2.0}, {7.86, 4.0}}}};
  for (const bool is_drawn : {false, true}) {
    Room room;
    if (is_drawn) room.map.draw(room.walls());
    for (int day = 0; day < 4; ++day) {
      room.look_for(3.0);
      room.next_day();
    }
    EXPECT_EQ(room.map.state_at(kBeforeTheWall), CellState::Static);
    room.look_for(3.0, boards);
    EXPECT_EQ(room.map.state_at(kBeforeTheWall), CellState::SemiStatic) << is_drawn;
    room.next_day();
    room.look_for(3.0);
    EXPECT_EQ(room.map.state_at(kBeforeTheWall), CellState::Static) << is_drawn;
  }
}

/// Each day another pallet, all of them with a face in one cell.
TEST(HybridMap, OtherThingsInTheSameCellAreNotOneThatLasts) {
  Room room;
  for (int day = 0; day < 6; ++day) {
    room.look_for(3.0, box_at(4.95 + 0.09 * (day % 3), 3.03));
    EXPECT_EQ(room.map.state_at(kFaceOfTheBox), CellState::SemiStatic) << day;
    room.next_day();
  }
}

TEST(HybridMap, AManySightingsAtOnceAreOne) {
  Room room;
  room.look_for(30.0);
  const auto cell = room.map.cells().find(room.map.place_of(kBeforeTheWall));
  EXPECT_LT(room.map.cells()[cell].layers.permanent, 0.01F);
}

/// A pallet of 0.3 m is passed above by the upper lasers: they say nothing of it.
TEST(HybridMap, BeamsAboveAPalletDoNotTakeItAway) {
  HybridMap map;
  Beams beams{{}, 0.6, {}};
  for (int i = -20; i <= 20; ++i) {
    const auto side = 0.01F * static_cast<float>(i);
    beams.ends.push_back({4.1F, side, 0.22F});
    for (const float z : {0.5F, 0.8F, 1.2F, 1.6F}) beams.ends.push_back({8.1F, 2.0F * side, z});
  }
  for (int i = 0; i < 50; ++i) map.look(beams, {0.0, 0.1, 0.0}, stamp_from_seconds(100.0 + i));
  EXPECT_EQ(map.state_at({4.1, 0.1}), CellState::SemiStatic);
  EXPECT_EQ(map.state_at({3.0, 0.1}), CellState::Free);
  EXPECT_EQ(map.state_at({8.1, 0.1}), CellState::SemiStatic);
}

/// From afar the lasers that reach its place pass above it; near it the lower ones meet it.
TEST(HybridMap, WhatOnlyUpperBeamsPassedWasNotSeenToBeFree) {
  HybridMap map;
  Beams afar{{}, 0.6, {}}, near{{}, 0.6, {}};
  for (int i = -20; i <= 20; ++i) {
    const auto side = 0.01F * static_cast<float>(i);
    afar.ends.push_back({12.1F, 1.5F * side, 0.5F});
    near.ends.push_back({4.1F, side, 0.22F});
  }
  double now_s = 100.0;
  for (int i = 0; i < 30; ++i) map.look(afar, {0.0, 0.1, 0.0}, stamp_from_seconds(now_s += 1.0));
  EXPECT_EQ(map.state_at({8.1, 0.1}), CellState::Free);
  for (int i = 0; i < 4; ++i) map.look(near, {4.0, 0.1, 0.0}, stamp_from_seconds(now_s += 1.0));
  EXPECT_EQ(map.state_at({8.1, 0.1}), CellState::SemiStatic);
  EXPECT_EQ(map.state_at({6.0, 0.1}), CellState::Free);
}

TEST(HybridMap, IsReadBackAsItWasAndRefusedWhenDamaged) {
  Room room;
  room.look_for(2.0, box_at(5.0, 3.03));
  const std::string bytes = hybrid_map_bytes(room.map, 77);
  const auto back = parse_hybrid_map(bytes);
  ASSERT_TRUE(back.ok()) << back.reason();
  EXPECT_EQ(back.value().walls, 77U);
  EXPECT_EQ(hybrid_map_bytes(back.value().map, 77), bytes);
  EXPECT_EQ(back.value().map.state_at(kFaceOfTheBox), room.map.state_at(kFaceOfTheBox));
  for (std::size_t at = 0; at < bytes.size(); at += 997) {
    std::string bad = bytes;
    bad[at] = static_cast<char>(bad[at] ^ 0x20);
    EXPECT_FALSE(parse_hybrid_map(bad).ok()) << "byte " << at;
    EXPECT_FALSE(parse_hybrid_map(std::string_view(bytes).substr(0, at)).ok()) << "cut at " << at;
  }
}

/// A right checksum does not make a map: a backup brings what anybody wrote.
TEST(HybridMap, CellsThatCannotBeAreRefused) {
  Room room;
  room.look_for(2.0, box_at(5.0, 3.03));
  const std::string bytes = hybrid_map_bytes(room.map, 77);
  const auto with = [&](std::size_t at, auto value) {
    std::string changed = bytes.substr(0, bytes.size() - sizeof(std::uint64_t));
    std::memcpy(changed.data() + at, &value, sizeof value);
    ByteWriter out;
    out.put(changed);
    return parse_hybrid_map(out.take());
  };
  constexpr std::size_t kSeen = 40, kSamples = 60;  // of the first cell
  EXPECT_TRUE(with(kSeen, std::int64_t{5}).ok());
  EXPECT_FALSE(with(kSeen, std::int64_t{0}).ok());
  EXPECT_FALSE(with(kSeen, std::numeric_limits<std::int64_t>::min()).ok());
  EXPECT_FALSE(with(kSamples, -1.0F).ok());
}

TEST(HybridMap, TheSameLooksGiveTheSameBytes) {
  Room a, b;
  a.look_for(3.0, box_at(5.0, 3.03));
  b.look_for(3.0, box_at(5.0, 3.03));
  EXPECT_EQ(hybrid_map_bytes(a.map, 1), hybrid_map_bytes(b.map, 1));
}

TEST(MapRegistration, LaysAScanOnTheMapOfAHall) {
  std::mt19937 engine(3);
  auto settings = test::full_turn(360, 30.0);
  settings.range_sigma_m = 0.02;
  const mapping::Walls walls = test::laboratory_hall();
  HybridMap map;
  const auto scan_at = [&](const Transform2<Map, Base>& pose) {
    return scan_points(test::simulate_scan(walls, pose, settings, engine), {});
  };
  for (int i = 0; i < 60; ++i) {
    const Transform2<Map, Base> pose(1.5 + 0.25 * i, 5.3 - 0.05 * i, 0.1 * i);
    map.look(beams_of(scan_at(pose), {}, 0.3), pose, stamp_from_seconds(2.0 * i + 1.0));
  }
  const GaussianPyramid target(map);
  for (int k = 0; k < 12; ++k) {
    const Transform2<Map, Base> truth(2.0 + 1.2 * k, 5.0 - 0.2 * k, 0.5 * k);
    const Transform2<Map, Map> guess(truth.x_m() + 0.5 * std::cos(k), truth.y_m() + 0.5 * std::sin(k),
                                     truth.yaw_rad() + to_rad(k % 2 == 0 ? 10.0 : -10.0));
    const MapRegistration found = lay_on(target, GaussianPyramid(scan_at(truth), 0.25), guess);
    EXPECT_TRUE(found.converged);
    EXPECT_LT(std::hypot(found.x_m - truth.x_m(), found.y_m - truth.y_m()), 0.03) << k;
    EXPECT_LT(std::abs(wrap_angle(found.yaw_rad - truth.yaw_rad())), to_rad(0.5)) << k;
  }
}

TEST(MapRegistration, OfNothingAnswersTheGuess) {
  const GaussianPyramid nothing(0.25);
  const MapRegistration found = lay_on(nothing, nothing, {1.0, 2.0, 0.3});
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.x_m, 1.0);
}

}  // namespace
}  // namespace madori::localization
