#include "mapping/drawing/labelling/forest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/core/utility.hpp>
#include <sstream>

#include "core/result.hpp"
#include "mapping/drawing/labelling/log_odds.hpp"

namespace madori::mapping {
namespace {

static_assert(std::endian::native == std::endian::little, "the model file is little-endian");
static_assert(sizeof(ForestNode) == 4);

constexpr std::size_t kRowsAtOnce = 256;  // their steps and one tree stay in the processor's first cache

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

/// Without a jump at the nodes: which side is taken cannot be foretold.
int leaf_of(const std::vector<ForestNode>& tree, const std::uint8_t* steps) {
  int at = 0;
  const ForestNode* node = tree.data();
  while (node->feature != ForestNode::kLeaf) {
    const int below = steps[node->feature] < node->step ? 1 : 0;
    at = node->right + below * (at + 1 - node->right);
    node = tree.data() + at;
  }
  return node->right;
}

}  // namespace

std::vector<float> Forest::judged(const FeatureTable& table) const {
  const auto same = [](const Feature& feature, const std::string& name) { return feature.name == name; };
  if (!std::equal(features.begin(), features.end(), table.names().begin(), table.names().end(), same))
    throw Error("the wall model", "was trained on other features than this version measures",
                "train it again: train_walls");
  std::vector<float> result(table.rows());
  const auto judge = [&](std::size_t from) {
    const std::size_t rows = std::min(kRowsAtOnce, table.rows() - from);
    std::vector<std::uint8_t> steps(rows * features.size());
    std::vector<int> sums(rows);
    for (std::size_t k = 0; k < features.size(); ++k) {
      const auto& scale = features[k].steps;
      for (std::size_t i = 0; i < rows; ++i)
        steps[i * features.size() + k] = static_cast<std::uint8_t>(
            std::upper_bound(scale.begin(), scale.end(), table.at(from + i, k)) - scale.begin());
    }
    for (const auto& tree : trees)
      for (std::size_t i = 0; i < rows; ++i) sums[i] += leaf_of(tree, &steps[i * features.size()]);
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
