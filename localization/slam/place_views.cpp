#include "localization/slam/place_views.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/angle.hpp"
#include "localization/registration/rdnm.hpp"

namespace madori::localization {
namespace {

constexpr int kSections = 64;
constexpr double kNearestM = 0.2;
constexpr double kStepsPerE = 40.0;  // of the logarithm: a step is 2.5 %
constexpr int kUnlike = 24;          // from 1.8 times the distance on, no matter how much

}  // namespace

double ViewDifference::turn_rad() const {
  return wrap_angle(shift * 2.0 * kPi / kSections);
}

PlaceView place_view(const SurfaceScan& surroundings) {
  std::vector<Point2<Base>> points;
  points.reserve(surroundings.points.size());
  for (const SurfacePoint& p : surroundings.points) points.push_back({p.x_m, p.y_m});
  RdnOptions options;
  options.sections = kSections;
  const RdnDescriptor h = rdn<Base>(points, {}, options);
  PlaceView view{};
  for (std::size_t i = 0; i < view.size(); ++i) {
    const double steps = kStepsPerE * std::log(std::max(h[i] / kNearestM, 1.0));
    view[i] = h[i] == kEmptySection ? kNoView : static_cast<std::uint8_t>(std::min(steps, 254.0));
  }
  return view;
}

ViewDifference compare_views(const PlaceView& seen, const PlaceView& old) {
  std::array<std::uint8_t, 2 * kSections> twice{};  // so that every turn is one stretch of memory
  std::copy(old.begin(), old.end(), twice.begin());
  std::copy(old.begin(), old.end(), twice.begin() + kSections);
  ViewDifference best;
  for (int shift = 0; shift < kSections; ++shift) {
    int sum = 0, compared = 0;
    const std::uint8_t* b = twice.data() + shift;
#pragma omp simd reduction(+ : sum, compared)
    for (std::size_t i = 0; i < kSections; ++i) {
      const int both = (seen[i] != kNoView) & (b[i] != kNoView);
      sum += both * std::min(std::abs(seen[i] - b[i]), kUnlike);
      compared += both;
    }
    if (2 * compared < kSections) continue;
    const double difference = static_cast<double>(sum) / (kUnlike * compared);
    if (difference < best.difference) best = {difference, shift};
  }
  return best;
}

}  // namespace madori::localization
