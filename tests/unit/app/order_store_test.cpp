#include "app/orders/order_store.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <random>

#include "app/orders/order_rows.hpp"
#include "core/result.hpp"
#include "tests/support/temporary_folder.hpp"

namespace madori::app {
namespace {

const Stamp kNow = stamp_from_seconds(1'700'000'000.0);

TEST(OrderStore, AnOrderGoesThroughItsStopsAndRounds) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const std::vector<OrderStop> stops{{3, StopAction::Load, 5.0}, {4, StopAction::Unload, 0.0}};
  const auto id = store.add(stops, 2, kNow);
  EXPECT_EQ(store.find(id)->state, OrderState::Queued);
  auto order = store.begin_next(kNow);
  ASSERT_TRUE(order);
  EXPECT_EQ(order->stops, stops);
  EXPECT_EQ(order->state, OrderState::Running);
  for (int i = 0; i < 4; ++i) *order = store.stop_done(id, order->round, order->next_stop, kNow);
  EXPECT_EQ(order->state, OrderState::Done);
  EXPECT_EQ(store.stops_done(), 4);
  EXPECT_FALSE(store.begin_next(kNow));
}

TEST(OrderStore, TheQueueIsPutInAnotherSequenceAndKeepsItWhenOrdersJoin) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const auto first = store.add({{3}}, 1, kNow);
  const auto second = store.add({{4}}, 1, kNow);
  const auto third = store.add({{5}}, 1, kNow);
  EXPECT_FALSE(store.arrange({third, first}));
  EXPECT_FALSE(store.arrange({third, third, first}));
  EXPECT_TRUE(store.arrange({third, first, second}));
  const auto fourth = store.add({{6}}, 1, kNow);
  std::vector<std::int64_t> taken;
  while (const auto order = store.begin_next(kNow)) {
    taken.push_back(order->id);
    store.close(order->id, OrderState::Cancelled, "", kNow);
  }
  EXPECT_EQ(taken, (std::vector<std::int64_t>{third, first, second, fourth}));
  EXPECT_EQ(store.ended(2).size(), 2U);
  EXPECT_EQ(store.created(first), kNow);
}

TEST(OrderStore, CountingAStopTwiceChangesNothing) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const auto id = store.add({{3}, {4}}, 1, kNow);
  (void)store.begin_next(kNow);
  EXPECT_EQ(store.stop_done(id, 0, 0, kNow).next_stop, 1U);
  EXPECT_EQ(store.stop_done(id, 0, 0, kNow).next_stop, 1U);
  EXPECT_EQ(store.stops_done(), 1);
}

TEST(OrderStore, TheRunningOrderComesBeforeQueuedOnesAndCancelledOnesNever) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const auto first = store.add({{1}}, 1, kNow);
  const auto second = store.add({{2}}, 1, kNow);
  const auto third = store.add({{3}}, 1, kNow);
  EXPECT_EQ(store.begin_next(kNow)->id, first);
  EXPECT_EQ(store.begin_next(kNow)->id, first);
  store.close(first, OrderState::Cancelled, "not wanted", kNow);
  store.close(second, OrderState::Refused, "no way", kNow);
  EXPECT_EQ(store.begin_next(kNow)->id, third);
  EXPECT_EQ(store.find(first)->note, "not wanted");
  EXPECT_EQ(store.list(true).size(), 1U);
  EXPECT_EQ(store.list(false).size(), 3U);
  store.close(first, OrderState::Refused, "again", kNow);
  EXPECT_EQ(store.find(first)->state, OrderState::Cancelled);
}

TEST(OrderStore, RefusesWhatIsNoOrderAndWhatIsNoDatabase) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  EXPECT_THROW((void)store.add({}, 1, kNow), Error);
  EXPECT_THROW((void)store.add({{1}}, 0, kNow), Error);
  EXPECT_THROW((void)store.stop_done(99, 0, 0, kNow), Error);
  folder.write("broken.db",
               "this is no database, and long enough to be looked at as one ...............................");
  EXPECT_THROW(OrderStore(folder.path() / "broken.db"), Error);
}

TEST(OrderStore, AStationThatIsDeletedIsNotTheNextOneOfItsNumber) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const auto ended = store.add({{3}, {12}}, 1, kNow);
  (void)store.begin_next(kNow);
  store.close(ended, OrderState::Cancelled, "not wanted", kNow);
  const auto passed = store.add({{12}, {3}}, 1, kNow);
  (void)store.begin_next(kNow);
  (void)store.stop_done(passed, 0, 0, kNow);
  const auto ahead = store.add({{3}, {12}}, 1, kNow);
  const auto again = store.add({{4}, {3}}, 2, kNow);

  store.keep_stations({3, 4}, kNow);  // 12 was deleted
  EXPECT_EQ(store.find(ahead)->state, OrderState::Refused);
  EXPECT_EQ(store.find(ahead)->note, "node 12 is not in the routes");
  EXPECT_EQ(store.events(1).front().text,
            "order " + std::to_string(ahead) + " refused: node 12 is not in the routes");
  EXPECT_EQ(store.find(passed)->state, OrderState::Running) << "it was there already";
  EXPECT_EQ(store.find(again)->state, OrderState::Queued);
  store.keep_stations({3, 4, 12}, kNow);  // another place is called 12
  EXPECT_TRUE(store.find(ended)->stops[1].gone);
  EXPECT_FALSE(store.find(ended)->stops[0].gone);
  const auto anew = store.add({{12}}, 1, kNow);
  store.keep_stations({3, 4, 12}, kNow);
  EXPECT_FALSE(store.find(anew)->stops[0].gone);
}

