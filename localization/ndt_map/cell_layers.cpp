#include "localization/ndt_map/cell_layers.hpp"

#include <algorithm>
#include <cmath>

namespace madori::localization {
namespace {

void add(float& layer, double evidence, double least, double most) {
  layer = static_cast<float>(std::clamp(static_cast<double>(layer) + evidence, least, most));
}

float between(float from, float to, double share) {
  return static_cast<float>(from + share * (static_cast<double>(to) - from));
}

/// How independent two looks are, 0..1.
double apart(double seconds, double tau_s) {
  return seconds > 0.0 ? -std::expm1(-seconds / tau_s) : 0.0;
}

}  // namespace

CellLayers CellLayers::at(Stamp stamp, const LayerOptions& options) const {
  if (!was_seen()) return *this;
  const double since_s = to_seconds(stamp - seen);
  CellLayers then = *this;
  const float stays = lasts(options) ? permanent : std::min(permanent, 0.0F);
  then.stands = between(stands, stays, apart(since_s, options.permanent_tau_s));
  then.now = between(now, then.stands, apart(since_s, options.stands_tau_s));
  return then;
}

void CellLayers::take(double evidence, Stamp stamp, const LayerOptions& options, double same_thing) {
  const double look = std::clamp(evidence, -options.look_most, options.look_most);
  const double since_s = was_seen() ? to_seconds(stamp - seen) : 0.0;
  const bool same = (now > 0.0F) == (look > 0.0) && now != 0.0F;  // as at the look before
  *this = at(stamp, options);
  // What came, or went, while nobody looked may have been so all that time: what was seen before says less.
  if (!same && (look > 0.0) == (stands < 0.0F))
    stands = between(stands, 0.0F, apart(since_s, options.stands_tau_s) * std::abs(look) / options.look_most);
  if (same) {
    add(stands, apart(since_s, options.stands_tau_s) * look, -options.stands_most, options.stands_most);
    // Another thing than the one that was known: of the new one nothing is known.
    const double least = look > 0.0 ? std::min(permanent, 0.0F) : options.permanent_least;
    const double sureness = look > 0.0 ? 2.0 * same_thing - 1.0 : 1.0;
    add(permanent, apart(since_s, options.permanent_tau_s) * look * sureness, least, options.permanent_most);
  }
  add(now, look, -options.now_most, options.now_most);
  seen = std::max(seen, stamp);
}

CellState CellLayers::state(Stamp stamp, const LayerOptions& options, DrawnAs drawn,
                            bool is_what_lasts) const {
  if (!was_seen()) return CellState::Unseen;
  const CellLayers then = at(stamp, options);
  if (then.now > options.known) {
    if (drawn == DrawnAs::Wall || (lasts(options) && is_what_lasts)) return CellState::Static;
    if (then.stands <= options.stands) return CellState::Moving;
    return drawn == DrawnAs::Line ? CellState::Static : CellState::SemiStatic;
  }
  if (then.now < -options.known)
    return lasts(options) || then.stands > options.gone ? CellState::TakenAway : CellState::Free;
  return CellState::Unseen;
}

}  // namespace madori::localization
