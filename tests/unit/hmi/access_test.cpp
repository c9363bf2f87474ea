#include "hmi/server/access.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <iterator>

#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::hmi {
namespace {

using namespace std::chrono_literals;

class AccessTest : public testing::Test {
 protected:
  Access::Clock clock_ = [this] { return now_; };
  std::chrono::steady_clock::time_point now_{1000h};
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "pins";
};

TEST_F(AccessTest, LoopbackWithoutPinsIsOpenANetworkIsNot) {
  Access loopback(file_, false, clock_);
  EXPECT_EQ(loopback.role_of(""), Role::Integrator);
  Access network(file_, true, clock_);
  EXPECT_EQ(network.role_of(""), Role::None);
  EXPECT_TRUE(network.needs_pin());
}

TEST_F(AccessTest, APinOpensASessionOfItsRoleUntilItExpires) {
  Access access(file_, true, clock_);
  access.set_pin(Role::Operator, "4711");
  EXPECT_FALSE(access.login("4712", "a").token);
  const auto login = access.login("4711", "a");
  ASSERT_TRUE(login.token);
  EXPECT_EQ(access.role_of(*login.token), Role::Operator);
  EXPECT_EQ(access.role_of(*login.token + "0"), Role::None);
  now_ += Access::kSessionLife + 1s;
  EXPECT_EQ(access.role_of(*login.token), Role::None);
}

TEST_F(AccessTest, NoTokenIsGivenTwice) {
  Access access(file_, true, clock_);
  access.set_pin(Role::Operator, "4711");
  const auto first = access.login("4711", "a").token, second = access.login("4711", "a").token;
  ASSERT_TRUE(first && second);
  EXPECT_NE(*first, *second);
  EXPECT_NE(*first, std::string(first->size(), first->front())) << "nor can it be guessed";
  EXPECT_EQ(first->size(), 64U);
}

TEST_F(AccessTest, LoggingOutAndChangingThePinEndSessions) {
  Access access(file_, true, clock_);
  access.set_pin(Role::Viewer, "1234");
  const auto first = access.login("1234", "a");
  access.logout(*first.token);
  EXPECT_EQ(access.role_of(*first.token), Role::None);
  const auto second = access.login("1234", "a");
  access.set_pin(Role::Viewer, "5678");
  EXPECT_EQ(access.role_of(*second.token), Role::None);
}

TEST_F(AccessTest, GuessingIsSlowedDownForThatAddressOnly) {
  Access access(file_, true, clock_);
  access.set_pin(Role::Operator, "4711");
  for (int i = 0; i < Access::kTries; ++i) EXPECT_FALSE(access.login("0000", "thief").too_many_tries);
  EXPECT_TRUE(access.login("4711", "thief").too_many_tries);
  EXPECT_TRUE(access.login("4711", "operator").token);
  now_ += Access::kTryWindow + 1s;
  EXPECT_TRUE(access.login("4711", "thief").token);
}

/// 120 PINs from 40 addresses, then more for a day: few are even looked at; who was there before gets in.
TEST_F(AccessTest, GuessingFromManyAddressesIsSlowedDownAsAWhole) {
  Access access(file_, true, clock_);
  access.set_pin(Role::Operator, "4711");
  ASSERT_TRUE(access.login("4711", "tablet").token);
  int looked_at = 0;
  for (int i = 0; i < 120; ++i)
    looked_at += access.login("0000", "thief" + std::to_string(i % 40)).too_many_tries ? 0 : 1;
  EXPECT_EQ(looked_at, Access::kTriesOfAll);
  EXPECT_TRUE(access.login("4711", "new tablet").too_many_tries);
  EXPECT_TRUE(access.login("4711", "tablet").token);
  EXPECT_TRUE(access.login("4711", "127.0.0.1").token);
  for (int minute = 0; minute < 10; ++minute) {
    now_ += std::chrono::minutes(1);
    for (int i = 0; i < 10; ++i)
      looked_at += access.login("0000", "t" + std::to_string(10 * minute + i)).too_many_tries ? 0 : 1;
  }
  EXPECT_EQ(looked_at, Access::kTriesOfAll + 10);
  now_ += std::chrono::minutes(1);
  EXPECT_TRUE(access.login("4711", "new tablet").token);
}

TEST_F(AccessTest, PinsAreKeptHashedAndPrivate) {
  Access(file_, true, clock_).set_pin(Role::Integrator, "secret99");
  std::ifstream stream(file_);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(text.find("secret99"), std::string::npos);
  EXPECT_NE(text.find("$argon2id$"), std::string::npos);
  struct stat status {};
  ASSERT_EQ(::stat(file_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 077, 0U);
  Access again(file_, true, clock_);
  EXPECT_TRUE(again.login("secret99", "a").token);
}

TEST_F(AccessTest, BadPinsAndFilesAreRefused) {
  Access access(file_, true, clock_);
  EXPECT_THROW(access.set_pin(Role::Operator, "123"), Error);
  std::ofstream(file_) << "operator plain-text-pin\n";
  EXPECT_THROW(Access(file_, true, clock_), Error);
}

TEST_F(AccessTest, PinsThatCannotBeReadDoNotOpenThePanel) {
  std::filesystem::create_directory(file_);
  EXPECT_THROW(Access(file_, false, clock_), Error);
}

TEST_F(AccessTest, APinThatCannotBeWrittenIsNotTaken) {
  Access access(folder_.path() / "missing" / "pins", true, clock_);
  EXPECT_THROW(access.set_pin(Role::Operator, "4711"), Error);
  EXPECT_FALSE(access.login("4711", "a").token);
}

}  // namespace
}  // namespace madori::hmi
