#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>

#include "core/result.hpp"
#include "mapping/drawing/vector/door_leaves.hpp"
#include "mapping/drawing/vector/dxf_layers.hpp"
#include "mapping/drawing/vector/dxf_units.hpp"
#include "mapping/drawing/vector/load_dxf.hpp"
#include "mapping/dxf_text/dxf_text.hpp"
#include "mapping/wall_map/wall.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

using ::testing::HasSubstr;
const std::filesystem::path kFactory = std::filesystem::path(MADORI_SOURCE_DIR) / "data/sample_factory";

TEST(DxfLayers, NamesOfSeveralLanguagesAreUnderstood) {
  for (const char* name :
       {"A-WALL", "xref-house$0$A-WALL", "Wand (neu)", "Außenwände", "MUROS", "02_壁", "COLUMNS", "Stützen"})
    EXPECT_TRUE(layer_meaning(name).kind == LayerKind::Wall || layer_meaning(name).kind == LayerKind::Column)
        << name;
  for (const char* name :
       {"WALLS_HATCH", "Wandschraffur", "A-DIMS-1", "Bemaßung", "Shelves", "Doors/Windows", "A-WALL-OPENING"})
    EXPECT_EQ(layer_meaning(name).kind, LayerKind::NoWall) << name;
  EXPECT_EQ(layer_meaning("0").kind, LayerKind::Unknown);
}

/// The short words of what is no wall stand in many others.
TEST(DxfLayers, AWordInsideAnotherOneSaysNothing) {
  for (const char* name : {"INDOOR-WALL", "OUTDOOR WALL", "RESIDENTIAL-WALL", "A-WALL-INFILL",
                           "Wand-Textilhalle", "WALL-DIMMED", "Bordered_walls", "BackdoorWall$0$INDOOR_WALL"})
    EXPECT_EQ(layer_meaning(name).kind, LayerKind::Wall) << name;
  for (const char* name : {"W_TRACKSIDE", "MISCELLANEOUS", "GROUNDPLANE", "Nachschublager", "Krankenhaus"})
    EXPECT_EQ(layer_meaning(name).kind, LayerKind::Unknown) << name;
  for (const char* name :
       {"ANNTEXT", "WallText", "A-WALL-FILL", "Raumtext", "WALLDIMS", "WALL-DIM2", "WallDoors", "02_壁寸法",
        "Innentüren", "WALL_NOTES", "A-WALL-IDEN", "Wall-Border"})
    EXPECT_EQ(layer_meaning(name).kind, LayerKind::NoWall) << name;
  EXPECT_EQ(layer_meaning("PalletRacks").reason, RejectReason::Furniture);
  EXPECT_TRUE(layer_meaning("Brandwand_Fensterband").says_wall);
  EXPECT_FALSE(layer_meaning("Fensterband").says_wall);
}

TEST(DxfUnits, InsunitsCountsWhereABuildingComesOut) {
  DxfUnitEvidence evidence;
  evidence.insunits = 4;
  evidence.extent = 80'000;
  ASSERT_TRUE(choose_unit(evidence));
  EXPECT_DOUBLE_EQ(choose_unit(evidence)->metres, 0.001);
  EXPECT_THAT(choose_unit(evidence)->note, HasSubstr("$INSUNITS says so"));
}

TEST(DxfUnits, AWrongInsunitsIsOverruledAndSaid) {
  DxfUnitEvidence evidence;  // says millimetres, but feet-and-inches figures and 36-unit doors stand in it
  evidence.insunits = 4;
  evidence.measurement = 1;
  evidence.extent = 964;
  evidence.door_radii = {36, 32, 36};
  evidence.imperial_texts = true;
  ASSERT_TRUE(choose_unit(evidence));
  EXPECT_DOUBLE_EQ(choose_unit(evidence)->metres, 0.0254);
  EXPECT_THAT(choose_unit(evidence)->note, HasSubstr("says otherwise"));
}

TEST(DxfUnits, DoorsDecideWhereTheHeaderIsSilent) {
  DxfUnitEvidence evidence;
  evidence.extent = 2000;
  evidence.door_radii = {90};
  EXPECT_DOUBLE_EQ(choose_unit(evidence)->metres, 0.01);
}

