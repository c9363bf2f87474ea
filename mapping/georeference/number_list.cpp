#include "mapping/georeference/number_list.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "core/result.hpp"

namespace madori::mapping {

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  while (true) {
    const std::size_t comma = text.find(',');
    std::string_view field = text.substr(0, comma);
    while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
    while (!field.empty() && field.back() == ' ') field.remove_suffix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !std::isfinite(value))
      return std::nullopt;
    numbers.push_back(value);
    if (comma == std::string_view::npos) return numbers;
    text.remove_prefix(comma + 1);
  }
}

void require_on_drawing(const std::string& where, double u, double v, const DrawingRecord& drawing) {
  const double slack_px = 1.0 + 0.01 * std::max(drawing.width_px, drawing.height_px);
  const bool on = u >= -slack_px && v >= -slack_px && u <= drawing.width_px + slack_px &&
                  v <= drawing.height_px + slack_px;
  if (on) return;
  std::ostringstream what;
  what << "the point (" << u << ", " << v << ") lies off the drawing of " << drawing.width_px << " x "
       << drawing.height_px << " pixels";
  throw Error(where, what.str(),
              "give pixels of the drawing, u to the right and v down from its upper left corner");
}

}  // namespace madori::mapping
