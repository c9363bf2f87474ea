#include "localization/surroundings/surroundings.hpp"

#include <algorithm>

namespace madori::localization {
namespace {

/// What two scans in a row both see falls by so much below the usual where the later one was taken elsewhere:
/// neither driving nor what moves about changes a quarter of the walls in a tenth of a second.
constexpr double kCarriedFall = 0.25;
constexpr double kWheelsFall = 0.08;  // from here on the wheels may be wrong: the walls are asked as well

}  // namespace

void SurroundingsCheck::take(Stamp stamp, const ScanPoints& points) {
  view_.take(stamp, points);
  gap_s_ = newest_ ? to_seconds(stamp - *newest_) : 1e9;
  newest_ = stamp;
}

Surroundings SurroundingsCheck::compare(const Transform2<Base, Base>& by_wheels,
                                        const Transform2<Base, Base>& by_walls) {
  double kept = view_.kept(by_wheels);
  if (view_.fall(kept) > kWheelsFall) kept = std::max(kept, view_.kept(by_walls));
  if (view_.fall(kept) > kCarriedFall) return Surroundings::Others;
  view_.learn(kept);
  return Surroundings::Same;
}

}  // namespace madori::localization
