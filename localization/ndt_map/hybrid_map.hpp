#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/ndt_map/beams.hpp"
#include "localization/ndt_map/cell_tree.hpp"
#include "mapping/wall_map/wall.hpp"

namespace madori::localization {

/// What enters the map, and how it is weighed; evidence in nats.
struct HybridMapOptions {
  double cell_m = 0.25;
  double hit = 0.85;            ///< a beam that ends in a cell: log(0.7 / 0.3)
  double pass = 0.4;            ///< a beam through it: log(0.6 / 0.4)
  double range_max_m = 30.0;    ///< farther returns only free what lies before that
  double range_min_m = 0.4;     ///< nearer returns are the vehicle itself
  double low_m = 0.15;          ///< above the floor: what is lower is driven over ...
  double high_m = 1.9;          ///< ... and higher than a person stands nothing in the way
  double shortest_m = 0.5;      ///< of another line: two cells; shorter ones are letters and arrows
  double surface_m = 0.05;      ///< of ends on a surface, one sigma: noise of range and pose
  double drawn_sigmas = 2.0;    ///< what stands so near to a drawn line is what it shows
  double most_samples = 500.0;  ///< of a Gaussian: older ones fade
  std::size_t most_cells = 250'000;
  LayerOptions layers;

  [[nodiscard]] double drawn_m() const { return drawn_sigmas * surface_m; }
};

/// The hybrid NDT-occupancy map (docs/explanation/living-map.md; Einhorn and Gross 2015 after the
/// lifelong-localization source, 4.2.1). Map frame. Deterministic: the same looks give the same map bit for
/// bit. Memory is bounded by most_cells.
class HybridMap {
 public:
  explicit HybridMap(const HybridMapOptions& options = {}) : options_(options) {}

  /// One scan from `map_from_base`, at `stamp`. Points that are not finite are left out.
  void look(const Beams& beams, const Transform2<Map, Base>& map_from_base, Stamp stamp);
  /// What is seen where walls are drawn is static from its first look on; what stands where other lines are
  /// drawn is, too: what the drawing shows was built in. Takes the place of earlier ones.
  void draw(const mapping::Walls& walls, const mapping::Walls& other_lines = {});

  [[nodiscard]] const HybridMapOptions& options() const { return options_; }
  [[nodiscard]] const CellTree& cells() const { return cells_; }
  [[nodiscard]] Stamp newest() const { return newest_; }
  [[nodiscard]] CellPlace place_of(const Point2<Map>& p) const;
  [[nodiscard]] Point2<Map> centre(const CellPlace& place) const;
  /// As it is read at the newest look.
  [[nodiscard]] CellState state(CellTree::Index cell) const;
  [[nodiscard]] CellState state_at(const Point2<Map>& p) const;
  /// A cell as it was kept.
  void restore(const CellPlace& place, const MapCell& cell);

 private:
  struct Ray;
  /// What the look at hand says of a cell.
  struct Sighting {
    CellTree::Index cell = 0;
    double evidence = 0.0;
    double same_thing = 1.0;
    CellGaussian ends;
  };
  void hit(const Ray& ray);
  void pass(const Ray& ray);
  Sighting& sighting(CellTree::Index cell);
  void take_shape(Sighting& seen, Stamp stamp);
  void settle(Stamp stamp);
  void forget_oldest();
  void mark_drawn(std::int32_t line_number);
  [[nodiscard]] DrawnAs drawn_as(const MapCell& cell) const;

  HybridMapOptions options_;
  CellTree cells_;
  std::vector<Segment2<Map>> drawn_;  ///< walls, and then other lines
  std::size_t drawn_walls_ = 0;
  Stamp newest_{};
  std::vector<Sighting> sightings_;         ///< of the look at hand
  std::vector<std::uint32_t> sighting_of_;  ///< by cell, counted from 1; 0: none
};

}  // namespace madori::localization
