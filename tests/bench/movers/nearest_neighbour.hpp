#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <memory>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/point_cloud.hpp"
#include "planning/obstacle_check/wall_grid.hpp"
#include "simulation/frames.hpp"
#include "tests/bench/movers/true_mover.hpp"

namespace madori::bench {

struct NeighbourOptions {
  double low_m = 0.15, high_m = 1.9;  ///< heights above the floor that a vehicle could run into
  double off_walls_m = 0.3;           ///< nearer to a drawn wall a point counts as its own
  double reach_m = 25.0;
  double cell_m = 0.15;     ///< cells that touch, corners too, are one cluster
  double widest_m = 2.9;    ///< a forklift from corner to corner
  int fewest_points = 3;    ///< of a cluster
  double gate_m = 0.5;      ///< from a cluster to its place in the scan before
  double history_s = 0.5;   ///< over which a velocity is measured ...
  double shortest_s = 0.3;  ///< ... and at least
  double fastest_mps = 3.0;
};

/// The textbook's way to what moves, to compare with: the points of a scan that lie on no drawn wall are
/// clustered, each cluster goes on with the nearest one of the scan before, and its velocity is what it moved
/// by over half a second. It is told the true pose, so that localization spoils nothing.
class NearestNeighbour {
 public:
  NearestNeighbour(std::shared_ptr<const planning::WallGrid> walls, const simulation::PlanFrames& frames,
                   const NeighbourOptions& options = {})
      : walls_(std::move(walls)), frames_(frames), options_(options) {}

  void update(const PointCloud<Base>& scan, const Transform2<Building, Base>& building_from_base);
  /// Those of the clusters that are faster.
  [[nodiscard]] std::vector<ToldMover> faster_than(double speed_mps) const;

 private:
  struct Cluster {
    Point2<Building> low, high;  ///< corners of the box around it
    int points = 0;
    [[nodiscard]] Point2<Building> centre() const {
      return {0.5 * (low.x_m + high.x_m), 0.5 * (low.y_m + high.y_m)};
    }
    [[nodiscard]] double width_m() const { return std::max(high.x_m - low.x_m, high.y_m - low.y_m); }
    void add(const Cluster& other);
  };
  struct Track {
    std::deque<std::pair<Stamp, Point2<Building>>> places;
    double radius_m = 0.0;
  };
  struct Cell {
    std::int64_t x = 0, y = 0;
    Cluster content;
    bool taken = false;
  };
  [[nodiscard]] bool is_on_wall(const Point2<Map>& at) const;
  void lay_out(const PointCloud<Base>& scan, const Transform2<Building, Base>& building_from_base);
  [[nodiscard]] std::vector<Cluster> clusters();
  [[nodiscard]] Cluster flood(std::size_t first);
  void follow(const std::vector<Cluster>& found, Stamp stamp);

  std::shared_ptr<const planning::WallGrid> walls_;
  simulation::PlanFrames frames_;
  NeighbourOptions options_;
  std::vector<Cell> cells_;                               ///< in the order of their first points
  std::unordered_map<std::int64_t, std::size_t> places_;  ///< of cells, by their numbers
  std::vector<Track> tracks_;
};

}  // namespace madori::bench
