#include "hmi/server/standing_walls.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "mapping/site/atomic_file.hpp"

namespace madori::hmi {
namespace {

constexpr const char* kHeader = "frame,x1,y1,x2,y2,date\n";

std::optional<Segment2<Map>> segment_of(std::string_view numbers) {
  std::array<double, 4> row{};
  for (double& value : row) {
    const std::size_t comma = numbers.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const auto [end, error] = std::from_chars(numbers.data(), numbers.data() + comma, value);
    if (error != std::errc() || end != numbers.data() + comma || !std::isfinite(value)) return std::nullopt;
    numbers.remove_prefix(comma + 1);
  }
  return Segment2<Map>{{row[0], row[1]}, {row[2], row[3]}};
}

}  // namespace

std::vector<Segment2<Map>> standing_walls(const std::filesystem::path& site, const std::string& frame) {
  std::vector<Segment2<Map>> walls;
  std::istringstream stream(mapping::file_content(site / kStandingFile));
  for (std::string line; std::getline(stream, line);) {
    if (!line.starts_with(frame + ",")) continue;
    if (const auto segment = segment_of(std::string_view(line).substr(frame.size() + 1)))
      walls.push_back(*segment);
  }
  return walls;
}

void add_standing_walls(const std::filesystem::path& site, const std::string& frame,
                        const std::vector<Segment2<Map>>& segments, const std::string& date) {
  const auto file = site / kStandingFile;
  std::string text = mapping::file_content(file);
  if (text.empty()) text = kHeader;
  for (const auto& [a, b] : segments)
    text += fmt::format("{},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", frame, a.x_m, a.y_m, b.x_m, b.y_m, date);
  std::filesystem::create_directories(file.parent_path());
  mapping::write_file_atomically(file, text);
}

}  // namespace madori::hmi
