#include "localization/placement/votes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "localization/placement/free_ways.hpp"
#include "localization/placement/placement.hpp"

namespace madori::localization {
namespace {

Votes votes_of(std::vector<double> nats, int crossed = 0) {
  constexpr double kCertainWall = 1.9;
  return {std::move(nats), crossed * kCertainWall};
}

/// `count` pieces that speak for the first place, and `against` for the second, by two nats each: a vote.
double odds_of(int count, int against) {
  Votes a, b;
  for (int i = 0; i < count + against; ++i) {
    a.nats.push_back(i < count ? 2.0 : 0.0);
    b.nats.push_back(i < count ? 0.0 : 2.0);
  }
  return log_odds(a, b);
}

/// The definition, by a sum over the unknown rate at which votes are right.
double by_numbers(double for_a, double for_b) {
  constexpr int kSteps = 200'000;
  const auto evidence = [&](double more, double less) {
    double sum = 0.0, all = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      const double q = 0.5 + 0.5 * (i + 0.5) / kSteps;
      sum += q * q * std::pow(q, more) * std::pow(1.0 - q, less);
      all += q * q;
    }
    return 0.2 * std::pow(0.5, for_a + for_b) + 0.8 * sum / all;
  };
  return std::log(evidence(for_a, for_b) / evidence(for_b, for_a));
}

TEST(Votes, AreCountedAsTheirDefinitionSays) {
  for (const auto& [a, b] : {std::pair{0, 0}, {3, 0}, {0, 5}, {7, 2}, {14, 6}, {30, 1}})
    EXPECT_NEAR(odds_of(a, b), by_numbers(a, b), 1e-4 * (1.0 + std::abs(by_numbers(a, b)))) << a << ":" << b;
}

TEST(Votes, ForOneAreVotesAgainstTheOther) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> nats(0.0, 3.0);
  for (int trial = 0; trial < 50; ++trial) {
    Votes a = votes_of({}, trial % 4), b = votes_of({}, trial % 3);
    for (int i = 0; i < trial; ++i) a.nats.push_back(nats(engine)), b.nats.push_back(nats(engine));
    EXPECT_NEAR(log_odds(a, b), -log_odds(b, a), 1e-9);
    EXPECT_EQ(log_odds(a, a), 0.0);
  }
}

TEST(Votes, ThatAgreeDecideAndThatContradictDoNot) {
  for (int n = 1; n < 40; ++n) EXPECT_GT(odds_of(n + 1, 0), odds_of(n, 0));
  EXPECT_GT(odds_of(20, 0), std::log(1e4));
  // Many votes of which six in ten are right are no more than a hint, where likelihoods would add up.
  EXPECT_LT(odds_of(12, 8), std::log(5.0));
  EXPECT_LT(odds_of(14, 6), std::log(20.0));
  EXPECT_TRUE(std::isfinite(odds_of(3000, 0)));
}

TEST(Votes, DrawnWallsThatWereDrivenThroughSpeakAgainstAPlace) {
  EXPECT_LT(log_odds(votes_of({}, 3), votes_of({}, 0)), -1.0);
  EXPECT_EQ(log_odds(votes_of({}, 3), votes_of({}, 3)), 0.0);
}

TEST(Votes, APieceOfWallIsTwoMetresAndOneDirection) {
  MemoryCloud cloud;
  for (int i = 0; i < 40; ++i)
    cloud.push_back({0.1 + 0.2 * i, 0.5, 0.0, 1.0, 0, WallIndex::direction_of(0.0, 1.0), 1, 1.0});
  const WallPieces pieces = wall_pieces(cloud);
  EXPECT_EQ(pieces.count, 4U);
  EXPECT_EQ(std::count(pieces.of_surface.begin(), pieces.of_surface.end(), pieces.of_surface.front()), 10);
}

/// A wall with a door of 0.9 m in its middle; beams from 4 m before it to 4 m behind it.
TEST(FreeWays, WhatGoesThroughADoorCrossesNoWallThoughThePoseIsOffByAFewCentimetres) {
  const mapping::Walls walls{{1, {{-6.0, 0.0}, {-0.45, 0.0}}}, {2, {{0.45, 0.0}, {6.0, 0.0}}}};
  const mapping::DistanceField drawn(walls);
  const WallIndex index(walls);
  FreeWays ways;
  for (double x_m = -0.44; x_m < 0.445; x_m += 0.02)
    ways.beams.push_back({{0.5 * x_m, -4.0}, {1.5 * x_m, 4.0}});
  for (const double off_m : {-0.05, -0.025, 0.0, 0.025, 0.05})
    EXPECT_EQ(nats_of_crossed_walls(ways, Transform2<Map, Map>(off_m, 0.0, 0.0), drawn, index), 0) << off_m;
  EXPECT_GT(nats_of_crossed_walls(ways, Transform2<Map, Map>(1.5, 0.0, 0.0), drawn, index), 0)
      << "the door is elsewhere";
}

/// A line that may be no wall is the likelier to be crossed: by the law of total probability.
TEST(FreeWays, SpeakAgainstALineByAsMuchAsItIsAWall) {
  FreeWays ways;
  for (double x_m = -0.44; x_m < 0.445; x_m += 0.02) ways.beams.push_back({{x_m, -4.0}, {x_m, 4.0}});
  const auto nats = [&](double probability) {
    const mapping::Walls walls{{1, {{-6.0, 0.3}, {6.0, 0.3}}, probability}, {2, {{-6.0, 9.0}, {6.0, 9.0}}}};
    return nats_of_crossed_walls(ways, {}, mapping::DistanceField(walls), WallIndex(walls));
  };
  const double missing = std::exp(-0.5 * nats(1.0));  // the beams cross it in two pieces
  EXPECT_LT(missing, 0.5);
  for (const double p : {0.0, 0.3, 0.6, 0.9})
    EXPECT_NEAR(std::exp(-0.5 * nats(p)), 1.0 - p + p * missing, 1e-9) << p;
}

/// A pose that was given speaks where the vehicle may be there, and is of another place where it is not:
/// the two make up the prior (Bayes).
TEST(StartPrior, HoldsTheVehicleOnlyWhereItIsBelieved) {
  const StartPrior told{{4.0, 3.0, 0.4}, 0.3, 0.1};
  constexpr double kAreaM2 = 112.0;
  const auto holds = [&](double off_m) { return prior_holds(told, {4.0 + off_m, 3.0, 0.4}, kAreaM2); };
  EXPECT_GT(holds(0.0), 0.99);
  EXPECT_LT(holds(2.5), 1e-6);
  double before = 1.0;
  for (double off_m = 0.0; off_m < 3.0; off_m += 0.1) {
    EXPECT_LE(holds(off_m), before);
    before = holds(off_m);
    const double density = std::exp(log_prior(told, {4.0 + off_m, 3.0, 0.4}, kAreaM2));
    EXPECT_NEAR(density * (1.0 - before), 0.05 / (2.0 * kPi * kAreaM2), 1e-9) << "wrong ones are anywhere";
  }
}

}  // namespace
}  // namespace madori::localization
