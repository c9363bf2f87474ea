#include "app/orders/order_desk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <latch>
#include <thread>
#include <vector>

#include "app/orders/sqlite.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

constexpr auto kTick = std::chrono::milliseconds(20);

class OrderDeskTest : public testing::Test {
 protected:
  /// Ticks until the desk's order is as `right` says; the test's own limit ends this.
  std::optional<Order> tick_until(OrderDesk& desk, const std::function<bool(const Order&)>& right) {
    while (true) {
      now_ += kTick;
      const auto order = desk.order(now_, true);
      if (order && right(*order)) return order;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "madori.db";
  Stamp now_ = stamp_from_seconds(1'700'000'000.0);
};

bool is_running(const Order& order) {
  return order.state == OrderState::Running;
}

TEST_F(OrderDeskTest, ALockedDatabaseHoldsNoStepUpAndEveryStopIsCountedOnceItIsFree) {
  OrderStore store(file_);
  const auto id = store.add({{1}, {2}}, 1, now_);
  OrderDesk desk(file_, {.poll_s = 0.1});
  const auto begun = tick_until(desk, is_running);
  const Database other = open_order_database(file_);
  {
    const Transaction held(other.get());  // as another program would hold it, for as long as it likes
    desk.stop_reached({id, 0, 0}, now_);
    desk.add({now_, "mode", "something"});
    for (int i = 0; i < 100; ++i) {
      now_ += kTick;
      EXPECT_EQ(desk.order(now_, true), begun) << "not counted yet: the vehicle stays with what it has";
    }
  }
  const auto next = tick_until(desk, [](const Order& order) { return order.next_stop == 1; });
  EXPECT_EQ(next->id, id);
  desk.stop_reached({id, 0, 1}, now_);
  tick_until(desk, [](const Order& order) { return order.state == OrderState::Done; });
  EXPECT_EQ(store.stops_done(), 2);
  EXPECT_EQ(store.find(id)->state, OrderState::Done);
}

TEST_F(OrderDeskTest, AFolderThatIsGoneIsSaidAndTheVehicleStaysWithTheOrderThatItHas) {
  const auto folder = folder_.path() / "site", elsewhere = folder_.path() / "elsewhere";
  std::filesystem::create_directory(folder);
  OrderStore store(folder / "madori.db");
  const auto id = store.add({{1}, {2}}, 1, now_);
  OrderDesk desk(folder / "madori.db", {.lock_step = true, .poll_s = 0.0});
  const auto begun = desk.order(now_, true);
  ASSERT_TRUE(begun);
  std::filesystem::rename(folder, elsewhere);
  EXPECT_EQ(desk.order(now_ += kTick, true), begun) << "whole, with its stops";
  EXPECT_NE(desk.problem().find("removed or renamed"), std::string::npos) << desk.problem();
  desk.stop_reached({id, 0, 0}, now_);
  EXPECT_EQ(desk.order(now_ += kTick, true), begun);
  std::filesystem::rename(elsewhere, folder);
  (void)desk.order(now_ += kTick, true);
  EXPECT_EQ(desk.problem(), "");
  EXPECT_EQ(store.stops_done(), 1) << "what was reported meanwhile is not lost";
}

TEST_F(OrderDeskTest, WhatStoppedNothingEndsNoOrderThatBeginsLater) {
  const auto folder = folder_.path() / "site", elsewhere = folder_.path() / "elsewhere";
  std::filesystem::create_directory(folder);
  OrderStore store(folder / "madori.db");
  const auto id = store.add({{1}}, 1, now_);
  OrderDesk desk(folder / "madori.db", {.lock_step = true, .poll_s = 0.0});
  std::filesystem::rename(folder, elsewhere);
  desk.cancel_running("stopped at the panel", now_);  // is written once the folder is back
  std::filesystem::rename(elsewhere, folder);
  for (int i = 0; i < 5; ++i) (void)desk.order(now_ += kTick, true);
  EXPECT_EQ(store.find(id)->state, OrderState::Running) << "the look that wrote the stop began none";
}

TEST_F(OrderDeskTest, ProgramsThatOpenItAtOnceWaitForOneAnother) {
  for (int round = 0; round < 40; ++round) {
    const auto file = folder_.path() / (std::to_string(round) + ".db");
    std::vector<std::thread> programs;
    std::latch ready(4);
    for (int i = 0; i < 4; ++i)
      programs.emplace_back([&] {
        ready.arrive_and_wait();
        EXPECT_NO_THROW(OrderStore(file).list(true));
      });
    for (auto& program : programs) program.join();
  }
}

TEST_F(OrderDeskTest, ARefusedOrderIsGoneAtOnceAndNeverComesBack) {
  OrderStore store(file_);
  const auto first = store.add({{1}}, 1, now_);
  const auto second = store.add({{2}}, 1, now_);
  OrderDesk desk(file_, {.poll_s = 0.1});
  tick_until(desk, is_running);
  desk.refuse(first, "no way", now_);
  EXPECT_FALSE(desk.order(now_, true));
  EXPECT_EQ(tick_until(desk, is_running)->id, second);
  EXPECT_EQ(store.find(first)->state, OrderState::Refused);
}

TEST_F(OrderDeskTest, WhatAStopEndsIsGoneAtOnceAndCancelledBeforeAnythingElseBegins) {
  OrderStore store(file_);
  const auto first = store.add({{1}}, 1, now_);
  const auto second = store.add({{2}}, 1, now_);
  OrderDesk desk(file_, {.poll_s = 0.1});
  tick_until(desk, is_running);
  const Database other = open_order_database(file_);
  {
    const Transaction held(other.get());
    desk.cancel_running("stopped at the panel", now_);
    for (int i = 0; i < 100; ++i) {
      now_ += kTick;
      EXPECT_FALSE(desk.order(now_, true)) << "neither the one that was stopped nor the next";
    }
  }
  EXPECT_EQ(tick_until(desk, is_running)->id, second);
  EXPECT_EQ(store.find(first)->state, OrderState::Cancelled);
  EXPECT_EQ(store.find(first)->note, "stopped at the panel");
}

/// After a restart: it runs in the database, and nobody has begun it here.
TEST_F(OrderDeskTest, AStopEndsAnOrderThatWasNotGivenYet) {
  OrderStore store(file_);
  const auto id = store.add({{1}}, 1, now_);
  store.begin_next(now_);
  OrderDesk desk(file_, {.lock_step = true});
  desk.cancel_running("stopped at the panel", now_);
  EXPECT_EQ(store.find(id)->state, OrderState::Cancelled);
  EXPECT_FALSE(desk.order(now_, true));
}

TEST_F(OrderDeskTest, WhatIsLeftIsWrittenAtTheEnd) {
  OrderStore store(file_);
  const auto id = store.add({{1}}, 1, now_);
  {
    OrderDesk desk(file_, {});
    tick_until(desk, is_running);
    desk.stop_reached({id, 0, 0}, now_);
    desk.add({now_, "mode", "the last one"});
  }
  EXPECT_EQ(store.stops_done(), 1);
  std::vector<std::string> told;
  for (const auto& event : store.events(10)) told.push_back(event.text);
  EXPECT_NE(std::find(told.begin(), told.end(), "the last one"), told.end());
}

TEST_F(OrderDeskTest, InLockStepTheSameCallGivesTheSameOrder) {
  OrderStore store(file_);
  const auto id = store.add({{1}, {2}}, 1, now_);
  OrderDesk desk(file_, {.lock_step = true, .poll_s = 0.1});
  EXPECT_FALSE(desk.order(now_, false)) << "none may begin";
  EXPECT_FALSE(desk.order(now_ + kTick, true)) << "looked at only now and then";
  const auto order = desk.order(now_ + std::chrono::milliseconds(100), true);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->id, id);
  desk.stop_reached({id, 0, 0}, now_);
  EXPECT_EQ(desk.order(now_ + std::chrono::milliseconds(110), true)->next_stop, 1U);
}

TEST_F(OrderDeskTest, TheEndOfAnOrderIsGivenBeforeTheNextOneBeginsHoweverOftenItIsLooked) {
  OrderStore store(file_);
  for (const bool lock_step : {true, false}) {
    OrderDesk desk(file_, {.lock_step = lock_step, .poll_s = 0.0});
    for (int i = 0; i < 50; ++i) {
      const auto id = store.add({{1}}, 1, now_);
      store.add({{2}}, 1, now_);
      tick_until(desk, is_running);
      desk.stop_reached({id, 0, 0}, now_);
      std::optional<Order> given;
      do {
        now_ += kTick;
        given = desk.order(now_, true);
        ASSERT_TRUE(given && given->id == id) << "order " << id << ", lock step " << lock_step;
      } while (given->state == OrderState::Running);
      EXPECT_EQ(given->state, OrderState::Done);
      const auto next = tick_until(desk, is_running);
      desk.stop_reached({next->id, 0, 0}, now_);
      tick_until(desk, [](const Order& order) { return order.state == OrderState::Done; });
    }
  }
}

}  // namespace
}  // namespace madori::app
