#pragma once

#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/registration/segment_grid.hpp"
#include "localization/registration/segment_icp.hpp"
#include "localization/scan_points.hpp"
#include "localization/wall_tracker/lead.hpp"

namespace madori::localization {

struct ScaleBankOptions {
  SegmentIcpOptions icp = {.max_iterations = 10, .first_scale_m = 0.25};
  int beside = 8;              ///< sizes tried on each side of the one believed
  double coarse = 0.0025;      ///< between two sizes at first,
  double fine = 0.0005;        ///< and once the coarse one is settled
  double every_m = 0.4;        ///< of driving between two scans that are asked
  double every_rad = 0.3;      ///< or of turning
  int scans_a_stretch = 5;     ///< neighbouring scans see the same walls: they have one vote together
  int fewest_stretches = 8;    ///< before another size may be believed,
  int fewest_where_clear = 3;  ///< or, if it leads that much:
  double clear_lead = 0.15;
  int most_stretches = 50;    ///< after so many without an answer it begins anew, or is left at that
  double coarse_lead = 0.05;  ///< by which another size must explain more of a scan, on average,
  double fine_lead = 0.01;
  double lead_sigmas = 4.0;        ///< and so surely
  double most_correction_m = 0.4;  ///< a scan that asks for more speaks of another place
  double sure_inliers = 0.35;
};

/// How large the building is against its drawing, found by driving: one tracker for each size that it may
/// have, side by side, and the one whose walls lie best on the drawn ones is believed (multiple model
/// adaptive estimation, Magill 1965). A single tracker cannot find out: on a drawing half a per cent too
/// small it follows the near walls, takes far ones for the faces behind them, and its residuals say that all
/// is well. First coarsely, then finely. Where the drawing proves right it sleeps then; another size stays in
/// question, beside the drawn one. Deterministic, causal.
class ScaleBank {
 public:
  explicit ScaleBank(const ScaleBankOptions& options = {});

  /// Metres of the drawing a metre seen. Exactly 1 while the drawing is not surely of another size.
  [[nodiscard]] double factor() const { return 1.0 + believed_; }
  /// The scan as large as the drawing.
  [[nodiscard]] ScanPoints applied(const ScanPoints& points) const;
  /// The vehicle is there (again): what each tracker knew of its place is forgotten, not what it learned.
  void start_at(const Transform2<Map, Base>& pose);
  void lose() { placed_ = false; }
  /// A scan that fitted (as seen, Base frame), and the motion since the one before. True where another size
  /// is believed from now on; best_pose() is the vehicle's place with it.
  bool observe(const ScanPoints& seen, const SegmentGrid& grid, const Transform2<Base, Base>& motion);
  [[nodiscard]] const Transform2<Map, Base>& best_pose() const { return best_pose_; }
  [[nodiscard]] bool sleeps() const { return stage_ >= kStages; }

 private:
  static constexpr int kStages = 2;
  /// One size. Its leads are over the size believed.
  struct Member {
    double excess = 0.0;  ///< its factor less one
    Transform2<Map, Base> pose;
    double explained = 0.0;  ///< of the newest scan
    double stretch = 0.0;    ///< sum of leads over the scans of this stretch
    Lead lead = {};          ///< of the stretches' means
  };
  [[nodiscard]] double step() const { return stage_ == 0 ? options_.coarse : options_.fine; }
  [[nodiscard]] Member& believed_member() { return members_[static_cast<std::size_t>(options_.beside)]; }
  void begin_stage(int stage, const Transform2<Map, Base>& pose);
  void ask(Member& member, const ScanPoints& points, const SegmentGrid& grid,
           const Transform2<Map, Base>& start);
  void end_stretch();
  [[nodiscard]] bool is_sure(const Member& member) const;
  bool decide();

  ScaleBankOptions options_;
  double believed_ = 0.0;
  int stage_ = 0;
  bool placed_ = false;
  int scans_ = 0;      ///< of this stretch
  int stretches_ = 0;  ///< of this stage
  /// Smallest first; the middle one is the size believed. At last the size drawn, unless it is believed.
  std::vector<Member> members_;
  Transform2<Base, Base> since_;
  Transform2<Map, Base> best_pose_;
};

}  // namespace madori::localization
