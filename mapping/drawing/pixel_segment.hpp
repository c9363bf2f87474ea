#pragma once

#include <cmath>
#include <string_view>

namespace madori::mapping {

/// A straight line of a drawing, Image frame: pixels, u right, v down; the middle of the first pixel is (0.5,
/// 0.5).
struct PixelSegment {
  double u1 = 0, v1 = 0, u2 = 0, v2 = 0;

  [[nodiscard]] double length_px() const { return std::hypot(u2 - u1, v2 - v1); }
  friend bool operator==(const PixelSegment&, const PixelSegment&) = default;
};

/// Why a line of the drawing was not taken for a wall.
enum class RejectReason { Text, Dimension, Hatch, DoorArc, Dashed, TitleBlock, Furniture, TooShort, Other };

[[nodiscard]] constexpr std::string_view to_string(RejectReason reason) {
  switch (reason) {
    case RejectReason::Text:
      return "text";
    case RejectReason::Dimension:
      return "dimension";
    case RejectReason::Hatch:
      return "hatch";
    case RejectReason::DoorArc:
      return "door arc";
    case RejectReason::Dashed:
      return "dashed";
    case RejectReason::TitleBlock:
      return "title block";
    case RejectReason::Furniture:
      return "furniture";
    case RejectReason::TooShort:
      return "too short";
    case RejectReason::Other:
      break;
  }
  return "other";
}

struct RejectedSegment {
  PixelSegment segment;
  RejectReason reason = RejectReason::Other;
  double probability = 0;  ///< that it is a wall all the same
};

}  // namespace madori::mapping
