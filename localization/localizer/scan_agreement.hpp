#pragma once

#include "core/stamp.hpp"
#include "localization/health/wall_fit.hpp"
#include "localization/localizer/map_state.hpp"

namespace madori::localization {

/// Does a scan agree with the memory as scans usually do here? Furniture and people hide walls: that the
/// drawing does not show what is seen is no reason for doubt while memory and wheels go on. Once in doubt,
/// the memory alone does not clear it: what was added since the doubt began agrees with itself anywhere.
/// Deterministic, causal.
class ScanAgreement {
 public:
  /// The memory begins with a scan of this stamp.
  void begin(Stamp stamp);
  /// A scan, the pose where it was matched and the one that the wheels predicted, `step` after the scan
  /// before. The map's evidence takes note of what it says.
  void note(const SurfaceScan& scan, const MatchResult& match, const Transform2<Map, Base>& prediction,
            const OdometryStep& step, MapState& map, const LocalizerOptions& options);

  /// Whether the last scan lies beside the drawn walls: the newest stretch may have drifted.
  [[nodiscard]] bool is_beside_walls() const { return beside_walls_; }
  [[nodiscard]] double usual_inliers() const { return usual_inliers_; }
  /// The map's evidence, and how long no scan has agreed.
  [[nodiscard]] HealthEvidence evidence_at(Stamp stamp, const HealthEvidence& evidence) const;

 private:
  [[nodiscard]] bool is_known_from_before(const SurfaceScan& scan, const MatchResult& match,
                                          const MapState& map, double until_path_m,
                                          const LocalizerOptions& options) const;

  double usual_inliers_ = 0.6;  ///< share of a scan that fits the memory
  WallFit wall_fit_;
  bool beside_walls_ = false;
  bool driven_before_ = false;  ///< what is seen beside the walls now was seen there on an earlier way, too
  Stamp last_agreed_{};
  double doubt_path_m_ = 0.0;  ///< driven when the last scan agreed; newer keyframes agree with themselves
};

}  // namespace madori::localization
