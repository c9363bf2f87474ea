#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "mapping/drawing/labelling/feature_table.hpp"

namespace madori::mapping {

/// Boosted trees (T. Chen, C. Guestrin, "XGBoost", KDD 2016) that say of every edge of a drawing how probable
/// it is that a wall was drawn there. They judge twice: each edge by itself, then each in the light of all
/// (D. Wolpert, "Stacked generalization", 1992). Trained by train_walls; docs/how-to/teach-a-drawing.md.
class WallModel {
 public:
  /// Throws Error where the file is no model of these features.
  static WallModel load(const std::filesystem::path& file);
  /// The one that is built in.
  static const WallModel& shipped();

  /// One an edge, 0..1, by edge_features. Throws Error where those are not what the model was trained on.
  [[nodiscard]] std::vector<float> first(const FeatureTable& features) const;
  /// By the sheet_context of the first judgement and edge_features.
  [[nodiscard]] std::vector<float> second(const FeatureTable& context) const;

 private:
  struct Trees;
  using Judge = std::shared_ptr<const Trees>;
  WallModel(Judge first, Judge second) : first_(std::move(first)), second_(std::move(second)) {}
  static WallModel from_bytes(const std::string& name, const char* bytes, std::size_t size);
  static Judge judge_from(const std::string& name, const char* bytes, std::size_t size);
  static std::vector<float> judged(const Trees& trees, const FeatureTable& features);
  Judge first_, second_;
};

}  // namespace madori::mapping
