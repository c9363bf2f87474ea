#include "mapping/drawing/raster/settle_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/core/utility.hpp>
#include <vector>

#include "core/median.hpp"
#include "mapping/drawing/raster/edge_profile.hpp"
#include "mapping/drawing/raster/line_fit.hpp"

namespace madori::mapping {
namespace {

constexpr double kReach = 1.5;   // pixels of the lines: a line moves no further
constexpr double kBeyond = 2.5;  // pixels of paper beside a stroke, or of both sides of a face, looked at
constexpr double kStep = 0.5;    // across, pixels of the finer picture
constexpr double kAlong = 2;     // pixels between samples
constexpr int kMostSamples = 300;
constexpr std::size_t kFewest = 5, kFewestToTurn = 12;
constexpr double kLeastShare = 0.25;      // of the samples
constexpr double kAside = 0.5;            // pixels from the median: a sample on something else
constexpr double kMostTurn = kReach / 2;  // pixels at the ends

struct Sample {
  double along = 0, offset = 0;
  bool ink_follows = false;
};

class Settler {
 public:
  explicit Settler(const GreyDrawing& drawing) : drawing_(drawing) {}

  void settle(DrawnLine& line) {
    const FittedLine axis = line_through(line.segment);
    take_samples(line, axis);
    if (line.solid_face) keep_common_side();
    if (!keep_about_median()) return;
    const double half = 0.5 * line.length_px();
    const auto [shift, turn] = moved(half);
    const double first = shift - turn * half, last = shift + turn * half;
    PixelSegment& s = line.segment;
    const cv::Point2d a = axis.at(-half, first), b = axis.at(half, last);
    s = {a.x, a.y, b.x, b.y};
  }

 private:
  /// Bilinear; beyond the border the border goes on. Pixels of the lines.
  [[nodiscard]] float darkness_at(const cv::Point2d& p) const {
    const GrayImage& image = drawing_.image;
    const double x = std::clamp(p.x * drawing_.scale.x - 0.5, 0.0, image.width_px - 1.0);
    const double y = std::clamp(p.y * drawing_.scale.y - 0.5, 0.0, image.height_px - 1.0);
    const int x0 = std::min(static_cast<int>(x), std::max(0, image.width_px - 2));
    const int y0 = std::min(static_cast<int>(y), std::max(0, image.height_px - 2));
    const int x1 = std::min(x0 + 1, image.width_px - 1), y1 = std::min(y0 + 1, image.height_px - 1);
    const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const auto dark = [&](int at_x, int at_y) {
      return static_cast<float>(drawing_.bright_lines ? image.at(at_x, at_y) : 255 - image.at(at_x, at_y));
    };
    const float above = (1 - fx) * dark(x0, y0) + fx * dark(x1, y0);
    const float below = (1 - fx) * dark(x0, y1) + fx * dark(x1, y1);
    return (1 - fy) * above + fy * below;
  }

  void take_profile(const FittedLine& axis, double along, double half_width) {
    profile_.step_px = kStep / std::max(1.0, drawing_.scale.x);
    const int steps = static_cast<int>(std::ceil(half_width / profile_.step_px));
    profile_.first_px = -steps * profile_.step_px;
    profile_.darkness.clear();
    for (int k = -steps; k <= steps; ++k)
      profile_.darkness.push_back(darkness_at(axis.at(along, k * profile_.step_px)));
  }

  void take_samples(const DrawnLine& line, const FittedLine& axis) {
    samples_.clear();
    const double length = line.length_px();
    taken_ = std::clamp(static_cast<int>(length / kAlong), 1, kMostSamples);
    const double half_width = kReach + kBeyond + (line.solid_face ? 0 : 0.5 * line.stroke_px);
    for (int i = 0; i < taken_; ++i) {
      const double along = ((i + 0.5) / taken_ - 0.5) * length;
      take_profile(axis, along, half_width);
      const auto place =
          line.solid_face ? face_place(profile_, kReach) : stroke_place(profile_, kReach, line.stroke_px);
      if (place) samples_.push_back({along, place->offset_px, place->ink_follows});
    }
  }

  void keep_common_side() {
    const auto following = static_cast<std::size_t>(
        std::count_if(samples_.begin(), samples_.end(), [](const Sample& s) { return s.ink_follows; }));
    const bool side = 2 * following > samples_.size();
    std::erase_if(samples_, [&](const Sample& s) { return s.ink_follows != side; });
  }

  /// False where too little is left to trust.
  [[nodiscard]] bool keep_about_median() {
    if (samples_.empty()) return false;
    std::vector<double> offsets;
    for (const Sample& s : samples_) offsets.push_back(s.offset);
    const double median = median_of(offsets);
    std::erase_if(samples_, [&](const Sample& s) { return std::abs(s.offset - median) > kAside; });
    return samples_.size() >= kFewest &&
           static_cast<double>(samples_.size()) >= kLeastShare * static_cast<double>(taken_);
  }

  struct Move {
    double shift = 0, turn = 0;  // at the middle of the line; per pixel along it
  };

  /// Least squares; a line seen over too little of its length is only shifted.
  [[nodiscard]] Move moved(double half) const {
    const auto count = static_cast<double>(samples_.size());
    double along = 0, offset = 0, aa = 0, ao = 0;
    for (const Sample& s : samples_) {
      along += s.along / count;
      offset += s.offset / count;
    }
    for (const Sample& s : samples_) {
      aa += (s.along - along) * (s.along - along);
      ao += (s.along - along) * (s.offset - offset);
    }
    const bool spread = samples_.size() >= kFewestToTurn && aa > count * half * half / 12;
    const double turn = spread ? ao / aa : 0;
    if (std::abs(turn) * half > kMostTurn) return {offset, 0};
    return {offset - turn * along, turn};
  }

  const GreyDrawing& drawing_;
  EdgeProfile profile_;
  std::vector<Sample> samples_;
  int taken_ = 0;
};

}  // namespace

void settle_lines(DrawnLines& lines, const GreyDrawing& drawing) {
  if (drawing.image.empty()) return;
  cv::parallel_for_({0, static_cast<int>(lines.size())}, [&](const cv::Range& some) {
    Settler settler(drawing);
    for (int i = some.start; i < some.end; ++i)
      if (DrawnLine& line = lines[static_cast<std::size_t>(i)]; !line.rejected && line.length_px() > 0)
        settler.settle(line);
  });
}

}  // namespace madori::mapping
