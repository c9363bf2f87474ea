#include "app/landmarks/corridor_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/angle.hpp"

namespace madori::app {
namespace {

constexpr double kWidth = 760.0, kPanel = 240.0, kLeft = 60.0, kTop = 30.0;
constexpr const char* kColours[4] = {"#0072b2", "#009e73", "#d55e00", "#cc79a7"};  // Okabe and Ito

/// One panel of curves over the number of the sighting.
class Panel {
 public:
  Panel(std::string& svg, double top, std::size_t count, double largest, const std::string& title)
      : svg_(&svg), top_(top), count_(count), largest_(std::max(largest, 1e-9)) {
    svg += fmt::format("<text x='{}' y='{}'>{}</text>\n", kLeft, top - 8, title);
    svg += fmt::format("<path d='M{0} {1}V{2}H{3}' fill='none' stroke='#444'/>\n", kLeft, top,
                       top + kPanel - 50, kWidth - 20);
    for (int tick = 0; tick <= 4; ++tick)
      svg += fmt::format("<text x='{}' y='{:.1f}' text-anchor='end'>{:.1f}</text>\n", kLeft - 6,
                         y(largest_ * tick / 4) + 4, 100.0 * largest_ * tick / 4);
    for (std::size_t i = 0; i < count; ++i)
      svg += fmt::format("<text x='{:.1f}' y='{}' text-anchor='middle'>{}</text>\n", x(i), top + kPanel - 34,
                         i + 1);
  }
  /// Values from the first sighting that has one; metres, shown as centimetres.
  void curve(const std::function<double(std::size_t)>& value, std::size_t first, const char* colour,
             bool dashed) {
    std::string path;
    for (std::size_t i = first; i < count_; ++i)
      path += fmt::format("{}{:.1f} {:.1f}", i == first ? "M" : "L", x(i), y(value(i)));
    *svg_ += fmt::format("<path d='{}' fill='none' stroke='{}' stroke-width='2'{}/>\n", path, colour,
                         dashed ? " stroke-dasharray='5 4'" : "");
  }
  void name(int row, const std::string& text, const char* colour) {
    *svg_ += fmt::format("<text x='{}' y='{}' fill='{}'>{}</text>\n", kWidth - 210, top_ + 14 + 16 * row,
                         colour, text);
  }

 private:
  [[nodiscard]] double x(std::size_t i) const {
    return kLeft + 20 + (kWidth - kLeft - 260) * static_cast<double>(i) / static_cast<double>(count_ - 1);
  }
  [[nodiscard]] double y(double value) const { return top_ + (kPanel - 50) * (1.0 - value / largest_); }
  std::string* svg_;
  double top_;
  std::size_t count_;
  double largest_;
};

}  // namespace

std::string corridor_csv(const CorridorRun& run) {
  std::string text =
      "sighting,lap,seen,known,agent_error_m,agent_error_deg,odometry_error_m,odometry_error_deg,landmark,"
      "error_m,sigma_m,"
      "error_deg,sigma_deg,published_error_m,published_sigma_m\n";
  for (std::size_t i = 0; i < run.sightings.size(); ++i) {
    const CornerSighting& s = run.sightings[i];
    for (std::size_t k = 0; k < s.landmarks.size(); ++k) {
      const LandmarkState& l = s.landmarks[k];
      text += fmt::format(
          "{},{},{},{},{:.5f},{:.4f},{:.5f},{:.4f},{},{:.5f},{:.5f},{:.4f},{:.4f},{:.5f},{:.5f}\n", i + 1,
          s.lap, s.landmark, s.known ? 1 : 0, s.agent_error_m, to_deg(s.agent_error_rad), s.odometry_error_m,
          to_deg(s.odometry_error_rad), k, l.error_m, l.sigma_m, to_deg(l.error_rad), to_deg(l.sigma_rad),
          l.published_error_m, l.published_sigma_m);
    }
  }
  return text;
}

std::string corridor_figure(const CorridorRun& run) {
  const auto& sightings = run.sightings;
  std::string svg = fmt::format(
      "<svg xmlns='http://www.w3.org/2000/svg' width='{0}' height='{1}' font-family='sans-serif' "
      "font-size='12'>\n"
      "<rect width='{0}' height='{1}' fill='white'/>\n",
      kWidth, 2 * kPanel + kTop);
  double largest = 0.0, largest_drift = 0.0;
  for (const CornerSighting& s : sightings) {
    for (const LandmarkState& l : s.landmarks) largest = std::max({largest, l.error_m, 2.0 * l.sigma_m});
    largest_drift = std::max({largest_drift, s.odometry_error_m, s.agent_error_m});
  }
  Panel landmarks(svg, kTop, sightings.size(), largest,
                  "Landmarks: position error (solid) and 2 U (dashed), cm, after each scan at a corner");
  for (std::size_t k = 1; k < sightings.back().landmarks.size(); ++k) {
    std::size_t first = 0;
    while (sightings[first].landmarks.size() <= k) ++first;
    const char* colour = kColours[k % 4];
    landmarks.curve([&](std::size_t i) { return sightings[i].landmarks[k].error_m; }, first, colour, false);
    landmarks.curve([&](std::size_t i) { return 2.0 * sightings[i].landmarks[k].sigma_m; }, first, colour,
                    true);
    landmarks.name(static_cast<int>(k), fmt::format("landmark {}", k + 1), colour);
  }
  Panel agent(svg, kTop + kPanel, sightings.size(), largest_drift, "Agent: position error, cm");
  agent.curve([&](std::size_t i) { return sightings[i].odometry_error_m; }, 0, kColours[2], false);
  agent.curve([&](std::size_t i) { return sightings[i].agent_error_m; }, 0, kColours[0], false);
  agent.name(0, "odometry alone", kColours[2]);
  agent.name(1, "with landmarks", kColours[0]);
  return svg + "</svg>\n";
}

}  // namespace madori::app
