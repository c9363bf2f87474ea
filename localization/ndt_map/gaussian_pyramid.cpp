#include "localization/ndt_map/gaussian_pyramid.hpp"

#include <cmath>

#include "localization/ndt_map/hybrid_map.hpp"

namespace madori::localization {
namespace {

constexpr double kAll = 1e9;  // samples of a Gaussian that does not fade

std::uint64_t key_of(const CellPlace& p) {
  return (std::uint64_t{static_cast<std::uint32_t>(p.column)} << 32U) | static_cast<std::uint32_t>(p.row);
}

CellGaussian one_point(double x_m, double y_m) {
  CellGaussian g;
  g.add(x_m, y_m, 0.0, kAll);
  return g;
}

}  // namespace

CellPlace GaussianLevel::place_of(double x_m, double y_m) const {
  return {static_cast<std::int32_t>(std::floor(x_m / cell_m_)),
          static_cast<std::int32_t>(std::floor(y_m / cell_m_))};
}

void GaussianLevel::add(const CellGaussian& gaussian) {
  const auto [at, fresh] = index_.try_emplace(key_of(place_of(gaussian.x_m, gaussian.y_m)),
                                              static_cast<std::uint32_t>(cells_.size()));
  if (fresh)
    cells_.push_back(gaussian);
  else
    cells_[at->second].merge(gaussian, kAll);
}

const CellGaussian* GaussianLevel::find(const CellPlace& place) const {
  const auto at = index_.find(key_of(place));
  return at == index_.end() ? nullptr : &cells_[at->second];
}

GaussianPyramid::GaussianPyramid(double cell_m) {
  for (GaussianLevel& level : levels_) {
    level = GaussianLevel(cell_m);
    cell_m *= 2.0;
  }
}

GaussianPyramid::GaussianPyramid(const ScanPoints& points, double cell_m) : GaussianPyramid(cell_m) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::isfinite(points.x_m[i] + points.y_m[i])) levels_[0].add(one_point(points.x_m[i], points.y_m[i]));
  fill_coarser();
}

GaussianPyramid::GaussianPyramid(std::span<const Point2<Map>> occupied, double cell_m)
    : GaussianPyramid(cell_m) {
  for (const Point2<Map>& p : occupied) levels_[0].add(one_point(p.x_m, p.y_m));
  fill_coarser();
}

GaussianPyramid::GaussianPyramid(const HybridMap& map) : GaussianPyramid(map.options().cell_m) {
  const CellTree& cells = map.cells();
  for (CellTree::Index i = 0; i < cells.size(); ++i) {
    const CellState state = map.state(i);
    const bool stands = state == CellState::Static || state == CellState::SemiStatic;
    if (stands && !cells[i].gaussian.empty()) levels_[0].add(cells[i].gaussian);
  }
  fill_coarser();
}

void GaussianPyramid::fill_coarser() {
  for (std::size_t i = 1; i < kLevels; ++i)
    for (const CellGaussian& g : levels_[i - 1].cells()) levels_[i].add(g);
}

}  // namespace madori::localization
