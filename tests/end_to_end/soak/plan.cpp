#include "tests/end_to_end/soak/plan.hpp"

#include <algorithm>

#include "planning/route_graph/route_search.hpp"

namespace madori::soak {
namespace {

using simulation::Device;
using simulation::FaultKind;
using simulation::Random;

/// Which of `count` events, spread evenly over `deliveries` and shifted by a share of their spacing, falls
/// on a delivery.
std::optional<int> event_at(int delivery, int count, int deliveries, double shift) {
  for (int k = 0; k < count; ++k)
    if (static_cast<int>((k + shift) * deliveries / count) == delivery) return k;
  return std::nullopt;
}

/// In turn: the lidar is silent, an encoder stands still, the drive's link is cut.
Dropout dropout_of(int number, Random& random) {
  Dropout d;
  d.fault.at_s = random.uniform(3.0, 15.0);
  switch (number % 3) {
    case 0:
      d.fault.kind = FaultKind::Silence;
      d.fault.device = Device::Vlp16;
      d.fault.for_s = random.uniform(1.0, 10.0);
      break;
    case 1:
      d.fault.kind = FaultKind::StuckEncoder;
      d.fault.device = Device::Drive;
      d.fault.wheel = random.below(2) == 0 ? simulation::Wheel::Left : simulation::Wheel::Right;
      d.fault.for_s = random.uniform(0.5, 3.0);
      break;
    default:
      d.fault.kind = FaultKind::Silence;
      d.fault.device = Device::Drive;
      d.fault.for_s = random.uniform(0.5, 5.0);
  }
  return d;
}

Delivery plan_delivery(int number, int station, const Wishes& wishes, Random& random) {
  Delivery d;
  d.number = number;
  d.station = station;
  if (const auto k = event_at(number, wishes.kidnappings, wishes.deliveries, 0.5))
    d.kidnapping = *k % 2 == 0 ? Kidnapping{false, random.uniform(5.0, 20.0)}
                               : Kidnapping{true, random.uniform(0.0, 5.0)};
  if (const auto k = event_at(number, wishes.dropouts, wishes.deliveries, 0.9))
    d.dropout = dropout_of(*k, random);
  d.person_crosses = random.uniform() < wishes.crossing_share;
  d.pallet_on_way = random.uniform() < wishes.pallet_share;
  return d;
}

/// Aisles without which every station is still reached: on every second day one of them is closed.
std::optional<planning::RouteLeg> closed_aisle(const planning::RouteGraph& routes, Random& random) {
  constexpr double kLongM = 8.0;
  std::vector<planning::RouteLeg> aisles;
  for (const auto& leg : routes.legs()) {
    if (leg.length_m < kLongM || leg.from > leg.to) continue;
    if (planning::find_route(routes, leg.from, leg.to, planning::RouteMetric::Hops,
                             {{leg.from, leg.to}, {leg.to, leg.from}}))
      aisles.push_back(leg);
  }
  if (aisles.empty() || random.below(2) == 0) return std::nullopt;
  return aisles[random.below(aisles.size())];
}

}  // namespace

Day plan_day(int number, const Wishes& wishes, const planning::RouteGraph& routes) {
  std::vector<int> stations;
  for (const auto& node : routes.nodes())
    if (node.station && !routes.legs_from(*routes.index_of(node.id)).empty()) stations.push_back(node.id);
  Random random = chance_of(wishes, number, 0);
  Day day;
  day.number = number;
  day.first_station = stations[random.below(stations.size())];
  day.closed_aisle = closed_aisle(routes, random);
  const int first = static_cast<int>(static_cast<long>(number) * wishes.deliveries / wishes.days);
  const int end = static_cast<int>(static_cast<long>(number + 1) * wishes.deliveries / wishes.days);
  int last = day.first_station;
  for (int i = first; i < end; ++i) {
    Random own = chance_of(wishes, number, i + 1);
    int next = last;
    while (next == last) next = stations[own.below(stations.size())];
    last = next;
    day.deliveries.push_back(plan_delivery(i, next, wishes, own));
  }
  return day;
}

}  // namespace madori::soak
