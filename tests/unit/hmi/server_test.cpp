// The server through its real socket.
#include "hmi/server/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "hmi/server/scan_frame.hpp"
#include "mapping/drawing/import_drawing.hpp"
#include "tests/unit/hmi/panel_fixture.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
using test::HttpAnswer;
using test::HttpCall;
using ::testing::HasSubstr;

/// With the sample factory's drawing as the site.
class ServerTest : public PanelTest {
 protected:
  explicit ServerTest(bool network = false) : PanelTest(network) {}
  void SetUp() override {
    mapping::ImportOptions options;
    options.drawing = std::filesystem::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
    options.site = site();
    mapping::import_drawing(options);
    PanelTest::SetUp();
  }
};

TEST_F(ServerTest, ServesThePageAndNothingBesideIt) {
  EXPECT_THAT(call("GET", "/").body, HasSubstr("Madori"));
  for (const char* path :
       {"/pins", "/site/site.yaml", "/../pins", "/%2e%2e/pins", "/etc/passwd", "//etc/passwd"})
    EXPECT_GE(call("GET", path).status, 400) << path;
}

TEST_F(ServerTest, RefusesForeignHostsAndOrigins) {
  const auto port = server_->port();
  EXPECT_EQ(test::http_call(port, {"GET", "/api/site", "", "evil.example", "", ""}).status, 421);
  EXPECT_EQ(test::http_call(port, {"POST", "/api/vehicle/start", "{}", "", "http://evil.example", ""}).status,
            403);
  EXPECT_EQ(test::http_call(port, {"POST", "/api/vehicle/start", "{}", "", "", ""}).status, 403);
  EXPECT_TRUE(vehicle_.commands().empty());
  EXPECT_THROW(test::LiveClient(port, "http://evil.example"), std::exception);
  EXPECT_THROW(test::LiveClient(port, ""), std::exception);
}

TEST_F(ServerTest, CommandsAreDoneOrRefusedWithTheReason) {
  EXPECT_EQ(call("POST", "/api/vehicle/stop", "{}").status, 200);
  vehicle_.refuse_start();
  const HttpAnswer refused = call("POST", "/api/vehicle/start", "{}");
  EXPECT_EQ(refused.status, 409);
  EXPECT_EQ(json::parse(refused.body)["error"]["code"], "lost");
  EXPECT_EQ(vehicle_.commands(), (std::vector<Command>{Command::Stop, Command::Start}));
}

TEST_F(ServerTest, OrdersAreAddedMovedAndCancelled) {
  EXPECT_EQ(call("POST", "/api/orders", R"({"stations": [3, 5], "repeat": 1})").status, 200);
  EXPECT_EQ(call("POST", "/api/orders", R"({"stations": [7], "repeat": 5})").status, 200);
  EXPECT_EQ(get("/api/orders")[1]["repeat"], 5);
  EXPECT_EQ(call("PUT", "/api/orders/queue", R"({"ids": [2, 1]})").status, 200);
  EXPECT_EQ(get("/api/orders")[0]["stations"], json::array({7}));
  EXPECT_EQ(call("PUT", "/api/orders/queue", R"({"ids": [2]})").status, 409);
  EXPECT_EQ(call("POST", "/api/orders/2/repeat", "{}").status, 200);
  EXPECT_EQ(call("DELETE", "/api/orders/3").status, 200);
  EXPECT_EQ(call("DELETE", "/api/orders/2").status, 200);
  EXPECT_EQ(call("DELETE", "/api/orders/2").status, 409);
  EXPECT_EQ(call("DELETE", "/api/orders/x").status, 422);
  EXPECT_EQ(call("POST", "/api/orders", R"({"stations": "all"})").status, 400);
  EXPECT_EQ(call("POST", "/api/orders", "[1").status, 422);
}

TEST_F(ServerTest, WallsAreSavedOnceAndTheSecondEditorIsTold) {
  const json before = get("/api/site/walls");
  json edit{{"revision", before["revision"]}, {"walls", json::array({{0, 0, 10, 0}, {10, 0, 10, 5}})}};
  EXPECT_EQ(call("PUT", "/api/site/walls", edit.dump()).status, 200);
  EXPECT_EQ(get("/api/site/walls")["walls"].size(), 2U);
  EXPECT_EQ(vehicle_.reloads(), 1);
  const HttpAnswer late = call("PUT", "/api/site/walls", edit.dump());
  EXPECT_EQ(late.status, 409);
  EXPECT_EQ(json::parse(late.body)["error"]["code"], "conflict");
  edit["revision"] = get("/api/site/walls")["revision"];
  edit["walls"] = json::array();
  EXPECT_EQ(call("PUT", "/api/site/walls", edit.dump()).status, 422);
}

