#include "hmi/server/doubted_walls.hpp"

#include <gtest/gtest.h>

namespace madori::hmi {
namespace {

/// Pieces of a metre of a wall along x at height y; those with a number of looks through them are missing.
std::vector<WallView> wall(int id, double y, const std::vector<double>& missed) {
  std::vector<WallView> pieces;
  for (std::size_t i = 0; i < missed.size(); ++i) {
    WallView piece;
    piece.id = id;
    piece.piece = static_cast<int>(i);
    piece.segment = {{static_cast<double>(i), y}, {static_cast<double>(i + 1), y}};
    piece.missed = missed[i];
    piece.surely_missing = missed[i] > 0.0;
    pieces.push_back(piece);
  }
  return pieces;
}

std::vector<WallView> together(std::vector<WallView> a, const std::vector<WallView>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(DoubtedWalls, AdjoiningPiecesAreOneQuestionTheLongestFirst) {
  const auto walls = doubted_walls(wall(7, 0.0, {9, 0, 6, 12, 8, 0}), {});
  ASSERT_EQ(walls.size(), 2U);
  EXPECT_EQ(walls[0].segments.front().a.x_m, 2.0);
  EXPECT_EQ(walls[0].segments.front().b.x_m, 5.0);
  EXPECT_EQ(walls[0].missed, 6.0);  // of the piece with the fewest
  EXPECT_EQ(walls[1].segments.front().length_m(), 1.0);
}

TEST(DoubtedWalls, PiecesOfTwoWallsAreTwoQuestions) {
  EXPECT_EQ(doubted_walls(together(wall(7, 0.0, {9}), wall(8, 3.0, {0, 9})), {}).size(), 2U);
}

TEST(DoubtedWalls, BothFacesOfAWallAreOneQuestion) {
  const auto walls = doubted_walls(together(wall(7, 0.0, {9, 9, 9, 9}), wall(8, 0.2, {0, 5, 5, 5})), {});
  ASSERT_EQ(walls.size(), 1U);
  EXPECT_EQ(walls[0].segments.size(), 2U);
  EXPECT_EQ(walls[0].missed, 5.0);
  EXPECT_EQ(doubted_walls(together(wall(7, 0.0, {9, 9, 9, 9}), wall(8, 0.7, {0, 5, 5, 5})), {}).size(), 2U);
  // one behind the other in one line
  EXPECT_EQ(doubted_walls(together(wall(7, 0.0, {9, 9}), wall(8, 0.1, {0, 0, 0, 9})), {}).size(), 2U);
}

TEST(DoubtedWalls, WhatAPersonSaysStandsIsNotAskedAgain) {
  const auto pieces = wall(7, 0.0, {9, 9, 9, 9});
  EXPECT_TRUE(doubted_walls(pieces, {{{0.0, 0.0}, {4.0, 0.0}}}).empty());
  const auto left = doubted_walls(pieces, {{{1.0, 0.0}, {2.0, 0.0}}});
  ASSERT_EQ(left.size(), 2U);
  EXPECT_EQ(left[0].segments.front().a.x_m, 2.0);
  EXPECT_EQ(doubted_walls(pieces, {{{0.0, 0.2}, {4.0, 0.2}}}).size(), 1U);  // of the other face
}

}  // namespace
}  // namespace madori::hmi
