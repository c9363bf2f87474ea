#include "localization/registration/rdnm.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {

template <class F>
RdnDescriptor rdn(std::span<const Point2<F>> points, const Point2<F>& viewpoint, const RdnOptions& options) {
  const auto sections = static_cast<std::size_t>(options.sections);
  struct Seen {
    std::size_t section;
    double distance_m;
  };
  std::vector<Seen> seen;
  seen.reserve(points.size());
  std::vector<double> nearest(sections, INFINITY);
  for (const Point2<F>& p : points) {
    const double dx = p.x_m - viewpoint.x_m;
    const double dy = p.y_m - viewpoint.y_m;
    const double turn = std::atan2(dy, dx) / (2.0 * kPi);
    const double part = (turn < 0.0 ? turn + 1.0 : turn) * options.sections;
    const std::size_t section = std::min(static_cast<std::size_t>(part), sections - 1);
    const double distance = std::hypot(dx, dy);
    seen.push_back({section, distance});
    nearest[section] = std::min(nearest[section], distance);
  }
  std::vector<double> sum(sections, 0.0);
  std::vector<int> count(sections, 0);
  for (const auto& [section, distance] : seen)
    if (distance < nearest[section] + options.epsilon_m) sum[section] += distance, ++count[section];
  RdnDescriptor h(sections, kEmptySection);
  for (std::size_t i = 0; i < sections; ++i)
    if (count[i] > 0) h[i] = static_cast<float>(sum[i] / count[i]);
  return h;
}
template RdnDescriptor rdn(std::span<const Point2<Map>>, const Point2<Map>&, const RdnOptions&);
template RdnDescriptor rdn(std::span<const Point2<Base>>, const Point2<Base>&, const RdnOptions&);

RdnDescriptor rdn(const ScanPoints& points, const RdnOptions& options) {
  std::vector<Point2<Base>> list(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) list[i] = points.point(i);
  return rdn<Base>(list, {}, options);
}

double rdn_difference(const RdnDescriptor& scan, const RdnDescriptor& map, int shift, double unlike_m) {
  const std::size_t n = scan.size();
  double sum = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const float a = scan[i];
    const float b = map[(i + static_cast<std::size_t>(shift)) % n];
    if (a == kEmptySection || b == kEmptySection) continue;
    sum += std::min<double>(std::abs(a - b), unlike_m);
    ++compared;
  }
  return 4 * compared < n ? unlike_m : sum / static_cast<double>(compared);
}

std::optional<RdnmResult> rdnm(const ScanPoints& scan, std::span<const Point2<Map>> map,
                               std::span<const Point2<Map>> candidates, const RdnOptions& options) {
  if (scan.empty() || candidates.empty()) return std::nullopt;
  const RdnDescriptor seen = rdn(scan, options);
  const double alpha = 2.0 * kPi / options.sections;
  RdnmResult best{{}, INFINITY};
  for (const Point2<Map>& candidate : candidates) {
    const RdnDescriptor view = rdn<Map>(map, candidate, options);
    for (int shift = 0; shift < options.sections; ++shift) {
      const double difference = rdn_difference(seen, view, shift, options.unlike_m);
      if (difference < best.difference_m) best = {{candidate.x_m, candidate.y_m, shift * alpha}, difference};
    }
  }
  return best;
}

}  // namespace madori::localization