TEST(OrderStore, TheQueueHasAnEnd) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "madori.db";
  OrderStore store(file);
  {
    const Database database = open_order_database(file);
    Transaction fill(database.get());
    for (std::int64_t i = 0; i < OrderStore::kMostOpen; ++i)
      (void)insert_order(database.get(), {{1}}, 1, kNow);
    fill.commit();
  }
  EXPECT_THROW((void)store.add({{1}}, 1, kNow), Error);
  store.close(store.list(true).front().id, OrderState::Cancelled, "", kNow);
  EXPECT_NO_THROW((void)store.add({{1}}, 1, kNow));
  EXPECT_EQ(store.open_count(), OrderStore::kMostOpen);
}

/// Format 2, as older programs wrote it.
TEST(OrderStore, OrdersOfAnOlderProgramAreKept) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "madori.db";
  (void)OrderStore(file).add({{3}, {4}}, 1, kNow);
  {
    const Database database = open_order_database(file);
    Statement(database.get(), "ALTER TABLE order_stops DROP COLUMN gone").run();
    Statement(database.get(), "PRAGMA user_version=2").run();
  }
  const OrderStore store(file);
  ASSERT_EQ(store.list(true).size(), 1U);
  EXPECT_EQ(store.list(true).front().stops, (std::vector<OrderStop>{{3}, {4}}));
}

TEST(OrderStore, EventsComeNewestFirst) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  store.add_event({kNow, "mode", "one"});
  store.add_event({kNow, "mode", "two"});
  const auto events = store.events(10);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].text, "two");
  EXPECT_EQ(events[0].stamp, kNow);
}

TEST(OrderStore, OldEventsMakeRoomForNewOnes) {
  const test::TemporaryFolder folder;
  OrderStore store(folder.path() / "madori.db");
  const Database database = open_order_database(folder.path() / "madori.db");
  for (const std::int64_t id : {1, 2, 3'000, 150'000, 250'000})
    Statement(database.get(), "INSERT INTO events (id, stamp_ns, kind, text) VALUES (?, 0, 'mode', ?)")
        .bind(id, std::to_string(id))
        .run();
  store.add_event({kNow, "mode", "newest"});
  std::vector<std::string> texts;
  for (const EventRecord& event : store.events(10)) texts.push_back(event.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"newest", "250000", "150000"}));
}

/// Works off orders until it is killed; tells every finished stop through a pipe once the store has it.
[[noreturn]] void work(const std::filesystem::path& file, int report) {
  OrderStore store(file);
  while (true) {
    const auto order = store.begin_next(kNow);
    if (!order) {
      store.add({{1}, {2}, {3}}, 2, kNow);
      continue;
    }
    store.stop_done(order->id, order->round, order->next_stop, kNow);
    const char one = 1;
    if (::write(report, &one, 1) != 1) ::_exit(1);
  }
}

TEST(OrderStore, KilledAtRandomMomentsItLosesNothingAndCountsNothingTwice) {
  const test::TemporaryFolder folder;
  const auto file = folder.path() / "madori.db";
  std::mt19937 random(42);
  std::int64_t reported = 0;
  constexpr int kKills = 12;  // a kill costs 0.3 s of real fsyncs
  for (int i = 0; i < kKills; ++i) {
    std::array<int, 2> ends{};
    ASSERT_EQ(::pipe(ends.data()), 0);
    const pid_t child = ::fork();
    if (child == 0) work(file, ends[1]);
    ::close(ends[1]);
    if (i % 2 == 0) {  // on a busy machine the others may be killed before they have opened the database
      char first = 0;
      ASSERT_EQ(::read(ends[0], &first, 1), 1);
      ++reported;
    }
    ::usleep(static_cast<useconds_t>(50'000 + random() % 400'000));
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    char byte = 0;
    while (::read(ends[0], &byte, 1) == 1) ++reported;
    ::close(ends[0]);
    const OrderStore store(file);
    ASSERT_EQ(store.integrity(), "ok");
    const auto done = store.stops_done();
    EXPECT_GE(done, reported);
    EXPECT_LE(done, reported + i + 1) << "at most the stop in hand when it was killed";
    std::int64_t counted = 0;
    for (const Order& order : store.list(false))
      counted += order.round * static_cast<std::int64_t>(order.stops.size()) +
                 static_cast<std::int64_t>(order.next_stop);
    EXPECT_EQ(counted, done);
  }
  EXPECT_GT(reported, 0);
}

}  // namespace
}  // namespace madori::app
