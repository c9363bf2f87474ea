#include "mapping/drawing/labelling/forest.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <span>
#include <sstream>

#include "core/result.hpp"
#include "mapping/drawing/labelling/log_odds.hpp"

namespace madori::mapping {
namespace {

static_assert(std::endian::native == std::endian::little, "the model file is little-endian");
static_assert(sizeof(ForestNode) == 4);

constexpr std::size_t kRowsAtOnce = 64;  // their steps stay in the processor's first cache
constexpr std::size_t kTogether = 8;     // walks that do not wait for each other's next node

/// A walk from the root must stay in the tree and end.
bool leads_to_leaves(const std::vector<ForestNode>& tree, std::size_t features) {
  for (std::size_t k = 0; k < tree.size(); ++k) {
    if (tree[k].feature == ForestNode::kLeaf) continue;
    const int right = tree[k].right;
    if (tree[k].feature >= features || right <= static_cast<int>(k) + 1 ||
        right >= static_cast<int>(tree.size()))
      return false;
  }
  return !tree.empty() && tree.back().feature == ForestNode::kLeaf;
}

/// A tree whose leaves lead to themselves: every walk may take as many steps as the deepest one needs,
/// without a jump that cannot be foretold.
class Walked {
 public:
  explicit Walked(const std::vector<ForestNode>& tree) : nodes_(tree), leaf_(tree.size()) {
    std::vector<int> depth(tree.size());
    for (std::size_t k = 0; k < tree.size(); ++k) {
      depth_ = std::max(depth_, depth[k]);
      if (tree[k].feature == ForestNode::kLeaf) {
        leaf_[k] = tree[k].right;
        nodes_[k] = {0, 0, static_cast<std::int16_t>(k)};
      } else {
        for (const std::size_t next : {k + 1, static_cast<std::size_t>(tree[k].right)})
          depth[next] = std::max(depth[next], depth[k] + 1);
      }
    }
  }

  /// Adds to each row's sum what the leaf that its steps (`features` a row) lead to says.
  void add(std::span<const std::uint8_t> steps, std::size_t features, std::span<int> sums) const {
    std::size_t row = 0;
    for (; row + kTogether <= sums.size(); row += kTogether) {
      std::array<int, kTogether> at{};
      for (int step = 0; step < depth_; ++step)
#pragma GCC unroll 8
        for (std::size_t k = 0; k < kTogether; ++k) at[k] = next(at[k], &steps[(row + k) * features]);
      for (std::size_t k = 0; k < kTogether; ++k) sums[row + k] += leaf_[static_cast<std::size_t>(at[k])];
    }
    for (; row < sums.size(); ++row) {
      int at = 0;
      for (int step = 0; step < depth_; ++step) at = next(at, &steps[row * features]);
      sums[row] += leaf_[static_cast<std::size_t>(at)];
    }
  }

 private:
  [[nodiscard]] int next(int at, const std::uint8_t* steps) const {
    const ForestNode node = nodes_[static_cast<std::size_t>(at)];
    const int below = steps[node.feature] < node.step ? 1 : 0;
    return node.right + below * (at + 1 - node.right);
  }

  std::vector<ForestNode> nodes_;
  std::vector<std::int16_t> leaf_;
  int depth_ = 0;
};

/// How many of the rising `scale` a value reaches: std::upper_bound without a jump that cannot be foretold.
std::uint8_t step_of(const std::vector<float>& scale, float value) {
  const float* first = scale.data();
  std::size_t left = scale.size();
  while (left > 1) {
    const std::size_t half = left / 2;
    first += value < first[half - 1] ? 0 : half;
    left -= half;
  }
  const std::size_t reached = left == 1 && !(value < *first) ? 1 : 0;
  return static_cast<std::uint8_t>(static_cast<std::size_t>(first - scale.data()) + reached);
}

}  // namespace

std::vector<float> Forest::judged(const FeatureTable& table) const {
  const auto same = [](const Feature& feature, const std::string& name) { return feature.name == name; };
  if (!std::equal(features.begin(), features.end(), table.names().begin(), table.names().end(), same))
    throw Error("the wall model", "was trained on other features than this version measures",
                "train it again: train_walls");
  const std::vector<Walked> walked(trees.begin(), trees.end());
  std::vector<float> result(table.rows());
  const auto judge = [&](std::size_t from) {
    const std::size_t rows = std::min(kRowsAtOnce, table.rows() - from);
    std::vector<std::uint8_t> steps(rows * features.size());
    std::vector<int> sums(rows);
    for (std::size_t k = 0; k < features.size(); ++k) {
      const auto& scale = features[k].steps;
      for (std::size_t i = 0; i < rows; ++i)
        steps[i * features.size() + k] = step_of(scale, table.at(from + i, k));
    }
    for (const Walked& tree : walked) tree.add(steps, features.size(), sums);
    for (std::size_t i = 0; i < rows; ++i)
      result[from + i] = static_cast<float>(probability_of(leaf_step * sums[i]));
  };
  const std::size_t blocks = (table.rows() + kRowsAtOnce - 1) / kRowsAtOnce;
  cv::parallel_for_({0, static_cast<int>(blocks)}, [&](const cv::Range& some) {
    for (int block = some.start; block < some.end; ++block)
      judge(static_cast<std::size_t>(block) * kRowsAtOnce);
  });
  return result;
}

std::string Forest::bytes() const {
  std::ostringstream out;
  const auto write = [&](const auto& values) {
    out.write(reinterpret_cast<const char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(values[0])));
  };
  out << features.size() << ' ' << trees.size() << ' ' << leaf_step << '\n';
  for (const Feature& feature : features) {
    out << feature.name << ' ' << feature.steps.size() << '\n';
    write(feature.steps);
  }
  for (const auto& tree : trees) {
    out << tree.size() << '\n';
    write(tree);
  }
  return out.str();
}

Forest Forest::read(ModelBytes& bytes) {
  Forest forest;
  std::size_t features = 0, trees = 0;
  bytes.take_line(features, trees, forest.leaf_step);
  bytes.demand(features < ForestNode::kLeaf);
  for (std::size_t k = 0; k < features; ++k) {
    Feature feature;
    std::size_t count = 0;
    bytes.take_line(feature.name, count);
    bytes.demand(count < ForestNode::kLeaf);
    feature.steps = bytes.take<float>(count);
    forest.features.push_back(std::move(feature));
  }
  for (std::size_t k = 0; k < trees; ++k) {
    std::size_t count = 0;
    bytes.take_line(count);
    forest.trees.push_back(bytes.take<ForestNode>(count));
    bytes.demand(leads_to_leaves(forest.trees.back(), features));
  }
  return forest;
}

}  // namespace madori::mapping
