#pragma once

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/global/global_localizer.hpp"
#include "localization/wall_tracker/tracker_evidence.hpp"

namespace madori::localization {

struct DistantRivalOptions {
  double doubt_fall = 0.10;     ///< of the explained share below the usual: other places are looked at
  double doubt_through = 0.10;  ///< rise of the share of beams through drawn walls: likewise
  double doubt_nats = 4.0;      ///< by which a pose within 2 m may fit better before: likewise
  double rival_nats = 5.0;      ///< by which another place must fit better to contradict the pose
  int rivals_to_lose = 2;       ///< contradictions in a row
  /// After so many scans and metres that fitted, with no sign that the vehicle was carried, it is where it is
  /// said to be: among racks another place may fit by chance, as long as the vehicle stands there. More is
  /// needed then, from that many places so far apart.
  int scans_to_settle = 50;
  double metres_to_settle = 2.0;
  double settled_nats = 15.0;
  int settled_rivals = 10;
  double settled_every_m = 0.3;
  int calm_scans = 2;       ///< after the other places were looked at in vain
  double twin_nats = 12.0;  ///< by which a place may fit worse to look alike
};

/// What a look at all places says of the tracked one: it stands; the surroundings changed and another place
/// suits the scan about as well; another place suits it clearly better, time and again.
enum class PlaceVerdict { Stands, ChangedAndAlike, Elsewhere };

/// Does the vehicle stand elsewhere on the drawing (kidnapped robot)? Says when the scan raises enough doubt
/// to look at all places, and what follows from the look. Deterministic, causal.
class DistantRival {
 public:
  explicit DistantRival(const DistantRivalOptions& options) : options_(options) {}

  /// The vehicle was just found: nothing of the way before counts.
  void restart();
  /// The share of a scan on drawn walls that is usual from now on.
  void expect(double explained) { usual_explained_ = explained; }
  /// Too long since the scan before to know that the vehicle was not carried.
  void unsettle();

  /// A scan, and the motion since the one before: whether to look at all places. `is_unclear`: the scan's
  /// registration is not to be trusted; `has_changed`: nor are the surroundings what they were.
  [[nodiscard]] bool wants_look(const TrackerEvidence& evidence, bool is_unclear, bool has_changed,
                                const Transform2<Base, Base>& motion);
  /// The look: `all` places that the scan may be from, the one tracked at `pose` among them.
  [[nodiscard]] PlaceVerdict judge(const GlobalAnswer& all, const Transform2<Map, Base>& pose,
                                   bool has_changed);
  /// The scan fitted where the vehicle is tracked.
  void learn(const TrackerEvidence& evidence, const Transform2<Base, Base>& motion);

 private:
  [[nodiscard]] bool is_doubtful(const TrackerEvidence& evidence) const;
  [[nodiscard]] bool is_settled() const;

  DistantRivalOptions options_;
  int rivals_ = 0;              ///< contradictions in a row
  int settled_ = 0;             ///< scans that fitted since the vehicle may last have been carried,
  double settled_m_ = 0.0;      ///< and metres driven with them
  double since_rival_m_ = 0.0;  ///< metres driven since other places were last looked at
  int calm_ = 0;
  double usual_explained_ = 0.0;
  double usual_through_ = 0.0;
};

}  // namespace madori::localization
