#include "localization/wall_reliability/reliability_file.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string_view>

#include "core/possible.hpp"
#include "mapping/site/atomic_file.hpp"

namespace madori::localization {
namespace {

constexpr const char* kHeader =
    "wall_id,piece,x1,y1,x2,y2,in_place,beside,missed,offset_m,offset_sigma_m,drawn_offset_m,state";
constexpr std::size_t kNumbers = 12;
constexpr double kSameM = 2e-5;  // six digits are written

using Row = std::array<double, kNumbers>;

std::optional<Row> numbers_of(std::string_view line) {
  Row row{};
  for (double& value : row) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    const std::string_view field = line.substr(0, comma);
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (error != std::errc() || end != field.data() + field.size() || !is_possible(value))
      return std::nullopt;
    line.remove_prefix(comma + 1);
  }
  return row;
}

/// The piece that lies where the row's did, whatever its number is now; nothing where there is none.
std::optional<std::size_t> piece_of(const WallCells& cells, const Row& row) {
  const auto same = [](double a, double b) { return std::abs(a - b) < kSameM; };
  const Point2<Map> middle{0.5 * (row[2] + row[4]), 0.5 * (row[3] + row[5])};
  for (const std::uint32_t i : cells.near(middle, kSameM)) {
    const Segment2<Map>& s = cells.all()[i].segment;
    if (same(row[2], s.a.x_m) && same(row[3], s.a.y_m) && same(row[4], s.b.x_m) && same(row[5], s.b.y_m))
      return i;
  }
  return std::nullopt;
}

bool has_counts(const Row& row) {
  return row[6] >= 0.0 && row[7] >= 0.0 && row[8] >= 0.0 && row[10] >= 0.0;
}

}  // namespace

std::string reliability_csv(const WallReliability& reliability) {
  std::string text(kHeader);
  text += '\n';
  for (std::size_t i = 0; i < reliability.cells().size(); ++i) {
    const WallCell& c = reliability.cells().all()[i];
    const WallBelief& b = reliability.beliefs()[i];
    std::array<char, 320> line{};
    std::snprintf(line.data(), line.size(), "%d,%d,%.6f,%.6f,%.6f,%.6f,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,%s\n",
                  c.wall_id, c.piece, c.segment.a.x_m, c.segment.a.y_m, c.segment.b.x_m, c.segment.b.y_m,
                  b.in_place, b.beside, b.missed, b.offset_m, b.offset_sigma_m, b.drawn_offset_m,
                  to_string(reliability.state(i)));
    text += line.data();
  }
  return text;
}

std::string load_reliability(const std::filesystem::path& file, WallReliability& reliability) {
  if (!std::filesystem::exists(file)) return "";
  std::istringstream stream(mapping::file_content(file));
  std::string line;
  std::vector<WallBelief> beliefs(reliability.cells().size());
  std::size_t rows = 0, found = 0;
  std::getline(stream, line);
  const std::string anew = " - what was learned of the walls is learned anew while driving";
  if (line != kHeader) return file.string() + ":1: is damaged" + anew;
  while (std::getline(stream, line)) {
    ++rows;
    const auto row = numbers_of(line);
    if (!row || !has_counts(*row))
      return file.string() + ":" + std::to_string(rows + 1) + ": is damaged" + anew;
    const auto piece = piece_of(reliability.cells(), *row);
    if (!piece) continue;  // of a wall that was erased or drawn elsewhere
    beliefs[*piece] = {(*row)[6], (*row)[7], (*row)[8], (*row)[9], (*row)[10], (*row)[11]};
    ++found;
  }
  if (rows > 0 && found == 0) return file.string() + ": the walls have changed since" + anew;
  reliability.set_beliefs(std::move(beliefs));
  return "";
}

void save_reliability(const std::filesystem::path& file, const WallReliability& reliability) {
  mapping::write_file_atomically(file, reliability_csv(reliability));
}

}  // namespace madori::localization
