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

double rdn_difference(const RdnDescriptor& scan, const RdnDescriptor& map, int shift,
                      const RdnOptions& options) {
  const std::size_t n = scan.size();
  const bool published = options.norm == RdnNorm::Published;
  double sum = 0.0;
  std::size_t compared = 0;
  for (std::size_t i = 0, k = static_cast<std::size_t>(shift) % n; i < n; ++i, k = k + 1 == n ? 0 : k + 1) {
    const float a = scan[i];
    const float b = map[k];
    if (a == kEmptySection || b == kEmptySection) continue;
    const double off = std::abs(a - b);
    sum += published ? off * off : std::min(off, options.unlike_m);
    ++compared;
  }
  if (4 * compared < n) return INFINITY;
  const double mean = sum / static_cast<double>(compared);
  return published ? std::sqrt(mean) : mean;
}

namespace {

/// Differences of all turns that are looked at; infinite for the others.
std::vector<double> by_turn(const RdnDescriptor& scan, const RdnDescriptor& view, const RdnOptions& options,
                            const TurnLimit& turns) {
  const double alpha = 2.0 * kPi / options.sections;
  std::vector<double> differences(scan.size(), INFINITY);
  for (int shift = 0; shift < options.sections; ++shift)
    if (std::abs(wrap_angle(shift * alpha - turns.heading_rad)) <= turns.most_rad)
      differences[static_cast<std::size_t>(shift)] = rdn_difference(scan, view, shift, options);
  return differences;
}

/// No greater than on either side; of equal neighbours the first.
bool is_least_here(const std::vector<double>& differences, std::size_t i) {
  const std::size_t n = differences.size();
  const double here = differences[i], before = differences[(i + n - 1) % n], after = differences[(i + 1) % n];
  return here < INFINITY && here <= after && (i == 0 ? here <= before : here < before);
}

}  // namespace

std::vector<RdnmResult> rdnm_ranked(const ScanPoints& scan, std::span<const Point2<Map>> candidates,
                                    std::span<const RdnDescriptor> views, const RdnOptions& options,
                                    const TurnLimit& turns) {
  std::vector<RdnmResult> ranked;
  if (scan.empty()) return ranked;
  const RdnDescriptor seen = rdn(scan, options);
  const double alpha = 2.0 * kPi / options.sections;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const std::vector<double> differences = by_turn(seen, views[i], options, turns);
    for (std::size_t shift = 0; shift < differences.size(); ++shift)
      if (is_least_here(differences, shift))
        ranked.push_back(
            {{candidates[i].x_m, candidates[i].y_m, static_cast<double>(shift) * alpha}, differences[shift]});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.difference_m < b.difference_m; });
  return ranked;
}

std::vector<RdnmResult> rdnm_ranked(const ScanPoints& scan, std::span<const Point2<Map>> map,
                                    std::span<const Point2<Map>> candidates, const RdnOptions& options,
                                    const TurnLimit& turns) {
  std::vector<RdnDescriptor> views;
  views.reserve(candidates.size());
  for (const Point2<Map>& candidate : candidates) views.push_back(rdn<Map>(map, candidate, options));
  return rdnm_ranked(scan, candidates, views, options, turns);
}

std::optional<RdnmResult> rdnm(const ScanPoints& scan, std::span<const Point2<Map>> map,
                               std::span<const Point2<Map>> candidates, const RdnOptions& options,
                               const TurnLimit& turns) {
  const std::vector<RdnmResult> ranked = rdnm_ranked(scan, map, candidates, options, turns);
  return ranked.empty() ? std::nullopt : std::optional(ranked.front());
}

}  // namespace madori::localization
