#include "planning/route_graph/route_csv.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/angle.hpp"
#include "core/result.hpp"
#include "tests/support/published_routes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::planning {
namespace {

using test::kPublishedPath;
using test::kPublishedTree;
using ::testing::HasSubstr;

/// The findings of a pair of files, one text each.
std::vector<std::string> findings(const std::string& tree, const std::string& path) {
  std::vector<std::string> texts;
  for (const auto& finding : parse_routes(tree, path).findings) texts.push_back(finding.text());
  return texts;
}

TEST(RouteCsv, ReadsThePublishedTables) {
  const ParsedRoutes routes = parse_routes(kPublishedTree, kPublishedPath);
  EXPECT_TRUE(routes.findings.empty());
  ASSERT_EQ(routes.graph.nodes().size(), 6U);
  EXPECT_EQ(routes.graph.nodes()[5].position, (Point2<Map>{5.28, -3.52}));
  ASSERT_EQ(routes.graph.legs_from(1).size(), 3U);
  EXPECT_EQ(routes.graph.legs_from(1)[2].to, 3U);
  EXPECT_NEAR(routes.graph.legs_from(0)[0].length_m, std::hypot(1.8, 0.1), 1e-12);
}

TEST(RouteCsv, WritesThePublishedTablesByteForByte) {
  const auto graph = parse_routes(kPublishedTree, kPublishedPath).graph;
  EXPECT_EQ(tree_csv(graph), kPublishedTree);
  EXPECT_EQ(path_csv(graph), kPublishedPath);
}

TEST(RouteCsv, ToleratesWhatSpreadsheetsWrite) {
  const ParsedRoutes routes = parse_routes("\xEF\xBB\xBFID,EDA\r\n# hall 1\r\n 0 , 1  \r\n\r\n1,0  \r\n",
                                           "\xEF\xBB\xBFID;x;y\r\n0;1.5;\xE2\x88\x92"
                                           "2 # here\r\n1;2;+3\r\n");
  EXPECT_TRUE(routes.findings.empty());
  ASSERT_EQ(routes.graph.nodes().size(), 2U);
  EXPECT_DOUBLE_EQ(routes.graph.nodes()[0].position.y_m, -2.0);
  EXPECT_TRUE(routes.graph.one_way_legs().empty());
}

TEST(RouteCsv, ReadsDecimalCommasBetweenSemicolons) {
  const ParsedRoutes routes = parse_routes("ID;EDA\n0;1\n1;0\n",
                                           "ID;x;y;name;speed_mps\n0;8,5;20,25;Press 2, left;0,5\n"
                                           "1\t-12,0\t20.5\n");
  EXPECT_TRUE(routes.findings.empty());
  ASSERT_EQ(routes.graph.nodes().size(), 2U);
  EXPECT_EQ(routes.graph.nodes()[0].position, (Point2<Map>{8.5, 20.25}));
  EXPECT_EQ(routes.graph.nodes()[0].name, "Press 2, left");
  EXPECT_DOUBLE_EQ(routes.graph.nodes()[0].speed_limit_mps.value_or(0.0), 0.5);
  EXPECT_EQ(routes.graph.nodes()[1].position, (Point2<Map>{-12.0, 20.5}));
}

TEST(RouteCsv, ANumberSignInANameEndsNoRow) {
  const ParsedRoutes routes = parse_routes("ID,EDA\n1,2\n2,1\n",
                                           "ID,x,y,name,station,speed_mps,action\n"
                                           "1,24.9,16.0,Gate #2,1,0.1,door\n"
                                           "2,8,5,#3; left,,,load # here, too\n");
  EXPECT_TRUE(routes.findings.empty());
  ASSERT_EQ(routes.graph.nodes().size(), 2U);
  const RouteNode& gate = routes.graph.nodes()[0];
  EXPECT_EQ(gate.name, "Gate #2");
  EXPECT_TRUE(gate.station);
  EXPECT_DOUBLE_EQ(gate.speed_limit_mps.value_or(0.0), 0.1);
  EXPECT_EQ(gate.action, NodeAction::Door);
  EXPECT_EQ(routes.graph.nodes()[1].name, "#3; left");
  EXPECT_EQ(routes.graph.nodes()[1].action, NodeAction::Load);
}

TEST(RouteCsv, ACommentHidesNoField) {
  const std::string head = "ID,x,y,name,station # published columns, and two more\n";
  EXPECT_TRUE(
      findings("ID,EDA\n0,1 # 2, 3\n1,0 #2\n", head + "0,0,0 # short row\n1,1,1,,1# here, too\n").empty());
  EXPECT_TRUE(
      findings("0,1\n1, # dead end, or not\n", "0,0,0 # first; row\n  # all, of it\n1,1,1\n").empty());
  EXPECT_THAT(findings("ID,EDA\n0,\n", head + "0,0,0 # moved,Gate,1\n"),
              ::testing::Contains(HasSubstr("path.csv:2: y \"0 # moved\" must be a number")));
  EXPECT_THAT(findings("0 # from,1\n1,0\n", "ID,x,y\n0,0,0\n1,1,1\n"),
              ::testing::Contains(HasSubstr("tree.csv:1: \"0 # from\" is no node ID")));
}

TEST(RouteCsv, RefusesAnotherCodePageWithItsLine) {
  const std::string head =
      "ID,x,y,name\n0,0,0,S\xC3\xBC"
      "d\n";
  EXPECT_TRUE(findings("ID,EDA\n0,1\n1,0\n", head + "1,1,1,\xE5\x8D\x97 \xF0\x9F\x9A\xAA\n").empty());
  for (const std::string name : {"S\xFC"
                                 "d",
                                 "\xC3", "\xED\xA0\x80", "\xC0\xAF", "\xE0\x80\xAF", "\xF4\x90\x80\x80"})
    EXPECT_THAT(findings("ID,EDA\n0,1\n1,0\n", head + "1,1,1," + name + "\n"),
                ::testing::ElementsAre(HasSubstr("path.csv:3: is no text in UTF-8")));
  EXPECT_THAT(findings(std::string("\xFF\xFEI\0D\0", 6), head),
              ::testing::ElementsAre(HasSubstr("tree.csv:1: is no text in UTF-8")));
}

TEST(RouteCsv, LeavesNoFieldOut) {
  EXPECT_THAT(findings("ID,EDA\n0,1\n1,0\n", "ID,x,y\n0,8,5,20,2\n1,12,20,,\n"),
              ::testing::Contains(HasSubstr("path.csv:2: \"20\" stands in no column")));
  EXPECT_THAT(findings("ID;EDA\n0;\n", "ID;x;y\n0;1.234,5;2\n"),
              ::testing::Contains(HasSubstr("x \"1.234,5\" must be a number")));
}

TEST(RouteCsv, ReadsAndWritesOptionalColumns) {
  const std::string path =
      "ID,x,y,name,station,heading_deg,speed_mps,action\n0,0,0,\"Press 2, "
      "left\",1,90,0.5,load\n1,1,0,,,,,lift\n";
  const ParsedRoutes routes = parse_routes("ID,EDA\n0,1\n1,0\n", path);
  EXPECT_TRUE(routes.findings.empty());
  const RouteNode& press = routes.graph.nodes()[0];
  EXPECT_EQ(press.name, "Press 2, left");
  EXPECT_TRUE(press.station);
  EXPECT_DOUBLE_EQ(press.heading_rad.value_or(0.0), kPi / 2.0);
  EXPECT_DOUBLE_EQ(press.speed_limit_mps.value_or(0.0), 0.5);
  EXPECT_EQ(press.action, NodeAction::Load);
  EXPECT_EQ(routes.graph.nodes()[1].action, NodeAction::Lift);
  EXPECT_EQ(routes.graph.find("Press 2, left"), std::optional<std::size_t>(0));
  EXPECT_EQ(path_csv(routes.graph), path);
}

TEST(RouteCsv, NamesFileAndLineOfEveryFault) {
  EXPECT_THAT(findings("ID,EDA\n0,1 7\n1,0\n", "ID,x,y\n0,0,0\n1,1,1\n"),
              ::testing::ElementsAre(HasSubstr("tree.csv:2: node 7 is not in path.csv")));
  EXPECT_THAT(findings("ID,EDA\n0,1\n", "ID,x,y\n0,0,0\n1,nan,1\n"),
              ::testing::Contains(HasSubstr("path.csv:3: x \"nan\" must be a number")));
  EXPECT_THAT(findings("ID,EDA\n0,\n", "ID,x,y\n0,0,0\n0,1,1\n"),
              ::testing::ElementsAre(HasSubstr("path.csv:3: ID 0 stands already on line 2")));
  EXPECT_THAT(findings("ID,EDA\n0,1\n0,1\n", "ID,x,y\n0,0,0\n1,1,1\n"),
              ::testing::ElementsAre(HasSubstr("tree.csv:3: node 0 stands already on line 2")));
  EXPECT_THAT(findings("ID,EDA\n0,1 1 0\n", "ID,x,y\n0,0,0\n1,1,1\n"),
              ::testing::ElementsAre(HasSubstr("stands twice"), HasSubstr("its own neighbour")));
  EXPECT_THAT(findings("", "ID,x,y,hight\n0,0,0,1\n"),
              ::testing::ElementsAre(HasSubstr("\"hight\" is not known")));
  EXPECT_THAT(findings("", ""), ::testing::ElementsAre(HasSubstr("holds no node")));
  EXPECT_THAT(findings("ID,EDA\n0,1,2\n", "ID,x,y\n0,0,0\n1,1,1\n"),
              ::testing::ElementsAre(HasSubstr("two columns")));
  EXPECT_THAT(findings("ID,EDA\n0,x\n", "ID,x,y\n0,0,0\n"),
              ::testing::ElementsAre(HasSubstr("is no node ID")));
  EXPECT_THAT(findings("ID,EDA\n", "ID,x,y\n0,0,inf\n"), ::testing::Contains(HasSubstr("y \"inf\"")));
}

TEST(RouteCsv, LoadingFailsOnAFault) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)load_routes(folder.path()), Error);
  folder.write("tree.csv", kPublishedTree);
  folder.write("path.csv", kPublishedPath);
  EXPECT_EQ(load_routes(folder.path()).nodes().size(), 6U);
  folder.write("tree.csv", "ID,EDA\n0,9\n");
  EXPECT_THROW((void)load_routes(folder.path()), Error);
}

}  // namespace
}  // namespace madori::planning
