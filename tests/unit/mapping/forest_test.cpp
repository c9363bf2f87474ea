// Trees that judge rows of a table, and the bytes that they are kept in.
#include "mapping/drawing/labelling/forest.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

constexpr std::size_t kFeatures = 5;

/// A tree as somebody would draw it: thresholds of the values themselves.
struct Branch {
  std::size_t feature = 0;
  float from = 0;
  int leaf = 0;
  std::vector<Branch> children;  // below `from`, from it on; none: a leaf
};

Branch random_branch(std::mt19937& random, const Forest& forest, int depth) {
  Branch branch;
  branch.leaf = static_cast<int>(random() % 2001) - 1000;
  if (depth == 0 || random() % 4 == 0) return branch;
  branch.feature = random() % kFeatures;
  const auto& steps = forest.features[branch.feature].steps;
  branch.from = steps[random() % steps.size()];
  for (int k = 0; k < 2; ++k) branch.children.push_back(random_branch(random, forest, depth - 1));
  return branch;
}

int sum_of(const Branch& branch, const std::vector<float>& row) {
  if (branch.children.empty()) return branch.leaf;
  return sum_of(branch.children[row[branch.feature] < branch.from ? 0 : 1], row);
}

void append(std::vector<ForestNode>& tree, const Branch& branch, const Forest& forest) {
  if (branch.children.empty()) {
    tree.push_back({ForestNode::kLeaf, 0, static_cast<std::int16_t>(branch.leaf)});
    return;
  }
  const auto& steps = forest.features[branch.feature].steps;
  const auto step = std::find(steps.begin(), steps.end(), branch.from) - steps.begin() + 1;
  const std::size_t self = tree.size();
  tree.push_back({static_cast<std::uint8_t>(branch.feature), static_cast<std::uint8_t>(step), 0});
  append(tree, branch.children[0], forest);
  tree[self].right = static_cast<std::int16_t>(tree.size());
  append(tree, branch.children[1], forest);
}

struct Grown {
  Forest forest;
  std::vector<Branch> branches;
};

Grown random_forest(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(-2, 2);
  Grown grown;
  for (std::size_t k = 0; k < kFeatures; ++k) {
    std::vector<float> steps;
    for (std::size_t i = 0; i < 1 + 20 * k; ++i) steps.push_back(anywhere(random));
    std::sort(steps.begin(), steps.end());
    grown.forest.features.push_back({"feature_" + std::to_string(k), steps});
  }
  grown.forest.leaf_step = 0.001;
  for (int k = 0; k < 20; ++k) {
    grown.branches.push_back(random_branch(random, grown.forest, 5));
    append(grown.forest.trees.emplace_back(), grown.branches.back(), grown.forest);
  }
  return grown;
}

/// Values on the steps too, where below and from it on part.
FeatureTable random_table(unsigned seed, const Forest& forest, std::size_t rows) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> anywhere(-3, 3);
  FeatureTable table(rows);
  for (const auto& feature : forest.features)
    table.fill(feature.name, [&](std::size_t) {
      return random() % 3 == 0 ? feature.steps[random() % feature.steps.size()] : anywhere(random);
    });
  return table;
}

TEST(Forest, JudgesAsItsTreesAreDrawn) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Grown grown = random_forest(seed);
    const FeatureTable table = random_table(seed, grown.forest, 700);
    const auto judged = grown.forest.judged(table);
    ASSERT_EQ(judged.size(), table.rows());
    for (std::size_t i = 0; i < judged.size(); ++i) {
      int sum = 0;
      for (const Branch& branch : grown.branches) sum += sum_of(branch, table.row(i));
      ASSERT_NEAR(judged[i], 1 / (1 + std::exp(-0.001 * sum)), 1e-6) << "seed " << seed << ", row " << i;
    }
  }
}

TEST(Forest, IsTheSameFromItsBytes) {
  const Grown grown = random_forest(7);
  const std::string bytes = grown.forest.bytes() + "what follows";
  ModelBytes rest("model", bytes);
  const Forest read = Forest::read(rest);
  EXPECT_THAT(rest.take<char>(12), testing::ElementsAreArray(std::string("what follows")));
  EXPECT_THROW(rest.take<char>(1), Error);
  const FeatureTable table = random_table(1, grown.forest, 300);
  EXPECT_EQ(read.judged(table), grown.forest.judged(table));
}

/// Whatever a file holds: it is refused, or its trees end.
TEST(Forest, DamagedBytesAreRefusedOrHarmless) {
  const Grown grown = random_forest(3);
  const std::string bytes = grown.forest.bytes();
  const FeatureTable table = random_table(1, grown.forest, 20);
  std::mt19937 random(5);
  int refused = 0;
  const auto judge = [&](std::string_view damaged) {
    try {
      ModelBytes from("model", damaged);
      (void)Forest::read(from).judged(table);
    } catch (const Error&) {
      ++refused;
    }
  };
  for (std::size_t size = 0; size < bytes.size(); size += 1 + random() % 40)
    judge(std::string_view(bytes).substr(0, size));
  EXPECT_GT(refused, 20);
  for (int k = 0; k < 2000; ++k) {
    std::string other = bytes;
    other[random() % other.size()] = static_cast<char>(random());
    judge(other);
  }
}

}  // namespace
}  // namespace madori::mapping
