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
/// no vote, so neither large colour fills nor sparse thin grey lines pull it away as they do with Otsu's.
[[nodiscard]] Binarized binarize(const GrayImage& image, std::optional<double> threshold);

}  // namespace madori::mapping
