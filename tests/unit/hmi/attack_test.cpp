// What an attacker on the network would try, over real sockets. tests/bench/bench_panel measures that the
// vehicle's cycle does not feel it.
#include <gmock/gmock.h>

#include <algorithm>

#include "tests/support/panel_attacks.hpp"
#include "tests/unit/hmi/panel_fixture.hpp"

namespace madori::hmi {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

using AttackTest = PanelTest;

TEST_F(AttackTest, NoPathLeavesThePage) {
  access_.set_pin(Role::Viewer, "a secret");  // so that there is something to steal
  for (const auto& path : test::climbing_paths()) {
    const auto answer = call("GET", path);
    EXPECT_TRUE(answer.status == 0 || answer.status >= 400) << path << ": " << answer.status;
    EXPECT_THAT(answer.body, ::testing::Not(HasSubstr("argon2"))) << path;
    EXPECT_THAT(answer.body, ::testing::Not(HasSubstr("root:"))) << path;
  }
}

TEST_F(AttackTest, AGigabyteIsRefusedBeforeItHasArrived) {
  constexpr std::size_t kGigabyte = 1U << 30U;
  const auto announced = test::upload_for_ever(server_->port(), kGigabyte, false);
  EXPECT_THAT(announced.answer, HasSubstr("413"));
  EXPECT_LT(announced.sent_bytes, 32U << 20U);  // what the sockets' buffers took
  const auto unannounced = test::upload_for_ever(server_->port(), kGigabyte, true);
  EXPECT_LT(unannounced.sent_bytes, 320U << 20U);  // a drawing may have 256 MB
  EXPECT_EQ(call("GET", "/api/session").status, 200);
}

TEST_F(AttackTest, ADrawingIsNotEvenTakenWhileTheVehicleDrives) {
  vehicle_.drive(true);
  const auto outcome = test::upload_for_ever(server_->port(), 200U << 20U, false);
  EXPECT_THAT(outcome.answer, HasSubstr("409"));
  EXPECT_LT(outcome.sent_bytes, 32U << 20U);
}

TEST_F(AttackTest, AThousandHalfOpenSocketsAreDroppedAndAPanelStillGetsIn) {
  test::NeglectedSockets silent(server_->port(), 1000, "");
  EXPECT_EQ(call("GET", "/api/session").status, 200);
  EXPECT_EQ(call("POST", "/api/vehicle/stop", "{}").status, 200);
  while (silent.open() > 0) std::this_thread::yield();  // the test's own limit ends this
}

TEST_F(AttackTest, SlowLorisIsDroppedHoweverItDrips) {
  test::NeglectedSockets slow(server_->port(), 200, "GET /api/session HTTP/1.1\r\nHost: 127.0.0.1\r\nX: ");
  while (slow.drip('a') > 0) std::this_thread::yield();
  EXPECT_EQ(slow.open(), 0U);
  EXPECT_EQ(call("GET", "/api/session").status, 200);
}

TEST_F(AttackTest, BadFramesCloseTheirSocketAndMoveNothing) {
  for (const auto& frames : test::bad_frames())
    EXPECT_TRUE(test::closes_on_frames(server_->port(), frames))
        << testing::PrintToString(frames.substr(0, 20));
  EXPECT_TRUE(vehicle_.commands().empty());
  EXPECT_TRUE(std::ranges::all_of(vehicle_.jogs(), [](const auto& j) { return j == VelocityCommand{}; }));
  test::LiveClient panel(server_->port(), "same");
  EXPECT_THAT(panel.receive_text(), HasSubstr("live"));
}

TEST_F(AttackTest, MalformedJsonIsRefused) {
  for (const std::string& body : test::bad_orders()) {
    const auto answer = call("POST", "/api/orders", body);
    EXPECT_TRUE(answer.status == 400 || answer.status == 422) << answer.status << " " << body.substr(0, 40);
  }
  EXPECT_TRUE(vehicle_.orders().empty());
}

class NetworkAttackTest : public PanelTest {
 protected:
  NetworkAttackTest() : PanelTest(true) { access_.set_pin(Role::Viewer, "0000"); }
};

TEST_F(NetworkAttackTest, StrangersMaySendNoMoreThanAPin) {
  const auto answer = call("POST", "/api/session", std::string(100'000, 'x'));
  EXPECT_TRUE(answer.status == 413 || answer.status == 0) << answer.status;
  EXPECT_EQ(test::upload_for_ever(server_->port(), 1U << 30U, false).answer.find(" 200"), std::string::npos);
}

TEST_F(NetworkAttackTest, AViewerCommandsNothing) {
  const auto login = call("POST", "/api/session", R"({"pin": "0000"})");
  ASSERT_EQ(login.status, 200);
  for (const char* path : {"/api/vehicle/start", "/api/vehicle/stop", "/api/orders", "/api/vehicle/pose",
                           "/api/locate/search", "/api/site/drawing?name=a.png", "/api/site/scale"})
    EXPECT_EQ(call("POST", path, "{}", login.cookie).status, 403) << path;
  EXPECT_EQ(call("POST", "/api/vehicle/halt", "{}").status, 200) << "to stand is always allowed";
  for (const char* path : {"/api/site/walls", "/api/site/routes", "/api/site/vehicle", "/api/orders/queue"})
    EXPECT_EQ(call("PUT", path, "{}", login.cookie).status, 403) << path;
  test::LiveClient panel(server_->port(), "same", login.cookie);
  panel.send(R"({"jog": {"linear": 0.3, "angular": 0}})");
  std::string message;
  while (message.find("refused") == std::string::npos) message = panel.receive_text();
  EXPECT_THAT(message, HasSubstr("not-allowed"));
  EXPECT_TRUE(vehicle_.jogs().empty());
}

}  // namespace
}  // namespace madori::hmi
