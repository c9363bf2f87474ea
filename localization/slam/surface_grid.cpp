#include "localization/slam/surface_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace madori::localization {
namespace {

constexpr double kLeastHits = 0.25;   // share of looks at a cell that must have met its surface
constexpr std::size_t kRayEvery = 2;  // points of a scan whose way is looked along

int cell_of(double m) {
  return static_cast<int>(std::floor(m / SurfaceGrid::kCellM));
}

std::uint64_t tile_key(int tx, int ty) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(tx)) << 32U) | static_cast<std::uint32_t>(ty);
}

void count(std::uint16_t& n) {
  if (n < std::numeric_limits<std::uint16_t>::max()) ++n;
}

}  // namespace

const SurfaceGrid::Cell* SurfaceGrid::look(int ix, int iy, Cursor& cursor) const {
  const std::uint64_t key = tile_key(ix >> kTileBits, iy >> kTileBits);
  if (key != cursor.key) {
    const auto tile = tiles_.find(key);
    cursor = {key, tile == tiles_.end() ? nullptr : tile->second.get()};
  }
  return cursor.tile == nullptr ? nullptr : &(*cursor.tile)[cell_in_tile(ix, iy)];
}

/// Copy on write: a tile that another map holds, too, is copied before it changes.
SurfaceGrid::Cell& SurfaceGrid::touch(int ix, int iy, Cursor& cursor) {
  const std::uint64_t key = tile_key(ix >> kTileBits, iy >> kTileBits);
  if (key != cursor.key) {
    auto& tile = tiles_[key];
    if (!tile) {
      tile = std::make_shared<Tile>();
    } else if (tile.use_count() > 1) {
      tile = std::make_shared<Tile>(*tile);
    }
    cursor = {key, tile.get()};
  }
  return (*cursor.tile)[cell_in_tile(ix, iy)];
}

void SurfaceGrid::add(const SurfaceScan& scan, const Transform2<Map, Base>& pose) {
  const Point2<Map> eye = pose * scan.sensor;
  Cursor at_point, on_ray;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const SurfacePoint q = moved(pose, scan.points[i]);
    const int ix = cell_of(q.x_m), iy = cell_of(q.y_m);
    Cell& cell = touch(ix, iy, at_point);
    // A thin wall's other face is another surface.
    if (cell.normal_x * q.normal_x + cell.normal_y * q.normal_y >= 0.0) {
      cell.sum_x += static_cast<float>(q.x_m - ix * kCellM);
      cell.sum_y += static_cast<float>(q.y_m - iy * kCellM);
      cell.normal_x += static_cast<float>(q.normal_x);
      cell.normal_y += static_cast<float>(q.normal_y);
      count(cell.hits);
    }
    if (i % kRayEvery != 0) continue;
    const double length = std::hypot(q.x_m - eye.x_m, q.y_m - eye.y_m);
    const int steps = static_cast<int>(length / kCellM) - 1;
    for (int s = 1; s < steps; ++s) {
      const double t = s * kCellM / length;
      count(touch(cell_of(eye.x_m + t * (q.x_m - eye.x_m)), cell_of(eye.y_m + t * (q.y_m - eye.y_m)), on_ray)
                .passes);
    }
  }
}

bool SurfaceGrid::nearest(const SurfacePoint& p, int reach, Surface& found) const {
  const int cx = cell_of(p.x_m), cy = cell_of(p.y_m);
  const bool directed = p.has_normal();
  double best = std::numeric_limits<double>::max();
  Cursor cursor;
  for (int iy = cy - reach; iy <= cy + reach; ++iy) {
    for (int ix = cx - reach; ix <= cx + reach; ++ix) {
      const Cell* cell = look(ix, iy, cursor);
      if (cell == nullptr || cell->hits == 0) continue;
      if (cell->hits < kLeastHits * (cell->hits + cell->passes)) continue;
      const double x = ix * kCellM + cell->sum_x / cell->hits, y = iy * kCellM + cell->sum_y / cell->hits;
      const double sq = (x - p.x_m) * (x - p.x_m) + (y - p.y_m) * (y - p.y_m);
      if (sq >= best) continue;
      const double length = std::hypot(cell->normal_x, cell->normal_y);
      if (length <= 0.0) continue;
      const double nx = cell->normal_x / length, ny = cell->normal_y / length;
      if (directed && nx * p.normal_x + ny * p.normal_y < kSameSurfaceCosine) continue;
      best = sq;
      found = {x, y, nx, ny};
    }
  }
  return best < std::numeric_limits<double>::max();
}

SurfaceGrid::Content SurfaceGrid::content(double x_m, double y_m) const {
  Cursor cursor;
  const Cell* cell = look(cell_of(x_m), cell_of(y_m), cursor);
  if (cell == nullptr || cell->hits + cell->passes == 0) return Content::Unknown;
  return cell->hits >= kLeastHits * (cell->hits + cell->passes) ? Content::Occupied : Content::Free;
}

}  // namespace madori::localization