TEST_F(ServerTest, PublishedRoutesRoundTripByteForByte) {
  const std::string tree = "ID,EDA\r\n0,1\r\n1,0 2\r\n2,1\r\n";
  const std::string path = "ID,x,y\r\n0,0,0\r\n1,1.8,-0.1\r\n2,5.46,-0.61\r\n";
  EXPECT_EQ(
      call("POST", "/api/site/routes/csv", json{{"revision", ""}, {"tree", tree}, {"path", path}}.dump())
          .status,
      200);
  EXPECT_EQ(call("GET", "/api/site/routes/tree.csv").body, tree);
  EXPECT_EQ(call("GET", "/api/site/routes/path.csv").body, path);
  const HttpAnswer bad = call("POST", "/api/site/routes/csv",
                              json{{"revision", ""}, {"tree", "ID,EDA\n0,7\n"}, {"path", path}}.dump());
  EXPECT_EQ(bad.status, 422);
  EXPECT_THAT(bad.body, HasSubstr("tree.csv"));
}

TEST_F(ServerTest, DrawnRoutesAreCheckedAndSaved) {
  json edit{{"revision", get("/api/site/routes")["revision"]},
            {"nodes", json::array()},
            {"legs", json::array({{0, 1}, {1, 0}})}};
  for (int id : {0, 1})
    edit["nodes"].push_back({{"id", id},
                             {"x", 30.0 + 4 * id},
                             {"y", 29.0},
                             {"name", "P" + std::to_string(id)},
                             {"station", true},
                             {"heading_deg", 90.0},
                             {"speed_mps", nullptr},
                             {"action", ""}});
  EXPECT_EQ(call("POST", "/api/site/routes/check", edit.dump()).status, 200);
  EXPECT_EQ(call("PUT", "/api/site/routes", edit.dump()).status, 200);
  const json saved = get("/api/site/routes");
  EXPECT_EQ(saved["nodes"], edit["nodes"]);
  EXPECT_EQ(saved["legs"], edit["legs"]);
  edit["legs"] = json::array({{0, 9}});
  EXPECT_EQ(call("POST", "/api/site/routes/check", edit.dump()).status, 422);
}

TEST_F(ServerTest, LiveSendsStateAndScan) {
  LiveState live;
  live.state = "driving";
  const std::vector<Point2<Base>> scan{{1.5, -2.25}, {3.0, 4.0}};
  live.scan = std::make_shared<const std::string>(scan_frame(scan, {10.0, 20.0, 0.5}));
  vehicle_.show(live);
  test::LiveClient client(server_->port(), "same");
  json state;
  do state = json::parse(client.receive_text())["live"];
  while (state["state"] != "driving");
  EXPECT_EQ(state["locked"]["code"], "");
  EXPECT_EQ(state["revisions"]["walls"], get("/api/site")["walls_revision"]);
  EXPECT_EQ(client.receive_binary(), *live.scan);
}

TEST_F(ServerTest, APanelIsToldWhatOthersEditUntilTheyLeave) {
  const auto editors = [](test::LiveClient& client) {
    return json::parse(client.receive_text())["live"]["editors"];
  };
  test::LiveClient first(server_->port(), "same");
  first.send(R"({"editing": "walls"})");
  {
    test::LiveClient second(server_->port(), "same");
    while (editors(second) != json::array({"walls"})) {
    }
    second.send(R"({"editing": "routes"})");
    while (editors(first) != json::array({"routes"})) {
    }
    second.drop();
  }
  while (editors(first) != json::array()) {
  }
}

TEST_F(ServerTest, AJogEndsWhenTheBrowserFallsSilentOrVanishes) {
  for (const bool vanish : {false, true}) {
    test::LiveClient client(server_->port(), "same");
    vehicle_.forget();
    client.send(R"({"jog": {"linear": 0.3, "angular": 0}})");
    while (std::ranges::count(vehicle_.jogs(), VelocityCommand{0.3, 0.0}) == 0) std::this_thread::yield();
    if (vanish) client.drop();
    while (vehicle_.jogs().back() != VelocityCommand{}) std::this_thread::yield();
    if (!vanish) {
      EXPECT_EQ(vehicle_.silences(), 1) << "a silent browser has not let the button go";
    }
  }
}