TEST(DxfUnits, AnAbsurdSizeHasNoUnit) {
  DxfUnitEvidence evidence;
  evidence.extent = 1e12;
  EXPECT_FALSE(choose_unit(evidence));
  evidence.extent = std::nan("");
  EXPECT_FALSE(choose_unit(evidence));
}

TEST(DxfUnits, SeveralThatExplainItAlikeAreNoChoice) {
  DxfUnitEvidence evidence;
  evidence.measurement = 1;
  evidence.extent = 8400;  // 8.4 m in millimetres, 84 m in centimetres
  EXPECT_FALSE(choose_unit(evidence));
  evidence.door_radii = {90};
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 0.01);
}

TEST(DxfUnits, HardlyAnybodyDrawsInDecimetresOrYardsUnlessTheFileSaysSo) {
  DxfUnitEvidence evidence;
  evidence.measurement = 1;
  evidence.extent = 84;
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 1.0);
  evidence.insunits = 14;
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 0.1);
  evidence.insunits = 10;
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 0.9144);
}

TEST(DxfUnits, FeetAndInchesFiguresMeanInches) {
  DxfUnitEvidence evidence;
  evidence.extent = 964;
  evidence.imperial_texts = true;
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 0.0254);
  evidence.insunits = 2;
  EXPECT_DOUBLE_EQ(choose_unit(evidence).value().metres, 0.3048);
}

DxfText text_of(const std::string& content) {
  const test::TemporaryFolder folder;
  return read_dxf_text(folder.write("a.dxf", content + "0\nEOF\n"));
}

TEST(DxfUnits, ReadsTheHeaderOnly) {
  const DxfText text = text_of(
      "\xEF\xBB\xBF  0\r\nSECTION\r\n  2\r\nHEADER\r\n  9\r\n$INSUNITS\r\n 70\r\n     6\r\n  9\r\n"
      "$MEASUREMENT\r\n 70\r\n1\r\n  0\r\nENDSEC\r\n"
      "  9\r\n$INSUNITS\r\n 70\r\n 1\r\n");
  EXPECT_EQ(text.insunits, 6);
  EXPECT_EQ(text.measurement, 1);
}

TEST(LoadDxf, TheSampleFactoryComesOutExactly) {
  const Plan plan = load_dxf(kFactory / "factory.dxf", {});
  ASSERT_TRUE(plan.vectors && plan.m_per_px);
  const Walls truth = load_walls(kFactory / "true_walls.csv");
  double truth_m = 0.0, found_m = 0.0;
  for (const auto& wall : truth) truth_m += wall.segment.length_m();
  for (const auto& wall : plan.vectors->walls) found_m += wall.length_px() * *plan.m_per_px;
  EXPECT_EQ(plan.vectors->walls.size(), truth.size());
  EXPECT_NEAR(found_m, truth_m, 0.01 * truth_m);
}

DxfLine drawn(double x1, double y1, double x2, double y2) {
  DxfLine line;
  line.x1 = x1, line.y1 = y1, line.x2 = x2, line.y2 = y2;
  return line;
}

TEST(DoorLeaves, OnlyWhatLiesFromHingeToArcIsALeaf) {
  const DoorSwing door{{10, 20}, {10.9, 20}, {10, 20.9}, 0.9};
  std::vector<DxfLine> lines{drawn(10, 20, 10, 20.9),        // the leaf
                             drawn(10.9, 20.02, 10.04, 20),  // closed, a little inside its frame
                             drawn(10.04, 20.9, 10.04, 20),  // the other side of a thick leaf
                             drawn(10, 20, 10, 21.4),        // a wall that ends at the hinge
                             drawn(10, 20, 9.1, 20),         // as long, on the other side
                             drawn(11.5, 20, 11.5, 20.9),    // as long, elsewhere
                             drawn(10, 20, 9.9, 20)};        // the end of the wall beside it
  mark_door_leaves(lines, {door});
  for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i].door_leaf, i < 3) << i;
}

TEST(DoorLeaves, AnArcFarLargerThanTheDoorsIsNone) {
  const DoorSwing door{{0, 0}, {1, 0}, {0, 1}, 1}, bay{{50, 50}, {60, 50}, {50, 60}, 10};
  std::vector<DxfLine> lines{drawn(50, 50, 60, 50), drawn(0, 0, 1, 0)};
  mark_door_leaves(lines, {door, door, bay});
  EXPECT_FALSE(lines[0].door_leaf);
  EXPECT_TRUE(lines[1].door_leaf);
}

