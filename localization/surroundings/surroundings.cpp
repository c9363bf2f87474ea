#include "localization/surroundings/surroundings.hpp"

#include <algorithm>

namespace madori::localization {

void SurroundingsCheck::take(Stamp stamp, const ScanPoints& points) {
  view_.take(stamp, points);
  kept_ = 1.0;
  gap_s_ = newest_ ? to_seconds(stamp - *newest_) : 1e9;
  newest_ = stamp;
}

Surroundings SurroundingsCheck::compare(const Transform2<Base, Base>& by_wheels,
                                        const Transform2<Base, Base>& by_walls) {
  kept_ = view_.kept(by_wheels);
  if (view_.fall(kept_) > options_.wheels_fall) kept_ = std::max(kept_, view_.kept(by_walls));
  const double fall = view_.fall(kept_);
  if (fall > options_.carried_fall) return Surroundings::Others;
  view_.learn(kept_);
  return Surroundings::Same;
}

}  // namespace madori::localization
