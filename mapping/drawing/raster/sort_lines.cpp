#include "mapping/drawing/raster/sort_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mapping/drawing/raster/line_fit.hpp"
#include "mapping/drawing/raster/line_index.hpp"

namespace madori::mapping {
namespace {

// All lengths in wall thicknesses.
constexpr double kFilledFromClean = 3;  // in widths of the wall itself
constexpr double kFilledFromCluttered = 5;
constexpr double kPairedFromClean = 2;
constexpr double kPairedFromCluttered = 10;
constexpr double kPairedBesideFilled = 25;  // where most walls are filled, empty pairs are mostly furniture
constexpr double kMostlyFilled = 0.25;
constexpr double kPairedShare = 0.5;
constexpr double kLongFrom = 45;
constexpr double kLongFromSingle = 4;
constexpr double kHeldFromSingle = 1.5;
constexpr double kSingleBelow = 0.2;  // share of paired length
constexpr double kHeldFromClean = 6;
constexpr double kHeldFromCluttered = 25;
constexpr double kPenFillFactor = 3;
constexpr double kHeavyStub = 3;
constexpr double kFinePenFactor = 2.5;
constexpr double kEndReach = 1.5;
constexpr double kLonelySolid = 5, kLonelyPen = 20;  // shorter ones need a wall that they continue
constexpr double kLonelyBold = 15;                   // strokes
constexpr double kDoorway = 20;                      // a gap that a wall may have
constexpr double kGoesOnFrom = 5, kGoesOnOff = 0.5;
constexpr double kGoesOnTurn = 0.05;                          // radians
constexpr double kCleanBelow = 0.15, kClutteredAbove = 0.35;  // share of lines that nothing explains

bool passes(const PixelSegment& s, double u, double v, double reach) {
  const FittedLine line = line_through(s);
  return std::abs(line.across(u, v)) <= reach && std::abs(line.along(u, v)) <= 0.5 * s.length_px() + reach;
}

/// A straight line, or all pieces of a bent one together.
struct Unit {
  double length = 0;
  Evidence evidence;
};

std::vector<Unit> units_of(const DrawnLines& lines, const std::vector<Evidence>& evidence) {
  std::map<int, Unit> chains;
  const auto add = [&](Unit& unit, std::size_t i) {
    unit.length += lines[i].length_px();
    unit.evidence.paired_px += evidence[i].paired_px;
    unit.evidence.filled_px += evidence[i].filled_px;
    unit.evidence.width_px = std::max(unit.evidence.width_px, evidence[i].width_px);
  };
  std::vector<Unit> units(lines.size());
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!lines[i].rejected) add(lines[i].chain >= 0 ? chains[lines[i].chain] : units[i], i);
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i].chain >= 0) units[i] = chains[lines[i].chain];
  return units;
}

class Sorter {
 public:
  Sorter(const DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style)
      : lines_(lines),
        evidence_(evidence),
        style_(style),
        units_(units_of(lines, evidence)),
        t_(style.thickness_px),
        index_(lines, 64),
        wall_(lines.size(), false) {
    const double blend = std::clamp((clutter() - kCleanBelow) / (kClutteredAbove - kCleanBelow), 0.0, 1.0);
    filled_style_ = blend > 0.5 && style.filled_share > kMostlyFilled;
    paired_from_ =
        std::lerp(kPairedFromClean, filled_style_ ? kPairedBesideFilled : kPairedFromCluttered, blend);
    filled_from_ = std::lerp(kFilledFromClean, kFilledFromCluttered, blend);
    held_from_ = std::lerp(kHeldFromClean, kHeldFromCluttered, blend);
    if (paired_share() < kSingleBelow) {  // the walls of this drawing are single lines
      long_from_ = kLongFromSingle;
      held_from_ = kHeldFromSingle;
    }
  }

