#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "mapping/drawing/labelling/feature_table.hpp"

namespace madori::mapping {

/// Boosted trees (T. Chen, C. Guestrin, "XGBoost", KDD 2016) that say of every edge of a drawing how probable
/// it is that a wall was drawn there. Trained by train_walls; docs/how-to/teach-a-drawing.md.
class WallModel {
 public:
  /// Throws Error where the file is no model of these features.
  static WallModel load(const std::filesystem::path& file);
  /// The one that is built in.
  static const WallModel& shipped();

  /// One an edge, 0..1. Throws Error where the features are not those that the model was trained on.
  [[nodiscard]] std::vector<float> probabilities(const FeatureTable& features) const;

 private:
  struct Trees;
  explicit WallModel(std::shared_ptr<const Trees> trees) : trees_(std::move(trees)) {}
  static WallModel from_bytes(const std::string& name, const void* bytes, std::size_t size);
  std::shared_ptr<const Trees> trees_;
};

}  // namespace madori::mapping