TEST(DoorLeaves, ADoorDrawnAjarIsKnownByTheLeafThatHangsInItsArc) {
  const auto arc = [](double x, std::size_t first) {  // 0.3 radians of a circle of 0.9 about (x, 0)
    return DoorSwing{{x, 0}, {x + 0.9, 0}, {x + 0.9 * std::cos(0.3), 0.9 * std::sin(0.3)},
                     0.9,    first,        first + 1};
  };
  const DoorSwing door = arc(0, 0), bend = arc(10, 1);
  std::vector<DxfLine> lines{drawn(door.from.x, 0, door.to.x, door.to.y),
                             drawn(bend.from.x, 0, bend.to.x, bend.to.y), drawn(0, 0, door.to.x, door.to.y),
                             drawn(10, 0, 10, 5)};
  mark_doors_ajar(lines, {door, bend});
  EXPECT_TRUE(lines[0].door_leaf) << "the arc of the door";
  EXPECT_TRUE(lines[2].door_leaf) << "its leaf";
  EXPECT_FALSE(lines[1].door_leaf) << "a bent wall has no leaf";
  EXPECT_FALSE(lines[3].door_leaf);
}

/// A LINE of a DXF; `more`: further group codes.
std::string dxf_line(const std::string& layer, double x1, double y1, double x2, double y2,
                     const std::string& more = "") {
  std::ostringstream text;
  text << "0\nLINE\n8\n"
       << layer << "\n"
       << more << "10\n"
       << x1 << "\n20\n"
       << y1 << "\n11\n"
       << x2 << "\n21\n"
       << y2 << "\n";
  return text.str();
}

std::string dxf_section(const std::string& name, const std::string& content) {
  return "0\nSECTION\n2\n" + name + "\n" + content + "0\nENDSEC\n";
}

/// Walls and other lines of a DXF with these sections.
std::pair<std::size_t, std::size_t> walls_and_others(const std::string& sections,
                                                     const PlanOptions& options = {}) {
  const test::TemporaryFolder folder;
  const Plan plan = load_dxf(folder.write("drawn.dxf", sections + "0\nEOF\n"), options);
  return {plan.vectors->walls.size(), plan.vectors->rejected.size()};
}

using Counts = std::pair<std::size_t, std::size_t>;

TEST(LoadDxf, WhatIsSwitchedOffIsAWallOnlyWhereItsLayerIsNamed) {
  const auto layer = [](const std::string& name, const std::string& flags) {
    return "0\nLAYER\n2\n" + name + "\n" + flags + "6\nCONTINUOUS\n";
  };
  const std::string tables =
      dxf_section("TABLES", "0\nTABLE\n2\nLAYER\n70\n3\n" + layer("WALL", "70\n0\n62\n7\n") +
                                layer("WALL_OLD", "70\n0\n62\n-7\n") + layer("WALL_ICE", "70\n1\n62\n7\n") +
                                "0\nENDTAB\n");
  const std::string drawing =
      tables +
      dxf_section("ENTITIES", dxf_line("WALL", 0, 0, 20, 0) + dxf_line("WALL", 0, 0, 0, 10) +
                                  dxf_line("WALL_OLD", 0, 5, 20, 5) + dxf_line("WALL_ICE", 0, 6, 20, 6) +
                                  dxf_line("WALL", 0, 7, 20, 7, "60\n1\n"));
  EXPECT_EQ(walls_and_others(drawing), Counts(2, 3));
  PlanOptions options;
  options.layers = {"WALL_OLD"};
  EXPECT_EQ(walls_and_others(drawing, options), Counts(1, 4));
}

/// The sheet's frame lies beside the building, in another unit.
TEST(LoadDxf, ALayoutCountsOnlyWhereTheModelIsEmpty) {
  const std::string frame = dxf_line("WALL", 0, 0, 84, 0, "67\n1\n");
  const std::string room = dxf_line("WALL", 0, 0, 20, 0) + dxf_line("WALL", 0, 0, 0, 10);
  EXPECT_EQ(walls_and_others(dxf_section("ENTITIES", frame + room)), Counts(2, 0));
  EXPECT_EQ(walls_and_others(dxf_section("ENTITIES", frame)), Counts(1, 0));
}

