#pragma once

#include <optional>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/registration/segment_grid.hpp"
#include "localization/registration/segment_icp.hpp"
#include "localization/scan_points.hpp"
#include "localization/wall_tracker/lead.hpp"

namespace madori::localization {

struct NearbyRivalOptions {
  SegmentIcpOptions icp = {.max_iterations = 10, .first_scale_m = 0.25};
  double ring_m = 0.25;        ///< starts beside the pose lie on circles of this radius and of twice it,
  int directions = 8;          ///< so many on each
  double apart_m = 0.1;        ///< nearer is the same place,
  double most_m = 0.8;         ///< and farther is another question
  double every_m = 0.5;        ///< of driving between two scans that are asked: on the spot all see the same
  int fewest_votes = 10;       ///< before the rival may be believed,
  int fewest_where_clear = 5;  ///< or, if it leads that much:
  double clear_lead = 0.15;
  int most_votes = 25;       ///< asked in vain so often: the vehicle is where it was found
  double enough = 0.06;      ///< share by which the rival must explain more of a scan, on average,
  double lead_sigmas = 3.0;  ///< and so surely
  double at_once = 0.1;      ///< by which it must where the vehicle is only just found
  double sure_inliers = 0.35;
};

/// Does the vehicle stand a step beside the place where it was found? Where racks or machines were moved
/// since the drawing, registration may settle on their new faces, and each scan after it starts there. So for
/// the first metres a second pose is tracked beside the first, the best of those that other starts lead to,
/// and believed where it explains surely more over different scans. What explains is the weight of the points
/// that lie on drawn walls, those beside them less: the share of inliers cannot tell the two apart.
/// Deterministic, causal.
class NearbyRival {
 public:
  explicit NearbyRival(const NearbyRivalOptions& options = {}) : options_(options) {}

  /// The vehicle was just found at `fit`: the best pose beside it where that one explains clearly more of
  /// this scan, `fit` itself elsewhere. The question is open from now on.
  [[nodiscard]] RegistrationResult begin(const ScanPoints& points, const SegmentGrid& grid,
                                         const RegistrationResult& fit);
  /// Opens the question (again): the pose was carried by the wheels alone.
  void reopen();
  /// A scan (Base frame), the pose tracked there, and the motion since the scan before. The rival where it is
  /// believed from now on.
  [[nodiscard]] std::optional<RegistrationResult> observe(const ScanPoints& points, const SegmentGrid& grid,
                                                          const Transform2<Map, Base>& pose,
                                                          const Transform2<Base, Base>& motion);
  [[nodiscard]] bool rests() const { return votes_left_ == 0; }

 private:
  struct Rival {
    Transform2<Map, Base> pose;  ///< carried along by the motion
    int votes = 0;
    Lead lead = {};  ///< over the tracked pose
  };
  [[nodiscard]] bool is_beside(const RegistrationResult& other, const RegistrationResult& here) const;
  [[nodiscard]] std::optional<RegistrationResult> best_on_ring(const ScanPoints& points,
                                                               const SegmentGrid& grid,
                                                               const RegistrationResult& here,
                                                               double radius_m) const;
  [[nodiscard]] std::optional<RegistrationResult> best_rival(const ScanPoints& points,
                                                             const SegmentGrid& grid,
                                                             const RegistrationResult& here);
  [[nodiscard]] bool is_sure() const;

  NearbyRivalOptions options_;
  int votes_left_ = 0;
  std::optional<Rival> rival_;
  Transform2<Base, Base> since_;
};

}  // namespace madori::localization