  std::vector<bool> run() {
    for (std::size_t i = 0; i < lines_.size(); ++i) wall_[i] = !lines_[i].rejected && stands_alone(i);
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        if (wall_[i] || lines_[i].rejected || !hangs_on_walls(i)) continue;
        wall_[i] = changed = true;
      }
    }
    if (filled_style_) drop_lonely_pieces();
    return wall_;
  }

  /// The share of all line length that is neither paired nor long: furniture, symbols, notes.
  [[nodiscard]] double clutter() const {
    double all = 0, explained = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double length = lines_[i].length_px();
      all += length;
      if (evidence_[i].paired_px >= kPairedShare * length || length >= kLongFrom * t_) explained += length;
    }
    return all > 0 ? 1 - explained / all : 0;
  }

 private:
  [[nodiscard]] double paired_share() const {
    double all = 0, paired = 0;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const double length = lines_[i].length_px();
      if (lines_[i].rejected || length < t_) continue;
      all += length;
      if (evidence_[i].paired_px >= kPairedShare * length) paired += length;
    }
    return all > 0 ? paired / all : 0;
  }
  /// Two pen lines with something between are furniture more often than the two faces of a solid fill are.
  [[nodiscard]] double filled_from(std::size_t i) const {
    return lines_[i].solid_face || bold(i) || heavy(i) ? filled_from_ : kPenFillFactor * filled_from_;
  }
  /// A wall in itself.
  [[nodiscard]] bool bold(std::size_t i) const {
    return !lines_[i].solid_face && lines_[i].stroke_px >= style_.bold_px;
  }
  /// Lines thinner than the pen of the walls must be longer: draughtsmen draw furniture with a finer one.
  [[nodiscard]] double thin_pen(std::size_t i) const {
    return !lines_[i].solid_face && lines_[i].stroke_px < style_.finer_than_px ? kFinePenFactor : 1;
  }
  /// Drawn with the pen of the walls, where much else is drawn with a finer one.
  [[nodiscard]] bool heavy(std::size_t i) const { return style_.pens_differ && thin_pen(i) == 1; }
  [[nodiscard]] bool stands_alone(std::size_t i) const {
    const double length = units_[i].length;
    const Evidence& e = units_[i].evidence;
    const double width = std::max(e.width_px, 0.4 * t_) * thin_pen(i);
    const bool own = evidence_[i].paired_px > 0;
    if (own && e.filled_px >= filled_from(i) * e.width_px && e.filled_px >= kPairedShare * length)
      return true;
    if (own && e.paired_px >= paired_from_ * width && e.paired_px >= kPairedShare * length) return true;
    return !filled_style_ && length >= long_from_ * t_ * thin_pen(i);
  }
  [[nodiscard]] bool hangs_on_walls(std::size_t i) const {
    const PixelSegment& s = lines_[i].segment;
    const double length = units_[i].length;
    const Evidence& e = units_[i].evidence;
    const double width = std::max(e.width_px, 0.4 * t_) * thin_pen(i);
    const bool own = evidence_[i].paired_px > 0;
    const bool filled =
        own && e.filled_px >= kPairedShare * length && length >= 0.4 * filled_from(i) * e.width_px;
    const bool paired = own && e.paired_px >= kPairedShare * length &&
                        length >= (heavy(i) ? kHeavyStub : 0.5 * paired_from_) * width;
    const bool cap = length <= std::max(style_.widest_empty_px, style_.widest_filled_px);
    const bool held = length >= (filled_style_ ? kLongFrom : held_from_) * t_ * thin_pen(i);
    if (own && filled_style_ && length >= kLonelySolid * t_ && e.paired_px >= kPairedShare * length &&
        goes_on(i))
      return true;
    if (!filled && !paired && !cap && !held) return false;
    const double reach = cap ? 0.3 * t_ + 2 : kEndReach * t_;
    if (cap && !filled && !paired && !held) return ends_wall(i, reach);
    const int ends = (meets_wall(i, s.u1, s.v1, reach) ? 1 : 0) + (meets_wall(i, s.u2, s.v2, reach) ? 1 : 0);
    if (filled || paired) return ends >= (filled || heavy(i) || !filled_style_ ? 1 : 2);
    if (ends == 0 && !held) return false;
    return ends == 2 ||
           ((ends == 1 || carries_wall(i)) && length >= (filled_style_ ? kLongFrom : 1.5 * held_from_) * t_);
  }
  /// Beside filled walls, short pieces that no other wall continues are furniture: a wall cut by doors goes
  /// on behind them, a cupboard does not.
  void drop_lonely_pieces() {
    std::vector<bool> lonely(lines_.size(), false);
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      if (!lines_[i].solid_face && heavy(i)) continue;
      const double shortest = lines_[i].solid_face ? kLonelySolid * t_
                              : bold(i)            ? kLonelyBold * lines_[i].stroke_px
                                                   : kLonelyPen * t_;
      lonely[i] = wall_[i] && units_[i].length < shortest && !goes_on(i);
    }
    for (std::size_t i = 0; i < lines_.size(); ++i) wall_[i] = wall_[i] && !lonely[i];
  }
  /// A wall on the same straight line begins no further than a doorway from an end.
  [[nodiscard]] bool goes_on(std::size_t self) const {
    const double within = kDoorway * t_;
    const FittedLine axis = line_through(lines_[self].segment);
    const double half = 0.5 * lines_[self].length_px();
    bool met = false;
    index_.near(lines_[self].segment, within, [&](std::size_t j) {
      if (met || j == self || !wall_[j] || lines_[j].length_px() < kGoesOnFrom * t_ ||
          angle_between(lines_[self].angle_rad(), lines_[j].angle_rad()) > kGoesOnTurn)
        return;
      const PixelSegment& s = lines_[j].segment;
      const double a = axis.along(s.u1, s.v1), b = axis.along(s.u2, s.v2);
      const double gap = std::max(std::min(a, b), -std::max(a, b)) - half;
      const double off = std::min(std::abs(axis.across(s.u1, s.v1)), std::abs(axis.across(s.u2, s.v2)));
      met = gap > -kGoesOnOff * t_ && gap < within && off < kGoesOnOff * t_;
    });
    return met;
  }
  /// Both ends of this short line are at the ends of wall faces that it does not run along: it closes a wall.
  [[nodiscard]] bool ends_wall(std::size_t self, double reach) const {
    const PixelSegment& own = lines_[self].segment;
    const auto at_end = [&](double u, double v) {
      bool met = false;
      index_.near(u, v, reach, [&](std::size_t j) {
        const PixelSegment& s = lines_[j].segment;
        met = met || (j != self && wall_[j] &&
                      angle_between(lines_[self].angle_rad(), lines_[j].angle_rad()) > 0.5 &&
                      std::min(std::hypot(s.u1 - u, s.v1 - v), std::hypot(s.u2 - u, s.v2 - v)) <= reach);
      });
      return met;
    };
    return at_end(own.u1, own.v1) && at_end(own.u2, own.v2);
  }
  /// A wall ends on this line, somewhere between its own ends.
  [[nodiscard]] bool carries_wall(std::size_t self) const {
    const PixelSegment& own = lines_[self].segment;
    bool met = false;
    index_.near(own, t_, [&](std::size_t j) {
      const PixelSegment& s = lines_[j].segment;
      met = met ||
            (j != self && wall_[j] && angle_between(lines_[self].angle_rad(), lines_[j].angle_rad()) > 0.5 &&
             (passes(own, s.u1, s.v1, 0.5 * t_) || passes(own, s.u2, s.v2, 0.5 * t_)));
    });
    return met;
  }
  [[nodiscard]] bool meets_wall(std::size_t self, double u, double v, double reach) const {
    bool met = false;
    index_.near(u, v, reach, [&](std::size_t j) {
      met = met || (j != self && wall_[j] && passes(lines_[j].segment, u, v, reach));
    });
    return met;
  }

  const DrawnLines& lines_;
  const std::vector<Evidence>& evidence_;
  const WallStyle& style_;
  std::vector<Unit> units_;
  double t_;
  double paired_from_ = kPairedFromCluttered;
  double filled_from_ = kFilledFromCluttered;
  bool filled_style_ = false;
  double long_from_ = kLongFrom;
  double held_from_ = kHeldFromCluttered;
  LineIndex index_;
  std::vector<bool> wall_;
};

}  // namespace

void sort_lines(DrawnLines& lines, const std::vector<Evidence>& evidence, const WallStyle& style) {
  const auto wall = Sorter(lines, evidence, style).run();
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!wall[i] && !lines[i].rejected) lines[i].rejected = RejectReason::Furniture;
}

}  // namespace madori::mapping
