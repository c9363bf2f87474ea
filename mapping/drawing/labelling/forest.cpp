#include "mapping/drawing/labelling/forest.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>

#include "core/result.hpp"

namespace madori::mapping {
namespace {

static_assert(std::endian::native == std::endian::little, "the model file is little-endian");
static_assert(sizeof(ForestNode) == 4);

constexpr std::size_t kRowsAtOnce = 256;  // their steps and one tree stay in the processor's first cache

const char* const kNoModel = "is no wall model of this version";
const char* const kMend = "train it again: train_walls";

template <class T>
std::vector<T> take(const std::string& file, std::string_view& bytes, std::size_t count) {
  if (count > bytes.size() / sizeof(T)) throw Error(file, kNoModel, kMend);
  std::vector<T> values(count);
  std::memcpy(values.data(), bytes.data(), count * sizeof(T));
  bytes.remove_prefix(count * sizeof(T));
  return values;
}

std::istringstream take_line(const std::string& file, std::string_view& bytes) {
  const std::size_t end = bytes.find('\n');
  if (end == std::string_view::npos) throw Error(file, kNoModel, kMend);
  std::istringstream line{std::string(bytes.substr(0, end))};
  bytes.remove_prefix(end + 1);
  return line;
}

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

int leaf_of(const std::vector<ForestNode>& tree, const std::uint8_t* steps) {
  const ForestNode* node = tree.data();
  while (node->feature != ForestNode::kLeaf)
    node = steps[node->feature] < node->step ? node + 1 : tree.data() + node->right;
  return node->right;
}

}  // namespace

std::vector<float> Forest::judged(const FeatureTable& table) const {
  const auto same = [](const Feature& feature, const std::string& name) { return feature.name == name; };
  if (!std::equal(features.begin(), features.end(), table.names().begin(), table.names().end(), same))
    throw Error("the wall model", "was trained on other features than this version measures", kMend);
  std::vector<float> result;
  std::vector<std::uint8_t> steps(kRowsAtOnce * features.size());
  std::vector<int> sums(kRowsAtOnce);
  for (std::size_t from = 0; from < table.rows(); from += kRowsAtOnce) {
    const std::size_t rows = std::min(kRowsAtOnce, table.rows() - from);
    for (std::size_t k = 0; k < features.size(); ++k) {
      const auto& scale = features[k].steps;
      for (std::size_t i = 0; i < rows; ++i)
        steps[i * features.size() + k] = static_cast<std::uint8_t>(
            std::upper_bound(scale.begin(), scale.end(), table.at(from + i, k)) - scale.begin());
    }
    std::fill(sums.begin(), sums.end(), 0);
    for (const auto& tree : trees)
      for (std::size_t i = 0; i < rows; ++i) sums[i] += leaf_of(tree, &steps[i * features.size()]);
    for (std::size_t i = 0; i < rows; ++i)
      result.push_back(static_cast<float>(1 / (1 + std::exp(-leaf_step * sums[i]))));
  }
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

Forest Forest::read(const std::string& file, std::string_view& bytes) {
  Forest forest;
  std::size_t features = 0, trees = 0;
  if (!(take_line(file, bytes) >> features >> trees >> forest.leaf_step) || features >= ForestNode::kLeaf)
    throw Error(file, kNoModel, kMend);
  for (std::size_t k = 0; k < features; ++k) {
    Feature feature;
    std::size_t count = 0;
    if (!(take_line(file, bytes) >> feature.name >> count) || count >= ForestNode::kLeaf)
      throw Error(file, kNoModel, kMend);
    feature.steps = take<float>(file, bytes, count);
    forest.features.push_back(std::move(feature));
  }
  for (std::size_t k = 0; k < trees; ++k) {
    std::size_t count = 0;
    if (!(take_line(file, bytes) >> count)) throw Error(file, kNoModel, kMend);
    forest.trees.push_back(take<ForestNode>(file, bytes, count));
    if (!leads_to_leaves(forest.trees.back(), features)) throw Error(file, kNoModel, kMend);
  }
  return forest;
}

}  // namespace madori::mapping
