#include "localization/global/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>

#include "mapping/site/atomic_file.hpp"
#include "mapping/wall_map/wall_fingerprint.hpp"

namespace madori::localization {
namespace {

constexpr char kMagic[16] = "madori places 1";
constexpr double kSectionRad = 2.0 * kPi / PlaceIndex::kSections;

/// What stands at the head of the file; the numbers must all agree for it to be of use.
struct Header {
  char magic[16] = {};
  PlaceIndexOptions options;
  std::uint64_t walls = 0;
  std::uint64_t places = 0;
};

std::uint8_t counted(double distance_m, double m_per_count, double range_max_m) {
  if (!(distance_m < range_max_m)) return PlaceIndex::kUnseen;
  return static_cast<std::uint8_t>(std::lround(distance_m / m_per_count));
}

double median_of_three(double a, double b, double c) {
  return std::max(std::min(a, b), std::min(std::max(a, b), c));
}

/// The view from a place; false when too little is seen for a place inside the building.
bool look_around(const mapping::DistanceField& field, const Point2<Map>& place,
                 const PlaceIndexOptions& options, double m_per_count, std::uint8_t* view) {
  constexpr int kLeastSeen = PlaceIndex::kSections / 3;
  int seen = 0;
  for (int section = 0; section < PlaceIndex::kSections; ++section) {
    double ranges[3];
    for (int k = 0; k < 3; ++k) {
      const double angle = (section + (k + 0.5) / 3.0) * kSectionRad;
      ranges[k] = field.free_way_m(place, std::cos(angle), std::sin(angle), options.range_max_m);
    }
    view[section] =
        counted(median_of_three(ranges[0], ranges[1], ranges[2]), m_per_count, options.range_max_m);
    seen += view[section] != PlaceIndex::kUnseen;
  }
  return seen >= kLeastSeen;
}

}  // namespace

PlaceIndex::PlaceIndex(const mapping::Walls& walls, const mapping::DistanceField& field,
                       const PlaceIndexOptions& options)
    : options_(options) {
  const mapping::GridFrame grid = mapping::GridFrame::around(walls, 0.0, options.spacing_m);
  std::uint8_t view[kSections];
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const Point2<Map> place = grid.centre(column, row);
      if (field.distance_m(place) < options.clearance_m) continue;
      if (!look_around(field, place, options, m_per_count(), view)) continue;
      places_.push_back(place);
      views_.insert(views_.end(), view, view + kSections);
    }
}

PlaceIndex::View PlaceIndex::view(const ScanPoints& points) const {
  std::vector<std::vector<float>> ranges(kSections);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.weight_of(i) <= 0.0) continue;
    const double angle = std::atan2(points.y_m[i], points.x_m[i]);
    const auto section = static_cast<std::size_t>(std::floor(angle / kSectionRad) + kSections) % kSections;
    ranges[section].push_back(std::hypot(points.x_m[i], points.y_m[i]));
  }
  View view(kSections, kUnseen);
  for (std::size_t i = 0; i < kSections; ++i) {
    if (ranges[i].empty()) continue;
    // What is not drawn stands before the walls, never behind: the upper quartile sees past it.
    const auto upper = ranges[i].begin() + static_cast<std::ptrdiff_t>(ranges[i].size() * 3 / 4);
    std::nth_element(ranges[i].begin(), upper, ranges[i].end());
    view[i] = counted(*upper, m_per_count(), options_.range_max_m);
  }
  return view;
}

void PlaceIndex::save(const std::filesystem::path& file, const mapping::Walls& walls) const {
  Header header;
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.options = options_;
  header.walls = mapping::walls_checksum(walls);
  header.places = places_.size();
  std::string content(reinterpret_cast<const char*>(&header), sizeof(header));
  content.append(reinterpret_cast<const char*>(places_.data()), places_.size() * sizeof(Point2<Map>));
  content.append(reinterpret_cast<const char*>(views_.data()), views_.size());
  mapping::write_file_atomically(file, content);
}

std::optional<PlaceIndex> PlaceIndex::load(const std::filesystem::path& file, const mapping::Walls& walls,
                                           const PlaceIndexOptions& options) {
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  Header header;
  if (content.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, content.data(), sizeof(header));
  const bool ours = std::memcmp(header.magic, kMagic, sizeof(kMagic)) == 0 &&
                    header.walls == mapping::walls_checksum(walls) && header.options == options;
  constexpr std::size_t kPlaceBytes = sizeof(Point2<Map>) + kSections;
  if (!ours || header.places > content.size() / kPlaceBytes ||
      content.size() != sizeof(header) + header.places * kPlaceBytes)
    return std::nullopt;
  PlaceIndex index(options);
  index.places_.resize(header.places);
  index.views_.resize(header.places * kSections);
  const char* data = content.data() + sizeof(header);
  std::memcpy(index.places_.data(), data, header.places * sizeof(Point2<Map>));
  std::memcpy(index.views_.data(), data + header.places * sizeof(Point2<Map>), index.views_.size());
  return index;
}

}  // namespace madori::localization
