#include "mapping/picture/reduce.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>

#include "mapping/picture/cv_view.hpp"

namespace madori::mapping {
namespace {

/// Which pixels of a longer row a pixel of a shorter one covers, and how much of it each of them is.
class Cover {
 public:
  Cover(int from, int to) : first_(static_cast<std::size_t>(to)) {
    const double ratio = 1 / (static_cast<double>(to) / from);  // as OpenCV rounds it
    taps_ = std::max<std::size_t>(3, static_cast<std::size_t>(std::ceil(ratio)) + 1);
    share_.assign(taps_ * first_.size(), 0);
    for (int i = 0; i < to; ++i) {
      const double begin = i * ratio, end = begin + ratio, size = std::min(ratio, from - begin);
      const int last = std::min(static_cast<int>(std::floor(end)), from - 1);
      const int whole = std::min(static_cast<int>(std::ceil(begin)), last);
      const bool starts_before = whole - begin > kSliver;
      std::size_t tap = 0;
      const auto add = [&](double share) {
        share_[tap++ * first_.size() + static_cast<std::size_t>(i)] = static_cast<float>(share);
      };
      first_[static_cast<std::size_t>(i)] = starts_before ? whole - 1 : whole;
      if (starts_before) add((whole - begin) / size);
      for (int k = whole; k < last; ++k) add(1.0 / size);
      if (end - last > kSliver) add(std::min(std::min(end - last, 1.0), size) / size);
    }
  }

  [[nodiscard]] std::size_t size() const { return first_.size(); }
  [[nodiscard]] std::size_t taps() const { return taps_; }
  [[nodiscard]] int first(std::size_t i) const { return first_[i]; }
  /// 0 where a pixel covers fewer.
  [[nodiscard]] float share(std::size_t i, std::size_t tap) const { return share_[tap * first_.size() + i]; }

  /// The shorter row; behind the longer one lie as many zeros as there are taps.
  void sum(const float* row, float* out) const {
    const std::size_t count = first_.size();
    const float *one = share_.data(), *two = one + count, *three = two + count;
    for (std::size_t i = 0; i < count; ++i) {
      const float* const at = row + first_[i];
      float sum = at[0] * one[i] + at[1] * two[i] + at[2] * three[i];
      for (std::size_t tap = 3; tap < taps_; ++tap) sum += at[tap] * share_[tap * count + i];
      out[i] = sum;
    }
  }

 private:
  static constexpr double kSliver = 1e-3;  // of a pixel: OpenCV leaves less than that out

  std::size_t taps_ = 0;  // sum() asks three at least
  std::vector<int> first_;
  std::vector<float> share_;  // tap by tap
};

/// Sums the rows of a picture, each of them once.
class Rows {
 public:
  Rows(const GrayImage& image, const std::array<std::uint8_t, 256>& table, const Cover& across)
      : image_(image),
        across_(across),
        levels_(static_cast<std::size_t>(image.width_px) + across.taps(), 0),
        sums_(across.size()) {
    std::copy(table.begin(), table.end(), level_of_.begin());
  }

  [[nodiscard]] const std::vector<float>& row(int v) {
    if (v == last_) return sums_;
    const auto width = static_cast<std::size_t>(image_.width_px);
    const std::uint8_t* const pixels = &image_.pixels[static_cast<std::size_t>(v) * width];
    for (std::size_t u = 0; u < width; ++u) levels_[u] = level_of_[pixels[u]];
    across_.sum(levels_.data(), sums_.data());
    last_ = v;
    return sums_;
  }

 private:
  const GrayImage& image_;
  const Cover& across_;
  std::array<float, 256> level_of_{};
  std::vector<float> levels_, sums_;
  int last_ = -1;
};

/// OpenCV sums whole numbers where both ratios are whole, and rounds those otherwise.
bool is_whole(int from, int to) {
  return from % to == 0;
}

}  // namespace

std::vector<std::uint8_t> reduced(const GrayImage& image, const std::array<std::uint8_t, 256>& table,
                                  int width_px, int height_px) {
  std::vector<std::uint8_t> out(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  cv::Mat target(height_px, width_px, CV_8UC1, out.data());
  if (is_whole(image.width_px, width_px) && is_whole(image.height_px, height_px)) {
    cv::Mat levels;
    cv::LUT(cv_view(image), table, levels);
    cv::resize(levels, target, target.size(), 0, 0, cv::INTER_AREA);
    return out;
  }
  const Cover across(image.width_px, width_px), down(image.height_px, height_px);
  cv::parallel_for_({0, height_px}, [&](const cv::Range& some) {
    Rows rows(image, table, across);
    std::vector<float> sums(across.size());
    for (int v = some.start; v < some.end; ++v) {
      const auto i = static_cast<std::size_t>(v);
      std::fill(sums.begin(), sums.end(), 0.0F);
      for (std::size_t tap = 0; tap < down.taps() && down.share(i, tap) > 0; ++tap) {
        const float share = down.share(i, tap);
        const std::vector<float>& row = rows.row(down.first(i) + static_cast<int>(tap));
#pragma omp simd
        for (std::size_t u = 0; u < sums.size(); ++u) sums[u] += share * row[u];
      }
      cv::Mat(1, width_px, CV_32FC1, sums.data()).convertTo(target.row(v), CV_8U);
    }
  });
  return out;
}

}  // namespace madori::mapping
