#include "localization/wall_tracker/distant_rival.hpp"

#include <algorithm>
#include <cmath>

#include "localization/wall_tracker/same_place.hpp"

namespace madori::localization {
namespace {

using Pose = Transform2<Map, Base>;

/// The hypothesis of the answer that lies at `pose`; null when it has none there.
const Hypothesis* at(const GlobalAnswer& answer, const Pose& pose) {
  const auto found =
      std::find_if(answer.hypotheses.begin(), answer.hypotheses.end(),
                   [&](const Hypothesis& h) { return is_same_place(h.fit.map_from_base, pose); });
  return found == answer.hypotheses.end() ? nullptr : &*found;
}

/// By how many nats the best place elsewhere leads the one at `pose`, of which `unfit` stands where the
/// answer does not know it.
double lead_of_elsewhere(const GlobalAnswer& answer, const Pose& pose, double unfit) {
  const Hypothesis* tracked = at(answer, pose);
  if (tracked == nullptr) return unfit;
  const auto& all = answer.hypotheses;
  const auto rival = std::find_if(all.begin(), all.end(), [&](const Hypothesis& h) { return &h != tracked; });
  return rival == all.end() ? -1e3 : rival->log_likelihood - tracked->log_likelihood;
}

}  // namespace

void DistantRival::restart() {
  rivals_ = calm_ = 0;
  unsettle();
  usual_through_ = 0.0;
}

void DistantRival::unsettle() {
  settled_ = 0;
  settled_m_ = 0.0;
}

bool DistantRival::is_doubtful(const TrackerEvidence& evidence) const {
  return evidence.explained < usual_explained_ - options_.doubt_fall ||
         evidence.through_walls > usual_through_ + options_.doubt_through ||
         evidence.nearby_nats > options_.doubt_nats;
}

bool DistantRival::is_settled() const {
  return settled_ >= options_.scans_to_settle && settled_m_ >= options_.metres_to_settle;
}

bool DistantRival::wants_look(const TrackerEvidence& evidence, bool is_unclear, bool has_changed,
                              const Transform2<Base, Base>& motion) {
  calm_ = std::max(0, calm_ - 1);
  since_rival_m_ += std::hypot(motion.x_m(), motion.y_m());
  const bool looks = calm_ == 0 && (!is_settled() || since_rival_m_ >= options_.settled_every_m);
  return has_changed || ((is_unclear || is_doubtful(evidence)) && looks);
}

PlaceVerdict DistantRival::judge(const GlobalAnswer& all, const Pose& pose, bool has_changed) {
  since_rival_m_ = 0.0;
  if (has_changed) settled_ = 0;
  const bool settled = is_settled();
  const double enough = settled ? options_.settled_nats : options_.rival_nats;
  const double lead = lead_of_elsewhere(all, pose, enough);
  if (has_changed && lead > -options_.twin_nats) return PlaceVerdict::ChangedAndAlike;
  if (lead < enough) {
    rivals_ = 0;
    calm_ = options_.calm_scans;
    return PlaceVerdict::Stands;
  }
  if (++rivals_ < (settled ? options_.settled_rivals : options_.rivals_to_lose)) return PlaceVerdict::Stands;
  return PlaceVerdict::Elsewhere;
}

void DistantRival::learn(const TrackerEvidence& evidence, const Transform2<Base, Base>& motion) {
  constexpr double kUsual = 0.1;
  usual_explained_ += kUsual * (evidence.explained - usual_explained_);
  usual_through_ += kUsual * (evidence.through_walls - usual_through_);
  ++settled_;
  settled_m_ += std::hypot(motion.x_m(), motion.y_m());
  if (!is_doubtful(evidence)) rivals_ = 0;
}

}  // namespace madori::localization
