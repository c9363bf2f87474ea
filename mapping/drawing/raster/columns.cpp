#include "mapping/drawing/raster/columns.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace madori::mapping {
namespace {

constexpr double kSmallestInPens = 3, kLargestInPens = 30;
constexpr double kLeastFill = 0.86;  // of the rectangle around it; a disc has 0.79
constexpr double kMostOblong = 1.35;
constexpr double kLikeSize = 0.12;
constexpr double kApart = 4;  // sides, between the nearest two
constexpr std::size_t kFewest = 4;
constexpr double kLetterGap = 0.5, kLetterSize = 1.5;  // of a mark's size: the next letter of a word
constexpr double kBar = 3;                             // times as long as wide
constexpr int kMargin = 3;

using Masks = std::map<int, cv::Mat>;

/// The candidates' ink, each in its own small picture with a margin.
Masks draw_candidates(const Components& marks, const std::vector<bool>& taken, double pen_px) {
  Masks masks;
  const auto candidate = [&](std::size_t i) {
    const Component& c = marks.all()[i];
    return !taken[i] && c.size() >= kSmallestInPens * pen_px && c.size() <= kLargestInPens * pen_px &&
           std::min(c.width(), c.height()) * 4 >= c.size();
  };
  for (const Run& run : marks.runs()) {
    if (!candidate(static_cast<std::size_t>(run.component))) continue;
    const Component& c = marks.all()[static_cast<std::size_t>(run.component)];
    cv::Mat& mask = masks[run.component];
    if (mask.empty()) mask = cv::Mat::zeros(c.height() + 2 * kMargin, c.width() + 2 * kMargin, CV_8UC1);
    auto* row = mask.ptr<std::uint8_t>(run.v - c.top + kMargin) + (kMargin - c.left);
    std::fill(row + run.first, row + run.last + 1, std::uint8_t{255});
  }
  return masks;
}

/// The square that is left when holes are filled and thin lines cut off.
std::optional<cv::RotatedRect> square_in(cv::Mat& mask) {
  cv::Mat outside = mask.clone();
  cv::floodFill(outside, {0, 0}, cv::Scalar(255));
  mask |= ~outside;
  const auto box = cv::getStructuringElement(cv::MORPH_RECT, {5, 5});
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, box);
  std::vector<cv::Point> pixels;
  cv::findNonZero(mask, pixels);
  if (pixels.size() < 25) return std::nullopt;
  cv::RotatedRect square = cv::minAreaRect(pixels);
  square.size.width += 1;
  square.size.height += 1;
  const double longer = std::max(square.size.width, square.size.height);
  const double shorter = std::min(square.size.width, square.size.height);
  if (longer > kMostOblong * shorter) return std::nullopt;
  if (static_cast<double>(pixels.size()) < kLeastFill * longer * shorter) return std::nullopt;
  return square;
}

struct Square {
  cv::RotatedRect place;
  double side = 0;
};

bool recurs(const Square& self, const std::vector<Square>& all) {
  std::size_t alike = 0;
  double nearest = 1e18;
  for (const Square& other : all) {
    if (std::abs(other.side - self.side) > kLikeSize * self.side + 1) continue;
    ++alike;
    const double apart = cv::norm(other.place.center - self.place.center);
    if (apart > 0) nearest = std::min(nearest, apart);
  }
  return alike >= kFewest && nearest >= kApart * self.side;
}

/// A letter of like size close by: an R with its holes filled is a square, but it stands before an M. Bars
/// are the dashes of an axis, and `taken` marks have their meaning already.
bool beside_letter(std::size_t self, const std::vector<Component>& all, const std::vector<bool>& taken) {
  const Component& own = all[self];
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Component& other = all[i];
    if (i == self || taken[i] || other.long_px > kBar * other.short_px ||
        other.size() > kLetterSize * own.size() || own.size() > kLetterSize * other.size())
      continue;
    const int apart_u = std::max({0, other.left - own.right, own.left - other.right});
    const int apart_v = std::max({0, other.top - own.bottom, own.top - other.bottom});
    if (std::max(apart_u, apart_v) <= kLetterGap * own.size()) return true;
  }
  return false;
}

Column column_at(const Square& square, const Component& c) {
  cv::Point2f corners[4];
  square.place.points(corners);
  const double u0 = c.left - kMargin + 0.5, v0 = c.top - kMargin + 0.5;
  Column column{square.side, {}};
  for (std::size_t k = 0; k < 4; ++k) {
    const cv::Point2f a = corners[k], b = corners[(k + 1) % 4];
    column.faces[k] = {a.x + u0, a.y + v0, b.x + u0, b.y + v0};
  }
  return column;
}

}  // namespace

std::vector<Column> find_columns(const Components& marks, const std::vector<bool>& taken, double pen_px) {
  std::vector<Square> squares;
  std::vector<int> owners;
  for (auto& [mark, mask] : draw_candidates(marks, taken, pen_px)) {
    const auto place = square_in(mask);
    const Component& c = marks.all()[static_cast<std::size_t>(mark)];
    if (!place || beside_letter(static_cast<std::size_t>(mark), marks.all(), taken)) continue;
    Square square{*place, 0.5 * (place->size.width + place->size.height)};
    square.place.center += cv::Point2f(static_cast<float>(c.left), static_cast<float>(c.top));
    squares.push_back(square);
    owners.push_back(mark);
  }
  std::vector<Column> columns;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (!recurs(squares[i], squares)) continue;
    const Component& c = marks.all()[static_cast<std::size_t>(owners[i])];
    Square local = squares[i];
    local.place.center -= cv::Point2f(static_cast<float>(c.left), static_cast<float>(c.top));
    columns.push_back(column_at(local, c));
  }
  return columns;
}

}  // namespace madori::mapping
