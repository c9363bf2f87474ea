#pragma once

#include <vector>

#include "core/pose_estimate.hpp"
#include "localization/wall_reliability/wall_looks.hpp"

namespace madori::localization {

enum class WallState { Unseen, Confirmed, Missing, Displaced };
[[nodiscard]] const char* to_string(WallState state);

/// What driving has taught of one piece of wall: counts of independent looks, and where the surface stands
/// that is seen instead.
struct WallBelief {
  double in_place = 0.0;  ///< looks that found it where it is drawn
  double beside = 0.0;    ///< looks that found it at `offset_m`
  double missed = 0.0;    ///< looks through it
  double offset_m = 0.0;  ///< positive to the left of a -> b
  double offset_sigma_m = 0.0;
  double drawn_offset_m = 0.0;  ///< mean offset of the looks that found it in place

  [[nodiscard]] double looks() const { return in_place + beside + missed; }
};

struct ReliabilityOptions {
  double cell_m = 1.0;
  LookOptions look;
  double apart_m = 0.5;         ///< a look counts when the vehicle stands so far from the last one counted,
  double later_m = 25.0;        ///< or has driven so far since
  double in_place_m = 0.15;     ///< a wall nearer to its drawn place than this (and 2 sigmas) is confirmed
  double same_place_m = 0.15;   ///< looks beside that differ by less are of the same surface
  double most_sigma_m = 0.25;   ///< a look whose pose is less certain teaches nothing
  double most_looks = 40.0;     ///< counts fade beyond, so that a wall that is torn down is unlearned
  double enough_looks = 3.0;    ///< before a piece has a state
  double prior_in_place = 2.0;  ///< looks' worth of belief in the drawing
};

/// Which drawn walls the lidar confirms, misses or sees displaced, by the piece. A Dirichlet count over (in
/// place, beside, missing) a piece; looks from the same place are one look, however long the vehicle stands
/// there. Deterministic; a few hundred microseconds a look that counts, nothing while standing.
class WallReliability {
 public:
  explicit WallReliability(const mapping::Walls& walls, const ReliabilityOptions& options = {});

  /// A scan at an estimated pose. Learns only where the pose is LOCALIZED, and only from places apart.
  void observe(const SurfaceScan& scan, const PoseEstimate& pose);
  /// Would observe() look at all? Cheap; spares the caller the making of a SurfaceScan.
  [[nodiscard]] bool is_due(const PoseEstimate& pose) const;

  [[nodiscard]] const WallCells& cells() const { return cells_; }
  [[nodiscard]] const std::vector<WallBelief>& beliefs() const { return beliefs_; }
  void set_beliefs(std::vector<WallBelief> beliefs) { beliefs_ = std::move(beliefs); }
  [[nodiscard]] WallState state(std::size_t cell) const;
  /// Probability that the piece stands where it is drawn: the mean of the counts with the prior.
  [[nodiscard]] double share_in_place(std::size_t cell) const;
  [[nodiscard]] const ReliabilityOptions& options() const { return options_; }

 private:
  struct LastLook {
    Point2<Map> place;
    double driven_m = -1e9;
  };
  void learn(const WallLook& look);

  ReliabilityOptions options_;
  WallCells cells_;
  WallIndex index_;
  std::vector<WallBelief> beliefs_;
  std::vector<LastLook> last_;
  bool moving_ = false;
  Transform2<Map, Base> before_;  ///< pose of the last scan looked at
  double driven_m_ = 0.0;
};

}  // namespace madori::localization
