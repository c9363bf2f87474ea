#include "localization/landmarks/crossings.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/landmarks/place_sense.hpp"

namespace madori::localization::landmarks {
namespace {

Surroundings look_around(const SurfaceScan& scan) {
  ScanPoints points;
  for (const SurfacePoint& p : scan.points) points.add(p.x_m, p.y_m);
  return landmarks::look_around(points);
}

}  // namespace

Crossings::Crossings(const Memory& memory) {
  PlaceSense sense;
  for (std::size_t i = 0; i < memory.size(); ++i) {
    const Transform2<madori::Map, Base>& at = memory.poses()[i];
    if (memory.keyframes()[i].after_break) sense = PlaceSense();
    if (i > 0 && !memory.keyframes()[i].after_break) {
      const Transform2<Base, Base> step = memory.poses()[i - 1].inverse() * at;
      sense.move(std::hypot(step.x_m(), step.y_m()), step.yaw_rad());
    }
    const Surroundings seen = look_around(*memory.keyframes()[i].scan);
    if (sense.at_a_place(seen)) keep({at, seen.corridor_width_m, seen.descriptor});
  }
}

void Crossings::keep(const Crossing& crossing) {
  const bool known = std::any_of(all_.begin(), all_.end(), [&](const Crossing& other) {
    return distance_m(other.at.translation(), crossing.at.translation()) <
           std::max(other.width_m, crossing.width_m);
  });
  if (!known) all_.push_back(crossing);
}

std::vector<Transform2<madori::Map, Base>> Crossings::where(const SurfaceScan& scan) const {
  const Surroundings seen = look_around(scan);
  std::vector<std::pair<double, Transform2<madori::Map, Base>>> found;
  for (const Crossing& crossing : all_)
    if (const auto match = recognise_anywhere(crossing.descriptor, seen)) {
      const Displacement& d = match->landmark_from_scan;
      found.push_back({match->quality, crossing.at * Transform2<Base, Base>(d.x_m, d.y_m, d.yaw_rad)});
    }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<Transform2<madori::Map, Base>> places;
  for (const auto& [quality, place] : found) places.push_back(place);
  return places;
}

}  // namespace madori::localization::landmarks
