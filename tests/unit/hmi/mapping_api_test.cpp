// A map by driving and taught routes, over the real socket.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/unit/hmi/panel_fixture.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;

class MappingApiTest : public PanelTest {
 protected:
  [[nodiscard]] json start() const {
    const json now = get("/api/mapping");
    return {
        {"vehicle", now["vehicle"]}, {"sensors", json::array({now["kinds"][0]["sensor"]})}, {"anew", true}};
  }
  static std::vector<planning::DrivenPose> corner() {
    std::vector<planning::DrivenPose> way;
    for (int i = 0; i <= 100; ++i)
      planning::note_way(way, stamp_from_seconds(i),
                         {0.05 + std::min(i, 50) * 0.1, 0.05 + std::max(0, i - 50) * 0.1, 0.0});
    return way;
  }
};

TEST_F(MappingApiTest, BeginsGrowsAndIsGivenUp) {
  EXPECT_EQ(get("/api/mapping")["state"], "none");
  EXPECT_EQ(call("GET", "/api/mapping/points").status, 404);
  EXPECT_EQ(call("POST", "/api/mapping/finish", "{}").status, 409);
  json wanted = start();
  wanted["vehicle"]["length_m"] = 1.4;
  EXPECT_EQ(call("POST", "/api/mapping", wanted.dump()).status, 200);
  EXPECT_EQ(vehicle_.mapping_length_m(), 1.4);
  const json mapping = get("/api/mapping");
  EXPECT_EQ(mapping["state"], "mapping");
  EXPECT_EQ(mapping["sensors"][0]["type"], "vlp16");
  EXPECT_EQ(mapping["walls"].size(), 1U);
  EXPECT_EQ(call("GET", "/api/mapping/points").body, "MDS2");
  EXPECT_EQ(call("DELETE", "/api/mapping").status, 200);
  EXPECT_EQ(get("/api/mapping")["state"], "none");
}

TEST_F(MappingApiTest, ARequestOfTheWrongShapeIsRefused) {
  for (const char* body : {"{}", R"({"vehicle": {}, "sensors": [], "anew": true})"})
    EXPECT_EQ(call("POST", "/api/mapping", body).status, 400) << body;
  for (const char* body : {"[]", "no json"})
    EXPECT_EQ(call("POST", "/api/mapping", body).status, 422) << body;
  EXPECT_EQ(get("/api/mapping")["state"], "none");
}

TEST_F(MappingApiTest, FinishingIsAJobThatSaysWhyItFailed) {
  EXPECT_EQ(call("POST", "/api/mapping", start().dump()).status, 200);
  EXPECT_EQ(call("POST", "/api/mapping/finish", "{}").status, 200);
  const json failed = finished_job();
  EXPECT_EQ(failed["error"]["values"]["kind"], "mapping-too-short");
  EXPECT_EQ(vehicle_.reloads(), 0);
  vehicle_.drive_way(corner());
  EXPECT_EQ(call("POST", "/api/mapping/finish", "{}").status, 200);
  EXPECT_EQ(finished_job()["error"]["text"], "");
  EXPECT_EQ(vehicle_.reloads(), 1);
}

TEST_F(MappingApiTest, TheWayDrivenIsTaughtAsADraft) {
  const json none{{"revision", ""}, {"nodes", json::array()}, {"legs", json::array()}};
  EXPECT_EQ(get("/api/site/routes/driven")["length_m"], 0.0);
  EXPECT_EQ(call("POST", "/api/site/routes/taught", none.dump()).status, 422);  // nothing was driven
  vehicle_.drive_way(corner());
  EXPECT_NEAR(get("/api/site/routes/driven")["length_m"].get<double>(), 10.0, 0.01);
  const auto answer = call("POST", "/api/site/routes/taught", none.dump());
  ASSERT_EQ(answer.status, 200);
  const json taught = json::parse(answer.body);
  EXPECT_EQ(taught["nodes"].size(), 3U);
  EXPECT_EQ(taught["legs"].size(), 4U);
  EXPECT_EQ(get("/api/site/routes")["nodes"].size(), 0U);  // nothing is saved
  // taught once more on top of itself: the same
  const json again =
      json::parse(call("POST", "/api/site/routes/taught",
                       json{{"revision", ""}, {"nodes", taught["nodes"]}, {"legs", taught["legs"]}}.dump())
                      .body);
  EXPECT_EQ(again["nodes"], taught["nodes"]);
}

}  // namespace
}  // namespace madori::hmi
