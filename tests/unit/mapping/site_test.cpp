#include "mapping/site/site.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::mapping {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

std::string error_of(const std::string& yaml) {
  const TemporaryFolder folder;
  folder.write("site.yaml", yaml);
  try {
    (void)load_site(folder.path());
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

constexpr const char* kMinimal =
    "madori_site: 1\nname: hall\ndrawing: {file: a.png, width_px: 10, height_px: 5}\n";

TEST(Site, SurvivesSavingAndLoading) {
  const TemporaryFolder folder;
  Site site;
  site.name = "hall 3: east";
  site.drawing = {"drawing.png", 3047, 1717, 2, 300.0};
  site.scale = ScaleRecord{0.00846, "known", 0.002, 0.01, "2026-01-02T03:04:05Z", {"1,2,3,4=5.0"}, {0.001}};
  site.georeference = GeoreferenceRecord{35.464478, 136.739235, -12.5};
  site.sensors.push_back({"roof", "vlp16", 0.1, 0.0, 1.2, 90.0});
  site.sensors.push_back({"front", "s300", 0.7, 0.0, 0.2, 0.0, 0.65});
  save_site(folder.path(), site);
  const Site loaded = load_site(folder.path());
  EXPECT_EQ(site_yaml(loaded), site_yaml(site));
  EXPECT_DOUBLE_EQ(loaded.scale->m_per_px, 0.00846);
  EXPECT_EQ(loaded.scale->residuals_m, std::vector<double>{0.001});
  EXPECT_DOUBLE_EQ(loaded.sensors.at(1).protective_m, 0.65);
}

TEST(Site, EveryNumberOfTheVehicleComesBackAndIsRefusedOutOfRange) {
  const TemporaryFolder folder;
  Site site;
  site.name = "hall";
  site.drawing = {"a.png", 10, 5, 1, 0.0};
  double share = 0.3;
  for (const VehicleField& field : kVehicleFields)
    site.vehicle.*field.value = field.least + (share += 0.01) * (std::min(field.most, 2.0) - field.least);
  site.vehicle.length_m = 2.0;
  site.shortest_routes = true;
  save_site(folder.path(), site);
  const Site loaded = load_site(folder.path());
  EXPECT_TRUE(loaded.shortest_routes);
  for (const VehicleField& field : kVehicleFields) {
    EXPECT_EQ(loaded.vehicle.*field.value, site.vehicle.*field.value) << field.name;
    for (const double bad : {field.least - 0.01, field.most + 0.01})
      EXPECT_THAT(
          error_of(std::string(kMinimal) + "vehicle: {" + field.name + ": " + std::to_string(bad) + "}\n"),
          HasSubstr(field.name));
  }
  EXPECT_THAT(error_of(std::string(kMinimal) + "vehicle: {length_m: 1, base_to_rear_m: 1.1}\n"),
              HasSubstr("base_to_rear_m"));
  EXPECT_THAT(error_of(std::string(kMinimal) + "route_metric: best\n"), HasSubstr("hops"));
}

TEST(Site, RefusesUnknownKeysWithTheirLine) {
  EXPECT_THAT(error_of(std::string(kMinimal) + "scael: 3\n"), HasSubstr("site.yaml:4: scael"));
}

TEST(Site, RefusesValuesOutOfRange) {
  EXPECT_THAT(error_of(std::string(kMinimal) + "scale: {m_per_px: -1, method: option}\n"),
              HasSubstr("scale.m_per_px"));
  EXPECT_THAT(error_of(std::string(kMinimal) + "scale: {m_per_px: .nan, method: option}\n"),
              HasSubstr("m_per_px"));
}

TEST(Site, RefusesListsAndMappingsOfOtherThings) {
  const std::string site = kMinimal, scale = site + "scale: {m_per_px: 1, method: option, ";
  EXPECT_THAT(error_of(scale + "inputs: [a, [b]]}\n"), HasSubstr("scale.inputs: is not a list of texts"));
  EXPECT_THAT(error_of(scale + "inputs: a}\n"), HasSubstr("scale.inputs"));
  EXPECT_THAT(error_of(scale + "residuals_m: [a]}\n"), HasSubstr("scale.residuals_m"));
  EXPECT_THAT(error_of(site + "sensors: [{name: a, type: vlp16, settings: [b]}]\n"), HasSubstr("settings"));
  EXPECT_THAT(error_of(site + "? [a, b]\n: 1\n"), HasSubstr("no plain word"));
}

TEST(Site, RefusesADrawingOutsideItsFolder) {
  for (const char* file : {"/etc/hostname", "../other/drawing.png", "..", "plans/a.png", "''"}) {
    const std::string said = error_of(std::string("madori_site: 1\nname: hall\ndrawing: {file: ") + file +
                                      ", width_px: 10, height_px: 5}\n");
    EXPECT_THAT(said, HasSubstr("site.yaml:3: drawing.file")) << file;
  }
}

TEST(Site, RefusesASecondDocumentThatNobodyWouldRead) {
  EXPECT_THAT(error_of(std::string(kMinimal) + "---\nroute_metric: metres\n"),
              HasSubstr("site.yaml:5: begins a second document"));
  EXPECT_EQ(error_of(std::string("---\n") + kMinimal + "...\n"), "");
}

TEST(Site, EndsAtAStrayComma) {  // on which YAML::LoadAll never ends
  for (const std::string before : {"", kMinimal, "---\n", "...\n"})
    for (const std::string stray : {",", ", ", "\n,\n", ",,", ", a: 1"})
      EXPECT_THAT(error_of(before + stray), HasSubstr("site.yaml:")) << before + stray;
}

TEST(Site, RefusesASizeThatNoBuildingHas) {
  for (const char* scale : {"1e-300", "5.6e-10", "0.0001", "100000"})
    EXPECT_THAT(error_of("madori_site: 1\nname: hall\ndrawing: {file: a.png, width_px: 1000, height_px: 5}\n"
                         "scale: {m_per_px: " +
                         std::string(scale) + ", method: option}\n"),
                HasSubstr("m_per_px"))
        << scale;
}

TEST(Site, SaysHowToScaleAnUnscaledSite) {
  const TemporaryFolder folder;
  folder.write("site.yaml", kMinimal);
  EXPECT_NO_THROW((void)load_site(folder.path()));
  try {
    (void)load_scaled_site(folder.path());
    FAIL() << "an unscaled site was accepted";
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("madori scale"));
  }
}

TEST(Site, SaysThatAFolderIsNoSite) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)load_site(folder.path()), Error);
}

}  // namespace
}  // namespace madori::mapping
