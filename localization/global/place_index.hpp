#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "localization/scan_points.hpp"
#include "mapping/wall_map/distance_field.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

struct PlaceIndexOptions {
  double spacing_m = 0.5;     ///< g of the paper, between the candidate positions
  double clearance_m = 0.2;   ///< positions nearer to a wall are no candidates
  double range_max_m = 40.0;  ///< what lies farther counts as not seen
  double unlike_m = 0.8;      ///< a direction's difference counts no more than this

  friend bool operator==(const PlaceIndexOptions&, const PlaceIndexOptions&) = default;
};

/// What a lidar would see from every place where the vehicle could stand: the map's RDN descriptors, computed
/// once. One byte a direction, 64 directions a place.
class PlaceIndex {
 public:
  static constexpr int kSections = 64;
  static constexpr std::uint8_t kUnseen = 255;
  using View = std::vector<std::uint8_t>;  ///< kSections bytes: counts of m_per_count(), or kUnseen

  PlaceIndex(const mapping::Walls& walls, const mapping::DistanceField& field,
             const PlaceIndexOptions& options = {});

  [[nodiscard]] const PlaceIndexOptions& options() const { return options_; }
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] const std::vector<Point2<Map>>& places() const { return places_; }
  [[nodiscard]] std::span<const std::uint8_t> views() const { return views_; }
  [[nodiscard]] double m_per_count() const { return options_.range_max_m / 254.0; }
  /// The scan as the same kind of view: section i holds the directions [i, i + 1) * 2 pi / 64 of the Base
  /// frame.
  [[nodiscard]] View view(const ScanPoints& points) const;

  /// Writes the index beside the site, atomically, with a sum of the walls it belongs to.
  void save(const std::filesystem::path& file, const mapping::Walls& walls) const;
  /// Nothing when the file is absent, damaged, or belongs to other walls or options: then compute it anew.
  [[nodiscard]] static std::optional<PlaceIndex> load(const std::filesystem::path& file,
                                                      const mapping::Walls& walls,
                                                      const PlaceIndexOptions& options = {});

 private:
  explicit PlaceIndex(const PlaceIndexOptions& options) : options_(options) {}

  PlaceIndexOptions options_;
  std::vector<Point2<Map>> places_;
  std::vector<std::uint8_t> views_;
};

}  // namespace madori::localization
