// Who drives by hand, and what a Stop asks of those whose buttons are held.
#include "app/panel/jog_holds.hpp"

#include <gtest/gtest.h>

#include <chrono>

namespace madori::app {
namespace {

class JogHoldsTest : public testing::Test {
 protected:
  using Answer = JogHolds::Answer;
  Answer hold(const int& who) { return holds_.hold(&who, now_); }

  JogHolds holds_;
  int first_ = 0, second_ = 0;
  Stamp now_ = stamp_from_seconds(1'700'000'000.0);
};

TEST_F(JogHoldsTest, AfterStopEachHeldButtonStaysBarredUntilItIsLetGoHoweverLongItIsSilent) {
  EXPECT_EQ(hold(first_), Answer::Drives);
  EXPECT_EQ(hold(second_), Answer::Taken);
  holds_.stop();
  EXPECT_FALSE(holds_.is_held(now_));
  now_ += std::chrono::minutes(10);
  EXPECT_EQ(hold(first_), Answer::Stopped);
  EXPECT_EQ(hold(second_), Answer::Stopped);
  EXPECT_FALSE(holds_.let_go(&second_)) << "it did not have the vehicle";
  EXPECT_EQ(hold(first_), Answer::Stopped);
  EXPECT_EQ(hold(second_), Answer::Drives);
  holds_.let_go(&second_);
  holds_.let_go(&first_);
  EXPECT_EQ(hold(first_), Answer::Drives);
}

TEST_F(JogHoldsTest, TheFirstHasTheVehicleUntilItLetsGoOrFallsSilent) {
  EXPECT_EQ(hold(first_), Answer::Drives);
  EXPECT_TRUE(holds_.has(&first_));
  EXPECT_EQ(hold(second_), Answer::Taken);
  EXPECT_TRUE(holds_.let_go(&first_));
  EXPECT_EQ(hold(second_), Answer::LetGo) << "a button that was refused does not start the vehicle by itself";
  holds_.let_go(&second_);
  EXPECT_EQ(hold(second_), Answer::Drives);
  now_ += std::chrono::milliseconds(400);
  EXPECT_EQ(hold(first_), Answer::Taken);
  now_ += std::chrono::milliseconds(200);
  EXPECT_FALSE(holds_.is_held(now_));
  holds_.let_go(&first_);
  EXPECT_EQ(hold(first_), Answer::Drives);
  EXPECT_EQ(hold(second_), Answer::Taken) << "it was silent too long";
}

TEST_F(JogHoldsTest, WhoHoldsWhereNobodyMayDriveLetsGoFirst) {
  EXPECT_EQ(hold(first_), Answer::Drives);
  holds_.refuse(&first_);
  EXPECT_FALSE(holds_.is_held(now_));
  EXPECT_EQ(hold(first_), Answer::LetGo);
  holds_.let_go(&first_);
  EXPECT_EQ(hold(first_), Answer::Drives);
  holds_.stop();
  holds_.refuse(&first_);
  EXPECT_EQ(hold(first_), Answer::Stopped);
}

}  // namespace
}  // namespace madori::app
