#include "app/trajectory_plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "app/plot/map_canvas.hpp"

namespace madori::app {
namespace {

constexpr double kJumpM = 2.0;  // a pose this far from its forerunner was found anew: no line between
constexpr double kEllipseEveryM = 3.0;
constexpr double kMarkEveryM = 0.4;
constexpr double kSigmas = 2.0;
constexpr double kLongestEllipseM = 3.0;

/// The four states in their order.
constexpr std::array<Colour, 4> kColours{colours::kGreen, colours::kOrange, colours::kBlue,
                                         colours::kVermillion};
constexpr std::array<Mark, 4> kMarks{Mark::Line, Mark::Dashed, Mark::Dot, Mark::Crossed};

const Colour& colour_of(LocalizationState state) {
  return kColours[static_cast<std::size_t>(state)];
}

/// Draws the way step by step; marks and ellipses every so many metres.
class WayPainter {
 public:
  explicit WayPainter(MapCanvas& canvas) : canvas_(canvas) {}

  void step(const PoseEstimate& from, const PoseEstimate& to) {
    const Segment2<Map> s{from.map_from_base.translation(), to.map_from_base.translation()};
    if (s.length_m() > kJumpM) return;
    way_m_ += s.length_m();
    const Colour& colour = colour_of(to.health.state);
    switch (to.health.state) {
      case LocalizationState::Localized:
        return canvas_.line(s, colour, 2);
      case LocalizationState::Degraded:  // 0.4 m drawn, 0.4 m left out
        if (std::fmod(way_m_, 2.0 * kMarkEveryM) < kMarkEveryM) canvas_.line(s, colour, 3);
        return;
      case LocalizationState::Ambiguous:
      case LocalizationState::Lost:
        if (way_m_ - marked_m_ < kMarkEveryM) return;
        marked_m_ = way_m_;
        return to.health.state == LocalizationState::Lost ? canvas_.cross(s.b, colour, 4)
                                                          : canvas_.dot(s.b, colour, 3);
    }
  }
  void uncertainty(const PoseEstimate& e) {
    if (way_m_ - ellipse_m_ < kEllipseEveryM) return;
    ellipse_m_ = way_m_;
    canvas_.ellipse(e.map_from_base.translation(), e.covariance.topLeftCorner<2, 2>(), kSigmas,
                    kLongestEllipseM, colours::kPurple);
  }

 private:
  MapCanvas& canvas_;
  double way_m_ = 0.0;
  double marked_m_ = -1e9;
  double ellipse_m_ = -1e9;
};

/// The state over time, in equal parts; where nothing is known yet, the paper's colour.
std::vector<Colour> health_strip(const std::vector<PoseEstimate>& estimates) {
  constexpr int kParts = 600;
  std::vector<Colour> parts(kParts, colours::kPaper);
  const auto later = [](const PoseEstimate& a, const PoseEstimate& b) { return a.stamp < b.stamp; };
  const auto [first, last] = std::minmax_element(estimates.begin(), estimates.end(), later);
  const double all_s = std::max(1e-9, to_seconds(last->stamp - first->stamp));
  int painted = 0;
  for (const PoseEstimate& e : estimates) {
    const int part = static_cast<int>((kParts - 1) * to_seconds(e.stamp - first->stamp) / all_s);
    for (; painted <= part; ++painted) parts[static_cast<std::size_t>(painted)] = colour_of(e.health.state);
  }
  return parts;
}

std::vector<LegendEntry> legend_of(const std::vector<PoseEstimate>& estimates) {
  std::vector<LegendEntry> entries;
  for (const LocalizationState state : kLocalizationStates) {
    const auto count = std::count_if(estimates.begin(), estimates.end(),
                                     [&](const PoseEstimate& e) { return e.health.state == state; });
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%s: %.1f %% of the poses", to_string(state),
                  100.0 * static_cast<double>(count) / static_cast<double>(estimates.size()));
    const auto i = static_cast<std::size_t>(state);
    entries.push_back({kMarks[i], kColours[i], 3, text.data()});
  }
  entries.push_back({Mark::Ellipse, colours::kPurple, 1, "uncertainty of the position, 2 sigma, every 3 m"});
  entries.push_back({Mark::Line, colours::kGrey, 2, "the drawing's walls"});
  return entries;
}

}  // namespace

std::vector<std::uint8_t> trajectory_plot(const mapping::Walls& walls,
                                          const std::vector<PoseEstimate>& estimates, int longest_px) {
  std::vector<Point2<Map>> way;
  way.reserve(estimates.size());
  for (const PoseEstimate& e : estimates) way.push_back(e.map_from_base.translation());
  MapCanvas canvas(walls, way, longest_px);
  canvas.walls(walls, colours::kGrey, 2);
  canvas.title("Where the vehicle was on the drawing");
  if (estimates.empty()) return canvas.png();
  WayPainter painter(canvas);
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    painter.step(estimates[i - 1], estimates[i]);
    painter.uncertainty(estimates[i]);
  }
  canvas.dot(way.front(), colours::kInk, 5);
  canvas.text({way.front().x_m + 8.0 / canvas.px_per_m(), way.front().y_m}, "start", colours::kInk);
  canvas.dot(way.back(), colours::kInk, 5);
  canvas.text({way.back().x_m + 8.0 / canvas.px_per_m(), way.back().y_m}, "end", colours::kInk);
  canvas.strip(health_strip(estimates), "health over time");
  canvas.legend(legend_of(estimates));
  return canvas.png();
}

}  // namespace madori::app
