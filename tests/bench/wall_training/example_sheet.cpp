#include "tests/bench/wall_training/example_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/result.hpp"
#include "mapping/picture/load_image.hpp"

namespace madori::training {
namespace {

using mapping::PixelSegment;

constexpr double kAngleSine = 0.17;  // 10 degrees, as the scores have it
constexpr double kUnknownReach = 3;  // tolerances: contours leave out the other face of a wall

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> parts;
  std::stringstream stream(line);
  for (std::string part; std::getline(stream, part, ',');) parts.push_back(part);
  return parts;
}

std::vector<PixelSegment> read_truth(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw Error(file, "cannot be opened", "correct the list");
  std::string line;
  std::getline(stream, line);
  const auto header = fields(line);
  const auto first = std::find(header.begin(), header.end(), "u1") - header.begin();
  std::vector<PixelSegment> truth;
  while (std::getline(stream, line)) {
    const auto parts = fields(line);
    if (parts.size() < static_cast<std::size_t>(first) + 4) continue;
    const auto at = [&](std::ptrdiff_t k) { return std::stod(parts[static_cast<std::size_t>(first + k)]); };
    truth.push_back({at(0), at(1), at(2), at(3)});
  }
  return truth;
}

/// The share of a segment that lies beside a parallel one of the truth.
double true_share(const PixelSegment& s, const std::vector<PixelSegment>& truth, double tolerance) {
  const double length = s.length_px();
  const int places = std::clamp(static_cast<int>(length / 2), 2, 60);
  std::vector<bool> right(static_cast<std::size_t>(places));
  for (const PixelSegment& t : truth) {
    if (std::max(s.u1, s.u2) < std::min(t.u1, t.u2) - tolerance ||
        std::min(s.u1, s.u2) > std::max(t.u1, t.u2) + tolerance ||
        std::max(s.v1, s.v2) < std::min(t.v1, t.v2) - tolerance ||
        std::min(s.v1, s.v2) > std::max(t.v1, t.v2) + tolerance)
      continue;
    const double whole = std::max(1e-9, t.length_px());
    const double du = (t.u2 - t.u1) / whole, dv = (t.v2 - t.v1) / whole;
    if (std::abs(du * (s.v2 - s.v1) - dv * (s.u2 - s.u1)) > kAngleSine * length) continue;
    for (int k = 0; k < places; ++k) {
      const double f = (k + 0.5) / places, u = std::lerp(s.u1, s.u2, f) - t.u1,
                   v = std::lerp(s.v1, s.v2, f) - t.v1;
      const double along = std::clamp(u * du + v * dv, 0.0, whole);
      if (std::hypot(u - along * du, v - along * dv) <= tolerance) right[static_cast<std::size_t>(k)] = true;
    }
  }
  return static_cast<double>(std::count(right.begin(), right.end(), true)) / places;
}

bool ignored(const PixelSegment& s, const std::vector<double>& boxes) {
  const double u = 0.5 * (s.u1 + s.u2), v = 0.5 * (s.v1 + s.v2);
  for (std::size_t b = 0; b + 3 < boxes.size(); b += 4)
    if (u >= boxes[b] && u <= boxes[b + 2] && v >= boxes[b + 1] && v <= boxes[b + 3]) return true;
  return false;
}

template <class T>
void write(std::ofstream& stream, const std::vector<T>& values) {
  stream.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template <class T>
void read(std::ifstream& stream, std::vector<T>& values, std::size_t count) {
  values.resize(count);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(T)));
}

}  // namespace

std::vector<ListRow> read_list(const std::string& file) {
  std::ifstream stream(file);
  if (!stream) throw Error(file, "cannot be opened", "name a list of drawings");
  std::vector<ListRow> rows;
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    const auto parts = fields(line);
    if (parts.size() < 7) throw Error(file, "has a row with less than 7 fields: " + line, "complete it");
    ListRow row{parts[0], parts[1], parts[3], parts[4], parts[6], std::stod(parts[2]), std::stod(parts[5]),
                {}};
    std::stringstream boxes(parts.size() > 7 ? parts[7] : "");
    for (double value = 0; boxes >> value;) row.ignore.push_back(value);
    rows.push_back(row);
  }
  return rows;
}

ExampleSheet measure(const ListRow& row) {
  const auto sheet = mapping::label_sheet(mapping::find_edges(mapping::load_image(row.drawing)));
  const auto truth = read_truth(row.walls);
  ExampleSheet example{
      row.name, row.source, row.truth, static_cast<float>(row.weight), sheet.features.names(), {}, {}, {},
      {},       {},         {}};
  for (std::size_t i = 0; i < sheet.features.rows(); ++i) {
    const PixelSegment& e = sheet.edges.edges[i].segment;
    const double k = sheet.edges.factor;
    const PixelSegment s{e.u1 / k, e.v1 / k, e.u2 / k, e.v2 / k};
    const double near = true_share(s, truth, row.tolerance_px);
    const double far = true_share(s, truth, kUnknownReach * row.tolerance_px);
    const auto values = sheet.features.row(i);
    example.values.insert(example.values.end(), values.begin(), values.end());
    for (const double value : {s.u1, s.v1, s.u2, s.v2}) example.segments.push_back(static_cast<float>(value));
    example.near.push_back(static_cast<float>(near));
    example.far.push_back(static_cast<float>(far));
    example.used.push_back(
        !ignored(s, row.ignore) && !(row.truth == "contours" && near <= 0.5 && far > 0.5) ? 1 : 0);
    for (const auto& group : sheet.groups.together) example.groups.push_back(group[i]);
    for (const auto& partner : sheet.groups.partner) example.groups.push_back(partner[i]);
  }
  return example;
}

void save(const ExampleSheet& sheet, const std::filesystem::path& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << sheet.name << ' ' << sheet.source << ' ' << sheet.truth << ' ' << sheet.weight << ' '
         << sheet.rows() << ' ' << sheet.features.size();
  for (const std::string& name : sheet.features) stream << ' ' << name;
  stream << '\n';
  write(stream, sheet.values);
  write(stream, sheet.segments);
  write(stream, sheet.near);
  write(stream, sheet.far);
  write(stream, sheet.used);
  write(stream, sheet.groups);
  if (!stream) throw Error(file.string(), "cannot be written", "check the disk");
}

ExampleSheet load_sheet(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  ExampleSheet sheet;
  std::size_t rows = 0, columns = 0;
  stream >> sheet.name >> sheet.source >> sheet.truth >> sheet.weight >> rows >> columns;
  sheet.features.resize(stream ? columns : 0);
  for (std::string& name : sheet.features) stream >> name;
  stream.get();
  read(stream, sheet.values, rows * columns);
  read(stream, sheet.segments, 4 * rows);
  read(stream, sheet.near, rows);
  read(stream, sheet.far, rows);
  read(stream, sheet.used, rows);
  read(stream, sheet.groups, kGroups * rows);
  if (!stream) throw Error(file.string(), "is no measured sheet", "measure it again: measure_sheets");
  return sheet;
}

}  // namespace madori::training
