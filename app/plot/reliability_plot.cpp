#include "app/plot/reliability_plot.hpp"

#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "app/plot/map_canvas.hpp"

namespace madori::app {
namespace {

using localization::WallState;

Segment2<Map> beside(const Segment2<Map>& s, double offset_m) {
  const double length = s.length_m();
  const double dx = -(s.b.y_m - s.a.y_m) / length * offset_m;
  const double dy = (s.b.x_m - s.a.x_m) / length * offset_m;
  return {{s.a.x_m + dx, s.a.y_m + dy}, {s.b.x_m + dx, s.b.y_m + dy}};
}

Point2<Map> middle(const Segment2<Map>& s) {
  return {0.5 * (s.a.x_m + s.b.x_m), 0.5 * (s.a.y_m + s.b.y_m)};
}

void draw(MapCanvas& canvas, const Segment2<Map>& s, WallState state, double offset_m) {
  switch (state) {
    case WallState::Unseen:
      return canvas.line(s, colours::kPale, 2);
    case WallState::Confirmed:
      return canvas.line(s, colours::kBlue, 4);
    case WallState::Missing:
      canvas.dashed(s, colours::kVermillion, 2);
      return canvas.cross(middle(s), colours::kVermillion, 4);
    case WallState::Displaced: {
      const Segment2<Map> seen = beside(s, offset_m);
      canvas.line(s, colours::kOrange, 1);
      canvas.line({middle(s), middle(seen)}, colours::kOrange, 1);
      return canvas.line(seen, colours::kOrange, 4);
    }
  }
}

std::string entry_text(const char* what, double metres, double all_m) {
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%s: %.0f m (%.0f %%)", what, metres,
                all_m > 0.0 ? 100.0 * metres / all_m : 0.0);
  return text.data();
}

}  // namespace

std::vector<std::uint8_t> reliability_plot(const mapping::Walls& walls,
                                           const localization::WallReliability& reliability) {
  MapCanvas canvas(walls, {});
  std::array<double, 4> length_m{};
  double all_m = 0.0;
  const auto& cells = reliability.cells().all();
  // In the order of their weight, so that what is right does not hide what is wrong.
  for (const WallState shown :
       {WallState::Unseen, WallState::Confirmed, WallState::Missing, WallState::Displaced}) {
    for (std::size_t c = 0; c < cells.size(); ++c) {
      if (reliability.state(c) != shown) continue;
      draw(canvas, cells[c].segment, shown, reliability.beliefs()[c].offset_m);
      length_m[static_cast<std::size_t>(shown)] += cells[c].segment.length_m();
      all_m += cells[c].segment.length_m();
    }
  }
  canvas.title("What the lidar has seen of the drawn walls");
  canvas.legend(
      {{Mark::Line, colours::kBlue, 4, entry_text("confirmed where drawn", length_m[1], all_m)},
       {Mark::Crossed, colours::kVermillion, 2, entry_text("missing: seen through", length_m[2], all_m)},
       {Mark::Line, colours::kOrange, 4,
        entry_text("displaced: thick where it stands, thin where it is drawn", length_m[3], all_m)},
       {Mark::Line, colours::kPale, 2, entry_text("not seen yet", length_m[0], all_m)}});
  return canvas.png();
}

nlohmann::json to_json(const localization::WallReliability& reliability) {
  nlohmann::json result;
  for (const WallState state :
       {WallState::Unseen, WallState::Confirmed, WallState::Missing, WallState::Displaced}) {
    double metres = 0.0;
    for (std::size_t c = 0; c < reliability.cells().size(); ++c)
      if (reliability.state(c) == state) metres += reliability.cells().all()[c].segment.length_m();
    result[std::string(localization::to_string(state)) + "_m"] = metres;
  }
  return result;
}

}  // namespace madori::app
