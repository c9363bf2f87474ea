// Edges, what is known of them, and the model that judges them.
#include "mapping/drawing/labelling/label_sheet.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/result.hpp"
#include "mapping/drawing/labelling/taught_edges.hpp"
#include "mapping/drawing/labelling/wall_threshold.hpp"
#include "tests/support/paper_image.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

using test::canvas;
using test::paper;

const Edge* longest_near(const EdgeSheet& sheet, double v) {
  const Edge* best = nullptr;
  for (const Edge& edge : sheet.edges) {
    const double off = 0.5 * (edge.segment.v1 + edge.segment.v2) / sheet.factor - v;
    if (std::abs(off) < 1.5 && (best == nullptr || edge.length_px > best->length_px)) best = &edge;
  }
  return best;
}

TEST(EdgeSheet, BothSidesOfABarPointInwards) {
  GrayImage image = paper(600, 400);
  cv::rectangle(canvas(image), {100, 100}, {499, 119}, 0, cv::FILLED);
  const EdgeSheet sheet = find_edges(image);
  const Edge *upper = longest_near(sheet, 100), *lower = longest_near(sheet, 120);
  ASSERT_NE(upper, nullptr);
  ASSERT_NE(lower, nullptr);
  EXPECT_GT(upper->length_px, 380 * sheet.factor);
  EXPECT_GT(upper->normal.y, 0.99) << "the dark side is below";
  EXPECT_LT(lower->normal.y, -0.99) << "the dark side is above";
}

TEST(EdgeViews, MeetTheOtherSideOfABar) {
  GrayImage image = paper(600, 400);
  cv::rectangle(canvas(image), {100, 100}, {499, 119}, 0, cv::FILLED);
  const EdgeSheet sheet = find_edges(image);
  const auto views = look_across(sheet);
  const Edge* upper = longest_near(sheet, 100);
  ASSERT_NE(upper, nullptr);
  const EdgeViews& view = views[static_cast<std::size_t>(upper - sheet.edges.data())];
  EXPECT_NEAR(view.dark.hits[0].distance_px, 20 * sheet.factor, 2);
  EXPECT_GT(view.dark.hits[0].opposite, 0.9);
  EXPECT_LT(view.dark.fill_grey, 30);
  EXPECT_EQ(view.bright.hits[0].share, 0) << "there is nothing above it";
  EXPECT_GT(view.bright.near_grey, 220);
}

TEST(EdgeFeatures, HaveNamesOfTheirOwnAndAreFinite) {
  GrayImage image = paper(500, 400);
  cv::rectangle(canvas(image), {60, 60}, {440, 340}, 0, 3);
  cv::circle(canvas(image), {250, 200}, 60, 90, 2);
  const LabelSheet sheet = label_sheet(find_edges(image));
  const auto& names = sheet.features.names();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  ASSERT_GT(sheet.features.rows(), 8U);
  for (std::size_t row = 0; row < sheet.features.rows(); ++row)
    for (std::size_t column = 0; column < names.size(); ++column)
      ASSERT_TRUE(std::isfinite(sheet.features.at(row, column))) << names[column];
}

TEST(WallModel, WhatItTellsRisesWithWhatItJudgesAndComesBackFromItsFile) {
  const test::TemporaryFolder folder;
  const Forest none;
  const WallModel model(none, none, {1.25, -0.5});
  const WallModel back = WallModel::load(folder.write("model.ubj", model.bytes()));
  double before = -1;
  for (double judged = 0; judged <= 1; judged += 0.05) {
    EXPECT_GT(model.told(judged), before);
    EXPECT_EQ(back.told(judged), model.told(judged));
    before = model.told(judged);
  }
  EXPECT_NEAR(std::log(model.told(0.9) / (1 - model.told(0.9))), 1.25 * std::log(9.0) - 0.5, 1e-9);
  const std::string bytes = model.bytes();
  const std::size_t line = bytes.find("1.25");
  for (const std::string& end : {std::string(), std::string("1.25"), std::string("x y\n")})
    EXPECT_THROW((void)WallModel::load(folder.write("cut.ubj", bytes.substr(0, line) + end)), Error) << end;
}

TEST(WallModel, RefusesWhatIsNoModelAndOtherFeatures) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)WallModel::load("/no/such/model"), Error);
  EXPECT_THROW((void)WallModel::load("/dev/zero"), Error);
  EXPECT_THROW((void)WallModel::load(folder.write("model.ubj", "not trees")), Error);
  FeatureTable other(1);
  other.add("something", {1.0F});
  EXPECT_THROW((void)WallModel::shipped().first(other), Error);
}

std::vector<Edge> edges_of(const std::vector<double>& lengths) {
  std::vector<Edge> edges;
  for (const double length : lengths) edges.push_back({.segment = {0, 0, length, 0}, .length_px = length});
  return edges;
}

/// The expected F measure of taking all edges from a probability on, by its definition.
double expected_f(const std::vector<float>& p, const std::vector<Edge>& edges, double from) {
  double right = 0, taken = 0, all = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    all += p[i] * edges[i].length_px;
    if (p[i] < from) continue;
    right += p[i] * edges[i].length_px;
    taken += edges[i].length_px;
  }
  return 2 * right / (taken + all);
}

