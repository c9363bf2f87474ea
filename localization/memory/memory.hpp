#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/frames.hpp"
#include "core/transform2.hpp"
#include "localization/memory/local_map.hpp"
#include "localization/memory/pose_graph.hpp"
#include "localization/memory/surface_scan.hpp"

namespace madori::localization {

/// Sizes of the memory. Lengths are metres of driving unless said otherwise.
struct MemoryOptions {
  double window_path_m = 12.0;  ///< keyframes this recent are matched against in any case
  int window_keyframes = 30;    ///< at most
  double map_radius_m = 18.0;   ///< of the surfaces around the vehicle that are matched against
  double loop_radius_m = 3.5;   ///< how near an old keyframe must be to close a loop with it
  int loop_chain = 12;          ///< keyframes around the nearest one that make the piece to match against
  double loop_inliers = 0.55;   ///< share of the scan that must fit
  double nearby_m = 5.0;        ///< old keyframes this near count as nearby
  int nearby_keyframes = 20;    ///< at most
  double break_open_m = 60.0;   ///< a break in the chain counts as so much driving
  double drift_per_m = 0.015;   ///< growth of the uncertainty between loops, metres a metre
  double drift_rad_per_m = 0.004;
};

/// A remembered scan at its pose.
struct Keyframe {
  SurfaceScan scan;
  double path_m = 0.0;  ///< driven since the start
};

/// What the vehicle has seen itself: keyframes in a pose graph. Poses are Map frame, and are only as right as
/// the first one and the unary factors of the drawing make them. Causal, deterministic; it grows with the way
/// driven.
class Memory {
 public:
  explicit Memory(const MemoryOptions& options = {});

  [[nodiscard]] bool empty() const { return keyframes_.empty(); }
  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }
  [[nodiscard]] const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] const std::vector<Transform2<Map, Base>>& poses() const { return poses_; }
  [[nodiscard]] const std::vector<RelativeFactor>& factors() const { return factors_; }
  [[nodiscard]] int loops() const { return loops_; }

  /// The first of the keyframes that count as recent.
  [[nodiscard]] std::size_t window_begin() const;
  /// The recent surfaces around a place.
  [[nodiscard]] LocalMap recent_map(const Point2<Map>& centre) const;
  /// These, and what older keyframes near the place saw.
  [[nodiscard]] LocalMap whole_map(const Point2<Map>& centre) const;
  /// The chain of motions may be broken here: loops are sought in a wide window until one is closed.
  void note_break() { extra_open_m_ = options_.break_open_m; }
  /// Adds a keyframe; `motion` from the newest one with its information (axes of the newest), if there is
  /// one.
  int add(Keyframe keyframe, const Transform2<Map, Base>& map_from_base,
          const Eigen::Matrix3d& motion_information);
  /// Looks for old keyframes near the newest and ties it to them. Returns how many loops were closed.
  int close_loops();
  /// Solves the graph with the drawing's pulls.
  bool optimise(const std::vector<UnaryFactor>& unary);
  /// Moves the keyframes from `first` on rigidly.
  void move(const Transform2<Map, Map>& by, std::size_t first = 0);

 private:
  struct LoopCandidate {
    std::size_t nearest;
    std::size_t first;
    std::size_t last;
    double distance_m;
  };
  [[nodiscard]] std::vector<LoopCandidate> loop_candidates() const;
  [[nodiscard]] bool close_loop(const LoopCandidate& candidate);

  MemoryOptions options_;
  std::vector<Keyframe> keyframes_;
  std::vector<Transform2<Map, Base>> poses_;
  std::vector<RelativeFactor> factors_;
  int loops_ = 0;
  double last_loop_path_m_ = 0.0;
  double extra_open_m_ = 0.0;
};

}  // namespace madori::localization