/// A drawing of columns, beside `more` entities and these blocks.
Plan columns_and(const std::string& more, const std::string& blocks = "") {
  const test::TemporaryFolder folder;
  const std::string columns = dxf_line("A-COLS", 0, 0, 20, 0) + dxf_line("A-COLS", 0, 0, 0, 10);
  return load_dxf(folder.write("drawn.dxf", dxf_section("HEADER", "9\n$INSUNITS\n70\n6\n") +
                                                dxf_section("BLOCKS", blocks) +
                                                dxf_section("ENTITIES", columns + more) + "0\nEOF\n"),
                  {});
}

/// GDAL skips the walls of AutoCAD Architecture, solids and what was not bound, without a word.
TEST(LoadDxf, WhatIsNotReadIsNamed) {
  const std::string wall = "0\nAEC_WALL\n8\nA-WALL\n", solid = "0\n3DSOLID\n100\nAcDbEntity\n8\nA-WALL\n";
  EXPECT_THAT(
      columns_and(wall + solid + wall).left_out,
      ::testing::ElementsAre("1 3DSOLID was not read: explode them, or export to AutoCAD 2000 DXF",
                             "2 AEC_WALL were not read: explode them, or export to AutoCAD 2000 DXF"));
  const auto block = [](const std::string& flags, const std::string& content) {
    return "0\nBLOCK\n8\n0\n2\nPLAN\n70\n" + flags + "\n10\n0\n20\n0\n1\nC:\\plans\\ground.dwg\n" + content +
           "0\nENDBLK\n8\n0\n";
  };
  EXPECT_THAT(columns_and("", block("4", "")).left_out,
              ::testing::ElementsAre(HasSubstr("ground.dwg was not read: bind it")));
  EXPECT_THAT(columns_and("", block("0", "") + block("36", dxf_line("WALL", 0, 0, 1, 0))).left_out,
              ::testing::IsEmpty());
}

TEST(LoadDxf, ALayerThatSaysWallAndSomethingElseIsNamed) {
  const auto left_out = columns_and(dxf_line("Brandwand_Fensterband", 0, 5, 20, 5)).left_out;
  ASSERT_EQ(left_out.size(), 1U);
  EXPECT_THAT(left_out.front(), HasSubstr("the layer Brandwand_Fensterband (20 m of lines) was not taken"));
}

/// Files since R2007 are UTF-8 and name the code page of the computer all the same.
TEST(LoadDxf, LayerNamesAreReadInUtf8AndInTheCodePage) {
  const auto drawing = [](const std::string& wall, const std::string& machine) {
    return dxf_section("HEADER", "9\n$DWGCODEPAGE\n3\nANSI_932\n") +
           dxf_section("ENTITIES", dxf_line(wall, 0, 0, 20, 0) + dxf_line(machine, 0, 0, 0, 19));
  };
  EXPECT_EQ(walls_and_others(drawing("02_壁", "機械")), Counts(1, 1));
  EXPECT_EQ(walls_and_others(drawing("02_\x95\xC7", "\x8B@\x8A\x42")), Counts(1, 1));
}

TEST(LoadDxf, APolyfaceMeshHasLinesAndALeaderIsNoWall) {
  const auto vertex = [](const std::string& codes) { return "0\nVERTEX\n8\nWALL\n" + codes; };
  const std::string mesh =
      "0\nPOLYLINE\n100\nAcDbEntity\n8\nWALL\n100\nAcDbPolyFaceMesh\n66\n1\n70\n64\n71\n4\n72\n1\n" +
      vertex("10\n0\n20\n0\n30\n0\n70\n192\n") + vertex("10\n20\n20\n0\n30\n0\n70\n192\n") +
      vertex("10\n20\n20\n10\n30\n0\n70\n192\n") + vertex("10\n0\n20\n10\n30\n0\n70\n192\n") +
      vertex("10\n0\n20\n0\n30\n0\n70\n128\n71\n1\n72\n2\n73\n3\n74\n4\n") + "0\nSEQEND\n";
  const std::string leader =
      "0\nLEADER\n100\nAcDbEntity\n8\n0\n100\nAcDbLeader\n71\n0\n72\n0\n76\n2\n"
      "10\n0\n20\n0\n30\n0\n10\n5\n20\n5\n30\n0\n";
  EXPECT_EQ(walls_and_others(dxf_section("ENTITIES", mesh + leader)), Counts(4, 1));
}