TEST(WallThreshold, NoOtherThresholdExpectsMore) {
  const std::vector<float> p{0.9F, 0.05F, 0.4F, 0.3F, 0.75F, 0.31F, 0.02F, 0.6F};
  const auto edges = edges_of({10, 400, 60, 90, 5, 20, 300, 33});
  const double chosen = expected_f(p, edges, wall_threshold(p, edges, 1));
  for (const float from : p) EXPECT_LE(expected_f(p, edges, from), chosen + 1e-12);
}

/// Two heaps, the judges leaning low: the threshold lies between them and not in the heap of the walls.
TEST(WallThreshold, LiesBetweenTheHeaps) {
  std::vector<float> p;
  for (int k = 0; k < 60; ++k) p.push_back(0.5F + 0.007F * static_cast<float>(k));
  for (int k = 0; k < 40; ++k) p.push_back(0.01F + 0.001F * static_cast<float>(k));
  const auto edges = edges_of(std::vector<double>(p.size(), 10));
  const double chosen = wall_threshold(p, edges);
  EXPECT_LE(chosen, 0.5) << "the least of the walls";
  EXPECT_GT(chosen, 0.06);
}

TEST(WallThreshold, IsLowWhereAllIsDoubtfulAndHigherForTheStrict) {
  const auto edges = edges_of({10, 10, 10, 10});
  EXPECT_LT(wall_threshold({0.3F, 0.28F, 0.02F, 0.01F}, edges, 1), 0.3);
  EXPECT_GT(wall_threshold({0.95F, 0.9F, 0.3F, 0.01F}, edges, 1), 0.5);
  const std::vector<float> p{0.9F, 0.7F, 0.5F, 0.3F};
  EXPECT_LT(wall_threshold(p, edges, 0.1), wall_threshold(p, edges, 5));
}

/// Two kinds of boxes: a touch on one of a kind speaks for the others of its kind more than for the other
/// kind.
TEST(TaughtEdges, ATouchSpeaksForWhatIsAlike) {
  GrayImage image = paper(1000, 700);
  for (const int u : {50, 350, 650}) {
    cv::rectangle(canvas(image), {u, 50}, {u + 250, 300}, 0, 6);
    cv::rectangle(canvas(image), {u + 100, 450}, {u + 130, 480}, 150, 1);
  }
  const LabelSheet sheet = label_sheet(find_edges(image));
  const std::vector<float> doubtful(sheet.edges.edges.size(), 0.5F);
  const auto after = taught_edges(sheet, doubtful, {{.u = 475, .v = 50, .wall = true}});
  double large = 0, small = 0, large_length = 0, small_length = 0;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Edge& e = sheet.edges.edges[i];
    const bool box = e.segment.v1 / sheet.edges.factor < 400;
    (box ? large : small) += after[i] * e.length_px;
    (box ? large_length : small_length) += e.length_px;
    EXPECT_GE(after[i], 0.5F) << "no touch of a wall makes anything less of a wall";
  }
  ASSERT_GT(small_length, 0);
  EXPECT_GT(large / large_length, 0.8);
  EXPECT_LT(small / small_length, 0.65);
  const auto back = taught_edges(sheet, after, {{.u = 475, .v = 50, .wall = false}});
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_NEAR(back[i], 0.5, 1e-3) << "both touches cancel";
  EXPECT_EQ(taught_edges(sheet, doubtful, {}), doubtful);
}

/// Numbers and order of edges mean nothing: the context of an edge moves with it.
TEST(SheetContext, FollowsTheEdgesWhereverTheyStand) {
  const std::vector<PixelSegment> edges{{0, 0, 90, 0}, {0, 10, 90, 10}, {0, 0, 0, 40}, {200, 200, 260, 260}};
  const std::vector<float> p{0.9F, 0.8F, 0.2F, 0.1F};
  EdgeGroups groups;
  groups.together = {std::vector{0, 0, 1, 2}, std::vector{0, 0, 0, 1}, std::vector{0, 1, 2, 3},
                     std::vector{0, 0, 0, 1}};
  groups.partner = {std::vector{1, 0, -1, -1}, std::vector{-1, -1, -1, -1}};
  const FeatureTable table = sheet_context(edges, groups, p);
  const std::vector<std::size_t> turned{3, 2, 1, 0};
  std::vector<PixelSegment> other_edges;
  std::vector<float> other_p;
  EdgeGroups other;
  for (const std::size_t i : turned) {
    other_edges.push_back(edges[i]);
    other_p.push_back(p[i]);
    for (std::size_t k = 0; k < 4; ++k) other.together[k].push_back(7 * groups.together[k][i] + 3);
    for (std::size_t k = 0; k < 2; ++k) {
      const int partner = groups.partner[k][i];
      other.partner[k].push_back(partner < 0 ? -1 : 3 - partner);
    }
  }
  const FeatureTable same = sheet_context(other_edges, other, other_p);
  ASSERT_EQ(same.names(), table.names());
  for (std::size_t i = 0; i < turned.size(); ++i)
    for (std::size_t column = 0; column < table.names().size(); ++column)
      EXPECT_NEAR(same.at(i, column), table.at(turned[i], column), 1e-5) << table.names()[column];
}

}  // namespace
}  // namespace madori::mapping
