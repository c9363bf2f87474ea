#include "mapping/drawing/raster/text_marks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <unordered_map>

#include "core/median.hpp"

namespace madori::mapping {
namespace {

constexpr double kLargestShare = 0.035;  // of the picture: larger marks are no letters
constexpr double kLargestInPens = 45;
constexpr double kSmallestInPens = 2.5;
constexpr double kLikeSize = 2.2;      // "-" and "i" beside "M"
constexpr double kReachInSizes = 1.5;  // between the middles of neighbouring letters
constexpr double kBarLike = 5;         // I and 1 are; a word of bars alone is a row of dashes
constexpr std::size_t kFewestLetters = 3;

bool can_be_letter(const Component& mark, double pen_px, int picture_size_px) {
  const double size = mark.size();
  return size >= kSmallestInPens * pen_px && size <= kLargestInPens * pen_px &&
         size <= kLargestShare * picture_size_px && std::min(mark.width(), mark.height()) >= 1;
}

/// Square cells as large as a letter's reach, for the search of neighbours.
class Cells {
 public:
  explicit Cells(double size) : size_(size) {}
  void add(const Component& c, std::size_t index) {
    cells_[key(c.middle_u, c.middle_v, 0, 0)].push_back(index);
  }
  template <class Visit>
  void around(const Component& c, Visit visit) const {
    for (int dv = -1; dv <= 1; ++dv)
      for (int du = -1; du <= 1; ++du)
        if (const auto cell = cells_.find(key(c.middle_u, c.middle_v, du, dv)); cell != cells_.end())
          for (const std::size_t i : cell->second) visit(i);
  }

 private:
  [[nodiscard]] std::int64_t key(double u, double v, int du, int dv) const {
    return (static_cast<std::int64_t>(v / size_) + dv) * (std::int64_t{1} << 32) +
           static_cast<std::int64_t>(u / size_) + du;
  }
  double size_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

bool neighbours(const Component& a, const Component& b) {
  const double larger = std::max(a.size(), b.size()), smaller = std::min(a.size(), b.size());
  if (larger > kLikeSize * smaller) return false;
  const double apart_u = std::max({0, b.left - a.right, a.left - b.right});
  const double apart_v = std::max({0, b.top - a.bottom, a.top - b.bottom});
  if (std::max(apart_u, apart_v) > 0.6 * larger) return false;
  return std::hypot(a.middle_u - b.middle_u, a.middle_v - b.middle_v) <= kReachInSizes * larger;
}

TextGroup describe(const Components& marks, std::vector<std::size_t> members) {
  TextGroup group;
  const auto count = static_cast<double>(members.size());
  std::vector<int> sizes;
  for (const std::size_t i : members) {
    const Component& c = marks.all()[i];
    group.middle_u += 0.5 * (c.left + c.right) / count;
    group.middle_v += 0.5 * (c.top + c.bottom) / count;
    sizes.push_back(c.size());
  }
  double uu = 0, uv = 0, vv = 0;
  for (const std::size_t i : members) {
    const double du = marks.all()[i].middle_u - group.middle_u, dv = marks.all()[i].middle_v - group.middle_v;
    uu += du * du;
    uv += du * dv;
    vv += dv * dv;
  }
  group.angle_rad = 0.5 * std::atan2(2 * uv, uu - vv);
  group.height_px = median_of(sizes);
  const double spread = 0.5 * (uu + vv) + std::hypot(0.5 * (uu - vv), uv);
  group.length_px = std::sqrt(12 * spread / count) + group.height_px;
  group.marks = std::move(members);
  return group;
}

}  // namespace

std::vector<TextGroup> find_text(const Components& marks, const std::vector<bool>& taken, double pen_px,
                                 int picture_size_px) {
  const auto& all = marks.all();
  const double largest = std::min(kLargestInPens * pen_px, kLargestShare * picture_size_px);
  Cells cells(std::max(1.0, kReachInSizes * largest));
  std::vector<std::size_t> letters;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (taken[i] || !can_be_letter(all[i], pen_px, picture_size_px)) continue;
    letters.push_back(i);
    cells.add(all[i], i);
  }
  std::unordered_map<std::size_t, bool> seen;
  std::vector<TextGroup> groups;
  for (const std::size_t first : letters) {
    if (seen[first]) continue;
    seen[first] = true;
    std::vector<std::size_t> members{first};
    for (std::size_t next = 0; next < members.size(); ++next)
      cells.around(all[members[next]], [&](std::size_t other) {
        if (seen[other] || !neighbours(all[members[next]], all[other])) return;
        seen[other] = true;
        members.push_back(other);
      });
    const auto bars = std::count_if(members.begin(), members.end(), [&](std::size_t i) {
      return all[i].long_px > kBarLike * all[i].short_px;
    });
    if (members.size() >= kFewestLetters && 2 * static_cast<std::size_t>(bars) <= members.size())
      groups.push_back(describe(marks, std::move(members)));
  }
  return groups;
}

}  // namespace madori::mapping
