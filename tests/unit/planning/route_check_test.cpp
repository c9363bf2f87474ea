#include "planning/route_graph/route_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/segment_distance.hpp"
#include "planning/route_graph/finding_texts.hpp"
#include "tests/support/published_routes.hpp"

namespace madori::planning {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<std::string> errors(const std::vector<RouteFinding>& findings) {
  std::vector<std::string> texts;
  for (const auto& finding : findings)
    if (finding.severity == Severity::Error) texts.push_back(finding.text());
  return texts;
}

RouteGraph square() {
  return parse_routes("ID,EDA\n0,1 3\n1,0 2\n2,1 3\n3,0 2\n", "ID,x,y\n0,0,0\n1,4,0\n2,4,4\n3,0,4\n").graph;
}

TEST(RouteCheck, ThePublishedSampleHasTwoOneWayLegsAndAnUnreachableNode) {
  const auto graph = parse_routes(test::kPublishedTree, test::kPublishedPath).graph;
  const auto findings = check_routes(graph, {});
  ASSERT_EQ(findings.size(), 3U);
  EXPECT_EQ(findings[0].text(), "tree.csv:4: leg 2 -> 3 is one-way: node 3 does not list node 2");
  EXPECT_EQ(findings[1].text(), "tree.csv:7: leg 5 -> 2 is one-way: node 2 does not list node 5");
  EXPECT_EQ(findings[2].text(), "path.csv:7: node 5 cannot be reached from the other nodes");
  EXPECT_TRUE(check_routes(graph.symmetric(), {}).empty());
}

TEST(RouteCheck, AGoodSquareHasNoFinding) {
  EXPECT_TRUE(check_routes(square(), {{{2, 1}, {2, 3}}}).empty());
}

TEST(RouteCheck, ALegThroughAWallIsAnErrorAndANearWallAWarning) {
  EXPECT_THAT(errors(check_routes(square(), {{{2, -1}, {2, 1}}})),
              ::testing::ElementsAre(HasSubstr("tree.csv:2: leg 0 -> 1 goes through a drawn wall")));
  const auto near = check_routes(square(), {{{1, 0.2}, {3, 0.2}}});
  ASSERT_EQ(near.size(), 1U);
  EXPECT_EQ(near[0].severity, Severity::Warning);
  EXPECT_THAT(near[0].message, HasSubstr("at 0.20 m"));
}

TEST(RouteCheck, ADeadEndStationIsAnErrorButAPlainNodeIsNot) {
  const std::string tree = "ID,EDA\n0,1\n1,0 2\n2,\n";
  EXPECT_THAT(errors(check_routes(parse_routes(tree, "ID,x,y\n0,0,0\n1,1,0\n2,2,0\n").graph, {})),
              Contains(HasSubstr("from node 2 no way leads back")));
  const auto marked = parse_routes(tree, "ID,x,y,station\n0,0,0,1\n1,1,0,1\n2,2,0,\n").graph;
  EXPECT_TRUE(errors(check_routes(marked, {})).empty());
}

TEST(SegmentDistance, CrossingTouchingAndApart) {
  const Segment2<Map> base{{0, 0}, {4, 0}};
  EXPECT_EQ(distance_m(base, Segment2<Map>{{2, -1}, {2, 1}}), 0.0);
  EXPECT_EQ(distance_m(base, Segment2<Map>{{2, 0}, {2, 1}}), 0.0);
  EXPECT_DOUBLE_EQ(distance_m(base, Segment2<Map>{{5, 0}, {9, 0}}), 1.0);
  EXPECT_DOUBLE_EQ(distance_m(base, Segment2<Map>{{1, 3}, {2, 2}}), 2.0);
}

TEST(FindingTexts, EveryCodeIsThereOnceAndEveryPlaceholderIsFilled) {
  const auto broken = parse_routes("ID,EDA\n0,1 1 0 9 x\n1,0\n1,0\n3,1,4\n",
                                   "ID,x,y,name,colour\n0,0,0,A,1\n0,1,1\n1,9,9\n2,a,1\n3,1,1\n-4,1,1\n");
  auto findings = broken.findings;
  const auto graph =
      parse_routes("ID,EDA\n0,1\n1,0 2\n2,\n3,\n", "ID,x,y,station\n0,0,0,1\n1,4,0,1\n2,4.01,0,1\n3,9,9,1\n")
          .graph;
  for (const auto& finding : check_routes(graph, {{{2, -1}, {2, 1}}, {{-1, 0.2}, {0.5, 0.2}}}, {}))
    findings.push_back(finding);
  std::set<std::string> codes;
  for (const auto& finding : findings) {
    codes.insert(finding.code);
    EXPECT_EQ(finding.message.find('{'), std::string::npos) << finding.message;
    for (const auto& [name, value] : finding.values) EXPECT_THAT(finding.message, HasSubstr(value)) << name;
  }
  EXPECT_THAT(codes, testing::IsSupersetOf({"unknown-column", "repeated-id", "number-out-of-range", "bad-id",
                                            "repeated-neighbour", "own-neighbour", "unknown-neighbour",
                                            "bad-neighbour", "repeated-row", "too-many-columns",
                                            "through-wall", "one-way", "short-leg"}));
  std::set<std::string> known;
  for (const auto& text : kFindingTexts) EXPECT_TRUE(known.insert(text.code).second) << text.code;
  EXPECT_TRUE(std::ranges::includes(known, codes));
}

}  // namespace
}  // namespace madori::planning
