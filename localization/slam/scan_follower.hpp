#pragma once

#include "core/odometry.hpp"
#include "core/stamp.hpp"
#include "localization/localizer/keyframe_motion.hpp"
#include "localization/localizer/map_state.hpp"
#include "localization/localizer/options.hpp"
#include "localization/motion_model/odometry_track.hpp"

namespace madori::localization {

/// The wheels between scans, and what each scan makes of them, for mappers that go by keyframes.
class ScanFollower {
 public:
  /// Where a scan lies.
  struct Followed {
    MatchResult place;  ///< in all that was seen; good for something only where `found`
    bool found = false;
    Transform2<Base, Base> motion;  ///< since the last scan: by the keyframes driven last; where they do not
                                    ///< know the scan, by all that was seen; else by the wheels
    bool is_known = false;          ///< to the keyframes driven last
    OdometryStep wheels;            ///< since the last scan
  };

  explicit ScanFollower(const LocalizerOptions& options) : options_(options), model_(options.odometry) {}

  void on_odometry(const OdometryReading& reading);
  /// Matches a scan; the one before lay at `from`.
  [[nodiscard]] Followed follow(const SurfaceScan& scan, const Transform2<Map, Base>& from,
                                const MapState& map);
  /// A scan was taken in: the wheels count from there.
  void note_scan(Stamp stamp);
  void begin_keyframe() { since_keyframe_ = {}; }

  [[nodiscard]] const OdometryStep& since_scan() const { return since_scan_; }
  [[nodiscard]] const KeyframeMotion& since_keyframe() const { return since_keyframe_; }

 private:
  LocalizerOptions options_;
  OdometryModel model_;
  OdometryTrack track_;
  Stamp scan_stamp_{};
  OdometryStep since_scan_;
  KeyframeMotion since_keyframe_;
  double usual_inliers_ = 0.6;
};

}  // namespace madori::localization
