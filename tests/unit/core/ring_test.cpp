#include "core/ring.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>
#include <vector>

namespace madori {
namespace {

/// The same words to a deque and to a ring: both hold the same after each.
TEST(Ring, HoldsWhatADequeHolds) {
  std::mt19937 random(1);
  std::deque<int> deque;
  Ring<int> ring;
  for (int i = 0; i < 20'000; ++i) {
    const auto word = random() % 100;
    if (word < 52) {
      deque.push_back(i);
      ring.push_back(i);
    } else if (word < 99) {
      if (deque.empty()) continue;
      deque.pop_front();
      ring.pop_front();
    } else if (random() % 20 == 0) {
      deque.clear();
      ring.clear();
    }
    ASSERT_TRUE(std::equal(deque.begin(), deque.end(), ring.begin(), ring.end())) << "after " << i;
    if (deque.empty()) continue;
    ASSERT_EQ(ring.front(), deque.front());
    ASSERT_EQ(ring.back(), deque.back());
    const auto sought = deque[random() % deque.size()];  // they are sorted
    ASSERT_EQ(std::lower_bound(ring.begin(), ring.end(), sought) - ring.begin(),
              std::lower_bound(deque.begin(), deque.end(), sought) - deque.begin());
  }
}

TEST(Ring, IsEmptyWhereItWasMovedFrom) {
  Ring<int> ring;
  for (int i = 0; i < 20; ++i) ring.push_back(i);
  Ring<int> other = std::move(ring);
  EXPECT_EQ(other.size(), 20U);
  EXPECT_TRUE(ring.empty());  // NOLINT(bugprone-use-after-move): what it promises
  ring.push_back(7);
  EXPECT_EQ(ring.front(), 7);
  other = std::move(ring);
  EXPECT_EQ(other.size(), 1U);
  EXPECT_TRUE(ring.empty());  // NOLINT(bugprone-use-after-move)
}

/// What was taken out leaves its memory to what comes.
TEST(Ring, UsesTheMemoryOfAFreeSlotAgain) {
  Ring<std::vector<int>> ring;
  for (int i = 0; i < 8; ++i) ring.add().assign(100, i);
  const int* memory = ring.front().data();
  ring.pop_front();
  std::vector<int>& next = ring.add();
  next.assign(50, 8);
  EXPECT_EQ(next.data(), memory);
  EXPECT_EQ(ring.front().front(), 1);
}

}  // namespace
}  // namespace madori
