#include "tests/bench/wall_training/forest_of.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace madori::training {
namespace {

using mapping::Forest;
using mapping::ForestNode;
using nlohmann::json;

constexpr double kLeafUnits = 4096;  // of one in the log odds

void check(int status) {
  if (status != 0) throw Error("training", XGBGetLastError(), "look at the measured sheets");
}

std::vector<json> dumped(BoosterHandle booster) {
  bst_ulong count = 0;
  const char** texts = nullptr;
  check(XGBoosterDumpModelEx(booster, "", 0, "json", &count, &texts));
  std::vector<json> trees;
  for (bst_ulong k = 0; k < count; ++k) trees.push_back(json::parse(texts[k]));
  return trees;
}

void gather(const json& node, std::map<std::string, std::vector<float>>& steps) {
  if (node.contains("leaf")) return;
  steps[node["split"]].push_back(node["split_condition"].get<float>());
  for (const json& child : node["children"]) gather(child, steps);
}

class Grower {
 public:
  explicit Grower(const std::vector<Forest::Feature>& features) : features_(features) {
    for (std::size_t k = 0; k < features.size(); ++k) numbers_[features[k].name] = k;
  }

  void append(std::vector<ForestNode>& tree, const json& node) const {
    if (node.contains("leaf")) {
      const double units = std::round(kLeafUnits * node["leaf"].get<double>());
      tree.push_back({ForestNode::kLeaf, 0, static_cast<std::int16_t>(std::clamp(units, -32767.0, 32767.0))});
      return;
    }
    const std::size_t feature = numbers_.at(node["split"]), self = tree.size();
    const auto& steps = features_[feature].steps;
    const auto reached =
        std::upper_bound(steps.begin(), steps.end(), node["split_condition"].get<float>()) - steps.begin();
    tree.push_back({static_cast<std::uint8_t>(feature), static_cast<std::uint8_t>(reached), 0});
    const json& children = node["children"];
    const std::size_t below = children[0]["nodeid"] == node["yes"] ? 0 : 1;
    append(tree, children[below]);
    tree[self].right = static_cast<std::int16_t>(tree.size());
    append(tree, children[1 - below]);
  }

 private:
  const std::vector<Forest::Feature>& features_;
  std::map<std::string, std::size_t> numbers_;
};

}  // namespace

mapping::Forest forest_of(BoosterHandle booster) {
  const auto trees = dumped(booster);
  std::map<std::string, std::vector<float>> steps;
  for (const json& tree : trees) gather(tree, steps);
  Forest forest;
  bst_ulong count = 0;
  const char** names = nullptr;
  check(XGBoosterGetStrFeatureInfo(booster, "feature_name", &count, &names));
  for (bst_ulong k = 0; k < count; ++k) {
    auto& scale = steps[names[k]];
    std::sort(scale.begin(), scale.end());
    scale.erase(std::unique(scale.begin(), scale.end()), scale.end());
    if (scale.size() >= ForestNode::kLeaf)
      throw Error("training", "more steps than a node counts", "lower max_bin");
    forest.features.push_back({names[k], scale});
  }
  const Grower grower(forest.features);
  for (const json& tree : trees) grower.append(forest.trees.emplace_back(), tree);
  forest.leaf_step = 1 / kLeafUnits;
  return forest;
}

}  // namespace madori::training
