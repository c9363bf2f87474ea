#include "mapping/drawing/raster/pores.hpp"

#include <vector>

#include "mapping/drawing/raster/components.hpp"

namespace madori::mapping {
namespace {

constexpr double kLargestInPens = 3.6;

}  // namespace

std::size_t fill_pores(GrayImage& ink, double pen_px) {
  const Components paper(ink, true);
  const double largest = kLargestInPens * pen_px;
  std::vector<bool> pore(paper.all().size(), false);
  std::size_t count = 0;
  for (std::size_t i = 0; i < pore.size(); ++i) {
    const Component& c = paper.all()[i];
    pore[i] = static_cast<double>(c.area_px) <= largest * largest && c.size() <= 2 * largest;
    count += pore[i] ? 1 : 0;
  }
  paper.paint(ink, pore, 255);
  return count;
}

}  // namespace madori::mapping
