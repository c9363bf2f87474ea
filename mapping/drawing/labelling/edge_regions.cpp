#include "mapping/drawing/labelling/edge_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

namespace madori::mapping {
namespace {

constexpr float kBarrier = 1.2F;  // pixels: edges seal corners that miss each other by a pixel or two
constexpr double kBeside = 3;     // pixels off an edge its regions begin

class Areas {
 public:
  explicit Areas(const EdgeSheet& sheet) : sheet_(sheet) {
    const cv::Mat clear(sheet.grey.height_px, sheet.grey.width_px, CV_32FC1,
                        const_cast<float*>(sheet.clear_px.data()));
    const cv::Mat open = clear > kBarrier;
    cv::Mat stats, middles;
    const int count = cv::connectedComponentsWithStats(open, labels_, stats, middles, 4, CV_32S);
    std::vector<double> grey(static_cast<std::size_t>(count));
    for (int v = 0; v < labels_.rows; ++v)
      for (int u = 0; u < labels_.cols; ++u)
        grey[static_cast<std::size_t>(labels_.at<int>(v, u))] += sheet.grey.at(u, v);
    for (int k = 0; k < count; ++k) {
      const int width = stats.at<int>(k, cv::CC_STAT_WIDTH), height = stats.at<int>(k, cv::CC_STAT_HEIGHT);
      const int left = stats.at<int>(k, cv::CC_STAT_LEFT), top = stats.at<int>(k, cv::CC_STAT_TOP);
      const double area = stats.at<int>(k, cv::CC_STAT_AREA);
      all_.push_back({area, static_cast<double>(width) * height, static_cast<double>(std::min(width, height)),
                      static_cast<double>(std::max(width, height)),
                      grey[static_cast<std::size_t>(k)] / std::max(1.0, area),
                      left == 0 || top == 0 || left + width == labels_.cols || top + height == labels_.rows});
    }
  }

  /// The region that most places beside the edge lie in; none where they lie between edges.
  [[nodiscard]] Region beside(const Edge& edge, double side) const {
    std::map<int, int> votes;
    const int places = std::clamp(static_cast<int>(edge.length_px / 6), 3, 9);
    for (int k = 0; k < places; ++k) {
      const double t = (k + 0.5) / places;
      const double u = std::lerp(edge.segment.u1, edge.segment.u2, t) + side * kBeside * edge.normal_u;
      const double v = std::lerp(edge.segment.v1, edge.segment.v2, t) + side * kBeside * edge.normal_v;
      if (!sheet_.inside(u, v)) continue;
      const int label = labels_.at<int>(static_cast<int>(v), static_cast<int>(u));
      if (label > 0) ++votes[label];
    }
    if (votes.empty()) return {};
    const auto most = std::max_element(votes.begin(), votes.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return all_[static_cast<std::size_t>(most->first)];
  }

 private:
  const EdgeSheet& sheet_;
  cv::Mat labels_;
  std::vector<Region> all_;
};

}  // namespace

std::vector<EdgeRegions> regions_beside(const EdgeSheet& sheet) {
  const Areas areas(sheet);
  std::vector<EdgeRegions> regions;
  for (const Edge& edge : sheet.edges) regions.push_back({areas.beside(edge, 1), areas.beside(edge, -1)});
  return regions;
}

}  // namespace madori::mapping
