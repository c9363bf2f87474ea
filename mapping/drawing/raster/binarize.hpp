#pragma once

#include <optional>

#include "mapping/drawing/gray_image.hpp"

namespace madori::mapping {

struct Binarized {
  GrayImage ink;         ///< 255 = ink, 0 = paper
  double threshold = 0;  ///< on a paper of 255
};

/// Ink or paper, by one threshold relative to the local paper. The threshold is the one that the most edges
/// of the drawing cross (R. Kohler, "A segmentation system based on thresholding", CGIP 15, 1981): areas have
/// no vote, so neither large colour fills nor sparse thin grey lines pull it away as they do with Otsu's. A
/// dark stroke ends half way up its edge all the same. A `threshold` that somebody chose is taken as it is.
[[nodiscard]] Binarized binarize(const GrayImage& image, std::optional<double> threshold);

/// The same for a drawing that was enlarged, by the `threshold` found on it as it came: enlarging pales fine
/// strokes and leaves fills as dark as they were, so its own threshold would cut slanted lines into dashes.
[[nodiscard]] Binarized binarize_enlarged(const GrayImage& image, double threshold);

}  // namespace madori::mapping
