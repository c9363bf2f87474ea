#pragma once

#include <filesystem>
#include <vector>

#include "mapping/drawing/labelling/forest.hpp"

namespace madori::mapping {

/// What becomes of the log odds of the trees, so that of what is said to be a wall with 0.8 four fifths are
/// walls, by length: slope * log odds + offset.
struct Calibration {
  double slope = 1, offset = 0;
};

/// Says of every edge of a drawing how probable it is that a wall was drawn there. Two forests judge: each
/// edge by itself, then each in the light of all (D. Wolpert, "Stacked generalization", 1992). Trained by
/// train_walls; docs/how-to/teach-a-drawing.md.
class WallModel {
 public:
  WallModel(Forest first, Forest second, const Calibration& calibration)
      : first_(std::move(first)), second_(std::move(second)), calibration_(calibration) {}
  /// Throws Error where the file is no model.
  static WallModel load(const std::filesystem::path& file);
  /// The one that is built in.
  static const WallModel& shipped();

  /// One an edge, 0..1, by edge_features. Throws Error where those are not what the model was trained on.
  [[nodiscard]] std::vector<float> first(const FeatureTable& features) const {
    return first_.judged(features);
  }
  /// By the sheet_context of the first judgement and edge_features.
  [[nodiscard]] std::vector<float> second(const FeatureTable& context) const {
    return second_.judged(context);
  }
  /// The probability to be told where the trees, to whom short edges count for more, judge so.
  [[nodiscard]] double told(double judged) const;
  [[nodiscard]] std::string bytes() const;

 private:
  Forest first_, second_;
  Calibration calibration_;
};

}  // namespace madori::mapping