TEST_F(ServerTest, ADrawingIsNotTakenOverWhenTheVehicleHasDrivenOffMeanwhile) {
  std::ifstream file(std::filesystem::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf");
  const std::string dxf{std::istreambuf_iterator<char>(file), {}};
  const json before = get("/api/site");
  vehicle_.drive_when([this] { return job_.state()["stage"] == "commit"; });
  ASSERT_EQ(call("POST", "/api/site/drawing?name=other.dxf", dxf).status, 200);
  const json job = finished_job();
  EXPECT_EQ(job["error"]["values"]["kind"], "driving");
  EXPECT_EQ(get("/api/site"), before);
  EXPECT_EQ(vehicle_.reloads(), 0);
}

TEST_F(ServerTest, NonsenseOnTheLiveSocketIsToldAndMovesNothing) {
  test::LiveClient client(server_->port(), "same");
  client.send("{\"jog\": {\"linear\": 99, \"angular\": 0}}");
  std::string refused;
  while (refused.find("refused") == std::string::npos) refused = client.receive_text();
  EXPECT_THAT(refused, HasSubstr("bad-message"));
  EXPECT_TRUE(vehicle_.jogs().empty());
}

TEST_F(ServerTest, BrokenHttpIsDropped) {
  for (const char* bytes :
       {"\r\n\r\n", "GET / HTTP/9.9\r\n\r\n", "GARBAGE\r\n\r\n", "GET /\0 HTTP/1.1\r\n\r\n"})
    EXPECT_EQ(test::raw_call(server_->port(), bytes).find("HTTP/1.1 200"), std::string::npos) << bytes;
  std::string huge = "GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ";
  huge.append(100'000, 'x');
  EXPECT_EQ(test::raw_call(server_->port(), huge).find("HTTP/1.1 200"), std::string::npos);
  EXPECT_EQ(call("GET", "/api/site").status, 200);
}

TEST_F(ServerTest, AnUploadThatIsTooLargeIsRefusedBeforeItIsRead) {
  const std::string header =
      "POST /api/site/drawing?name=a.png HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: "
      "http://127.0.0.1\r\nContent-Length: 1073741824\r\n\r\n";
  EXPECT_THAT(test::raw_call(server_->port(), header), HasSubstr("HTTP/1.1 413"));
}

TEST_F(ServerTest, ADrawingIsImportedWhileThePanelWatches) {
  const auto file = std::filesystem::path(MADORI_SOURCE_DIR) / "data/sample_factory/factory.dxf";
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), {}};
  ASSERT_EQ(call("POST", "/api/site/drawing?name=..%2Fhall%20B.dxf", content).status, 200);
  const json done = finished_job();
  EXPECT_EQ(done["error"]["text"], "");
  EXPECT_GT(done["report"]["walls"], 100);
  EXPECT_EQ(get("/api/site")["name"], "hall B");
  ASSERT_EQ(call("POST", "/api/site/drawing?name=bad.png", "no image").status, 200);
  EXPECT_EQ(finished_job()["error"]["code"], "job-failed");
  EXPECT_EQ(get("/api/site")["name"], "hall B");
}

class NetworkServerTest : public ServerTest {
 protected:
  NetworkServerTest() : ServerTest(true) {
    access_.set_pin(Role::Operator, "1111");
    access_.set_pin(Role::Integrator, "2222");
  }
};

TEST_F(NetworkServerTest, WithoutAPinNothingButThePageIsServed) {
  EXPECT_EQ(call("GET", "/").status, 200);
  for (const char* path : {"/api/site", "/api/orders", "/api/site/walls", "/api/recordings", "/api/events"})
    EXPECT_EQ(call("GET", path).status, 401) << path;
  EXPECT_EQ(call("POST", "/api/vehicle/start", "{}").status, 401);
  EXPECT_THROW(test::LiveClient(server_->port(), "same"), std::exception);
}

TEST_F(NetworkServerTest, RolesOpenWhatTheyMay) {
  EXPECT_EQ(call("POST", "/api/session", R"({"pin": "9999"})").status, 401);
  EXPECT_EQ(call("POST", "/api/session", R"({"pin": 9999})").status, 400);
  const HttpAnswer login = call("POST", "/api/session", R"({"pin": "1111"})");
  ASSERT_EQ(login.status, 200);
  EXPECT_EQ(json::parse(login.body)["role"], "operator");
  EXPECT_EQ(call("POST", "/api/vehicle/start", "{}", login.cookie).status, 200);
  EXPECT_EQ(call("PUT", "/api/site/walls", "{}", login.cookie).status, 403);
  EXPECT_EQ(call("DELETE", "/api/session", "", login.cookie).status, 200);
  EXPECT_EQ(call("GET", "/api/site", "", login.cookie).status, 401);
}

TEST_F(NetworkServerTest, ATabletThatIsLoggedOutDrivesNoLonger) {
  const HttpAnswer login = call("POST", "/api/session", R"({"pin": "1111"})");
  test::LiveClient tablet(server_->port(), "same", login.cookie);
  tablet.send(R"({"jog": {"linear": 0.3, "angular": 0}})");
  while (vehicle_.jogs().empty()) std::this_thread::yield();
  EXPECT_EQ(call("DELETE", "/api/session", "", login.cookie).status, 200);
  EXPECT_THROW(
      while (true) {
        tablet.send(R"({"jog": {"linear": 0.2, "angular": 0}})");
        (void)tablet.receive_text();
      },
      std::exception);
  while (vehicle_.jogs().back() != VelocityCommand{}) std::this_thread::yield();
  EXPECT_EQ(std::ranges::count(vehicle_.jogs(), VelocityCommand{0.2, 0.0}), 0);
}

}  // namespace
}  // namespace madori::hmi
