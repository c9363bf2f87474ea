#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/drawing/labelling/feature_table.hpp"
#include "mapping/drawing/labelling/model_bytes.hpp"

namespace madori::mapping {

/// A node of a tree: a feature below a step goes to the next node, one from it on to `right` nodes behind the
/// tree's root. A leaf has kLeaf for its feature and what it adds to the log odds in `right`.
struct ForestNode {
  static constexpr std::uint8_t kLeaf = 255;
  std::uint8_t feature = kLeaf, step = 0;
  std::int16_t right = 0;
};

/// Boosted trees (T. Chen, C. Guestrin, "XGBoost", KDD 2016) that give every row of a table a probability.
/// They see each feature in steps of a scale of its own, so that a node is four bytes.
struct Forest {
  struct Feature {
    std::string name;
    std::vector<float> steps;  ///< rising: a value's step is how many of them it reaches; at most 254
  };
  std::vector<Feature> features;
  std::vector<std::vector<ForestNode>> trees;
  double leaf_step = 1;  ///< log odds of one unit of a leaf

  /// Throws Error where the table has other features.
  [[nodiscard]] std::vector<float> judged(const FeatureTable& table) const;

  [[nodiscard]] std::string bytes() const;
  /// Takes the forest that comes next in `bytes`. Throws Error where there is none.
  static Forest read(ModelBytes& bytes);
};

}  // namespace madori::mapping