/// On a layer without a telling name the leaf is no wall; one that its layer calls a wall stays.
TEST(LoadDxf, ADoorOnLayerZeroLosesItsLeaf) {
  const test::TemporaryFolder folder;
  const std::string arc =
      "0\nARC\n100\nAcDbEntity\n8\n0\n100\nAcDbCircle\n10\n5\n20\n0\n40\n0.9\n"
      "100\nAcDbArc\n50\n0\n51\n90\n";
  const std::string head = "0\nSECTION\n2\nENTITIES\n", tail = "0\nENDSEC\n0\nEOF\n";
  const std::string walls =
      dxf_line("0", 0, 0, 5, 0) + dxf_line("0", 5.9, 0, 12, 0) + dxf_line("0", 0, 0, 0, 9);
  const auto count = [&](const std::string& leaf) {
    return load_dxf(folder.write("door.dxf", head + walls + leaf + arc + tail), {}).vectors->walls.size();
  };
  EXPECT_EQ(count(dxf_line("0", 5, 0, 5, 0.9)), 3U);
  EXPECT_EQ(count(dxf_line("0", 5, 0, 5, 2.9)), 4U) << "a wall, longer than the door is wide";
  EXPECT_EQ(count(dxf_line("WALL", 5, 0, 5, 0.9)), 4U);
}

TEST(LoadDxf, ANamedUnitIsStrongerThanTheFile) {
  PlanOptions options;
  const double said = load_dxf(kFactory / "factory.dxf", options).m_per_px.value();
  options.unit = "cm";
  EXPECT_NEAR(load_dxf(kFactory / "factory.dxf", options).m_per_px.value(), 10.0 * said, 1e-9);
  EXPECT_FALSE(named_unit("furlong"));
}

TEST(LoadDxf, NamedLayersAreTakenAndUnknownOnesListed) {
  PlanOptions options;
  options.layers = {"COLUMNS"};
  EXPECT_EQ(load_dxf(kFactory / "factory.dxf", options).vectors->walls.size(), 15U * 4U);
  options.layers = {"WALL"};
  try {
    (void)load_dxf(kFactory / "factory.dxf", options);
    FAIL() << "an unknown layer was accepted";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("WALLS_HATCH"));
  }
}

TEST(LoadDxf, RubbishIsRefused) {
  const test::TemporaryFolder folder;
  EXPECT_THROW((void)load_dxf(folder.write("a.dxf", "no drawing at all"), {}), Error);
  EXPECT_THROW((void)load_dxf(folder.write("b.dxf", ""), {}), Error);
}

/// GDAL reads half a file without a word, and never ends on some with zero bytes.
TEST(LoadDxf, HalfAFileAndZeroBytesAreRefused) {
  const test::TemporaryFolder folder;
  std::ifstream stream(kFactory / "factory.dxf", std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_GT(whole.size(), 100'000U);
  const auto reason = [&](const std::string& text) -> std::string {
    try {
      (void)load_dxf(folder.write("a.dxf", text), {});
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_THAT(reason(whole.substr(0, whole.size() - 1000)), HasSubstr("cut off"));
  EXPECT_THAT(reason(whole.substr(0, 150'000) + '\0' + whole.substr(150'000)), HasSubstr("binary DXF"));
  EXPECT_EQ(reason(whole + "\r\n"), "");
}

/// Three plans from elsewhere: inches although the header says millimetres, an EXTMIN of 1e10, German layers.
TEST(LoadDxf, PlansFromElsewhereHaveTheirTrueSize) {
  const std::filesystem::path folder = std::filesystem::path(MADORI_SHARED_DATA) / "drawings/dxf";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no shared drawings at " << folder;
  const auto width_m = [&](const char* name) {
    const Plan plan = load_dxf(folder / name, {});
    return plan.picture.width_px * plan.m_per_px.value_or(0.0);
  };
  EXPECT_NEAR(width_m("floorplan.dxf"), 25.4, 0.1);
  EXPECT_NEAR(width_m("hal9k_floorplan.dxf"), 24.8, 0.1);
  EXPECT_NEAR(width_m("raumzeitlabor_olymp_floorplan.dxf"), 8.1, 0.1);
}

}  // namespace
}  // namespace madori::mapping
