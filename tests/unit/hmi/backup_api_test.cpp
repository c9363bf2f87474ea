// A backup downloaded and restored over the real socket: nothing of what was is lost, whatever is restored
// over it.
#include "mapping/site/atomic_file.hpp"
#include "mapping/site/site_versions.hpp"
#include "tests/unit/hmi/panel_fixture.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

class BackupApiTest : public PanelTest {
 protected:
  void SetUp() override {
    PanelTest::SetUp();
    const fs::path drawing = fs::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
    ASSERT_EQ(call("POST", "/api/site/drawing?name=hall.dxf", mapping::file_content(drawing)).status, 200);
    ASSERT_EQ(finished_job()["error"]["text"], "");
  }
  /// The walls without the last `count`, saved.
  void erase_walls(std::size_t count) {
    json walls = get("/api/site/walls");
    json left = json::array();
    for (std::size_t i = 0; i + count < walls["walls"].size(); ++i)
      left.push_back(
          {walls["walls"][i][0], walls["walls"][i][1], walls["walls"][i][2], walls["walls"][i][3]});
    const json edit{{"revision", walls["revision"]}, {"walls", left}};
    ASSERT_EQ(call("PUT", "/api/site/walls", edit.dump()).status, 200);
  }
  [[nodiscard]] std::vector<std::string> sentences() const {
    std::vector<std::string> all;
    for (const auto& version : mapping::site_versions(site())) all.push_back(version.sentence);
    return all;
  }
};

TEST_F(BackupApiTest, ABackupIsRestoredAndNoVersionIsLost) {
  const std::string backup = call("GET", "/api/site/download").body;
  const json then = get("/api/site/walls");
  erase_walls(1);
  const std::string later = call("GET", "/api/site/download").body;
  erase_walls(2);
  const auto before = mapping::site_versions(site());
  mapping::write_new_file(site() / "reliability.csv", "of another state of the site\n");

  ASSERT_EQ(call("POST", "/api/site/backup", backup).status, 200);
  EXPECT_EQ(get("/api/site/walls")["walls"], then["walls"]);
  EXPECT_FALSE(fs::exists(site() / "reliability.csv")) << "the backup had none";
  const auto after = mapping::site_versions(site());
  ASSERT_EQ(after.size(), before.size() + 1) << "the backup's versions are the site's own";
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(after[i].files, before[i].files);
  EXPECT_EQ(after.back().sentence, "backup restored");

  // Into an empty folder its versions come along, each once, also when it is restored twice.
  fs::remove_all(site());
  ASSERT_EQ(call("POST", "/api/site/backup", backup).status, 200);
  EXPECT_EQ(sentences(), (std::vector<std::string>{"drawing, walls"}));
  ASSERT_EQ(call("POST", "/api/site/backup", later).status, 200);
  EXPECT_EQ(sentences(), (std::vector<std::string>{"drawing, walls", "walls", "backup restored"}));
}

TEST_F(BackupApiTest, ADamagedVersionIsNotCompared) {
  erase_walls(1);
  EXPECT_EQ(get("/api/site/versions/1/against/2")["gone"].size(), 1U);
  const std::string walls = mapping::site_version(site(), 2).files.at("walls.csv");
  mapping::write_new_file(site() / "versions/objects" / walls, "x1_m,y1_m,x2_m,y2_m\n0,0,1,0\n");
  const auto refused = call("GET", "/api/site/versions/1/against/2", "");
  EXPECT_EQ(refused.status, 422);
  EXPECT_NE(refused.body.find("version 2 lost its walls.csv, or it is damaged"), std::string::npos);
}

TEST_F(BackupApiTest, WhatIsNoBackupChangesNothing) {
  const std::string backup = call("GET", "/api/site/download").body;
  const json site_before = get("/api/site/walls");
  for (const std::string& body :
       {std::string("no tar"), backup.substr(0, backup.size() / 2), std::string()}) {
    const auto refused = call("POST", "/api/site/backup", body);
    EXPECT_EQ(refused.status, 422) << refused.body;
    EXPECT_NE(refused.body.find("the backup: is no whole backup"), std::string::npos) << refused.body;
  }
  EXPECT_EQ(get("/api/site/walls"), site_before);
  vehicle_.drive(true);
  EXPECT_EQ(call("POST", "/api/site/backup", backup).status, 409);
}

}  // namespace
}  // namespace madori::hmi
