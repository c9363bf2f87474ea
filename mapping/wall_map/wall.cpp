#include "mapping/wall_map/wall.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <sstream>
#include <string_view>

#include "core/input_file.hpp"
#include "core/result.hpp"

namespace madori::mapping {
namespace {

/// The next field of a comma-separated row as a number; false when it is none.
template <class T>
bool take_number(std::string_view& row, T& value) {
  const std::size_t comma = row.find(',');
  std::string_view field = row.substr(0, comma);
  row = comma == std::string_view::npos ? std::string_view() : row.substr(comma + 1);
  while (!field.empty() && field.front() == ' ') field.remove_prefix(1);
  while (!field.empty() && (field.back() == ' ' || field.back() == '\r')) field.remove_suffix(1);
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  return error == std::errc() && end == field.data() + field.size();
}

}  // namespace

Walls load_walls(const std::filesystem::path& file) {
  constexpr std::uintmax_t kMostBytes = 256'000'000;
  constexpr std::size_t kMostInLine = 1'000;
  require_readable(file, kMostBytes, "import the drawing first: madori import");
  std::ifstream stream(file);
  Walls walls;
  std::string line;
  int number = 1;
  for (; next_line(stream, line, file.string(), number, kMostInLine); ++number) {
    if (number == 1 && !line.starts_with("id,") && !line.starts_with("\xEF\xBB\xBFid,"))
      throw Error(file.string() + ":1", "is not `id,x1,y1,x2,y2[,probability]`", "import the drawing anew");
    if (number == 1 || line.empty() || line == "\r") continue;
    Wall wall;
    auto& [a, b] = wall.segment;
    std::string_view row = line;
    const bool good = take_number(row, wall.id) && take_number(row, a.x_m) && take_number(row, a.y_m) &&
                      take_number(row, b.x_m) && take_number(row, b.y_m) &&
                      (row.empty() || take_number(row, wall.probability)) && row.empty() &&
                      std::isfinite(a.x_m + a.y_m + b.x_m + b.y_m) && wall.probability >= 0 &&
                      wall.probability <= 1;
    if (!good)
      throw Error(file.string() + ":" + std::to_string(number), "is not `id,x1,y1,x2,y2[,probability]`",
                  "mend or remove that line");
    walls.push_back(wall);
  }
  if (number == 1) throw Error(file.string(), "is empty", "import the drawing anew");
  return walls;
}

std::string walls_csv(const Walls& walls) {
  std::ostringstream out;
  out.setf(std::ios::fixed);
  out.precision(6);
  const bool judged =
      std::any_of(walls.begin(), walls.end(), [](const Wall& wall) { return wall.probability < 1.0; });
  out << "id,x1,y1,x2,y2" << (judged ? ",probability\n" : "\n");
  for (const auto& [id, s, probability] : walls) {
    out << id << ',' << s.a.x_m << ',' << s.a.y_m << ',' << s.b.x_m << ',' << s.b.y_m;
    if (judged) out << std::setprecision(3) << ',' << probability << std::setprecision(6);
    out << '\n';
  }
  return out.str();
}

}  // namespace madori::mapping
