#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "localization/memory/keyframe.hpp"
#include "localization/memory/match_room.hpp"
#include "localization/memory/memory_options.hpp"
#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// What the vehicle has seen itself: keyframes in a pose graph. Poses are Map frame, and are only as right as
/// the first one and the unary factors of the drawing make them. Causal, deterministic. A copy is cheap.
class Memory {
 public:
  explicit Memory(const MemoryOptions& options = {});
  /// As it was kept from an earlier drive. What follows is tied to it by loops only, sought in a wide window.
  Memory(const MemoryOptions& options, std::vector<Keyframe> keyframes,
         std::vector<Transform2<Map, Base>> poses, std::vector<RelativeFactor> factors, int loops);

  [[nodiscard]] bool empty() const { return keyframes_.empty(); }
  [[nodiscard]] std::size_t size() const { return keyframes_.size(); }
  [[nodiscard]] const std::vector<Keyframe>& keyframes() const { return keyframes_; }
  [[nodiscard]] const std::vector<Transform2<Map, Base>>& poses() const { return poses_; }
  [[nodiscard]] const std::vector<RelativeFactor>& factors() const { return factors_; }
  [[nodiscard]] int loops() const { return loops_; }

  /// The first of the keyframes that count as recent.
  [[nodiscard]] std::size_t window_begin() const { return empty() ? 0 : window_begin(size() - 1); }
  /// The weakest agreement between the keyframes from `first` on: where all are strong, nothing has drifted.
  [[nodiscard]] double weakest_agreement(std::size_t first) const;
  /// The recent surfaces around a place; made anew only where the memory has changed, or the place by metres.
  /// Good until the memory changes or is asked again.
  [[nodiscard]] const LocalMap& recent_map(const Point2<Map>& centre) const;
  /// These, and what older keyframes near the place saw; none that was added after so much driving. Likewise.
  [[nodiscard]] const LocalMap& whole_map(const Point2<Map>& centre, double until_path_m = 1e12) const;
  /// The chain of motions may be broken here: loops are sought in a wide window until one is closed.
  void note_break() { broken_ = true; }
  /// Adds a keyframe after `path_m` more of driving, tied to the newest one by the measured motion between
  /// them, which need not be the difference of the poses: where an old place was found again it is not.
  void add(const SurfaceScan& scan, double path_m, const Transform2<Map, Base>& map_from_base,
           const MeasuredMotion& motion);
  /// The same where the poses' difference is what was measured, with its information (axes of the newest).
  void add(const SurfaceScan& scan, double path_m, const Transform2<Map, Base>& map_from_base,
           const Eigen::Matrix3d& motion_information);
  /// The vehicle was carried to where keyframe `first` is: nothing leads there from those before it, and what
  /// follows is a piece of its own. Loops across the cut are forgotten, and sought anew once it is tied.
  void cut(std::size_t first);
  /// Another motion from its forerunner leads to keyframe `first`, and all later ones go with it; loops with
  /// what was before are forgotten.
  void lead_otherwise(std::size_t first, const RelativeFactor& motion);
  /// Ties two keyframes each; they may lie in different pieces.
  void tie(const std::vector<RelativeFactor>& loops);
  /// For every keyframe the first one of its piece: the keyframes that motions and loops lead to.
  [[nodiscard]] std::vector<std::size_t> pieces() const;
  /// Moves a piece rigidly, by its number from pieces().
  void move_piece(const Transform2<Map, Map>& by, std::size_t piece);
  /// Forgets all other pieces.
  void keep_piece(std::size_t piece);
  /// Forgets the newest keyframes to which the chain of motions is broken: they lie anywhere.
  void forget_broken_end();
  /// What an earlier drive remembered, in the same frame, comes before all of this; the two are tied by
  /// nothing but the loops that will be found.
  void put_behind(Memory earlier);
  /// Says whether a loop that was found is to be closed.
  using LoopCheck = std::function<bool(const Memory&, const RelativeFactor&)>;
  /// Looks for old keyframes near those added since the last time and ties them, where `is_right` has nothing
  /// against it. Returns how many loops were closed.
  int close_loops(const LoopCheck& is_right = {});
  /// Forgets loops that turned out wrong. Returns how many.
  int forget_loops(const LoopCheck& is_wrong);
  /// No loops are looked for behind the keyframes so far: something else holds them in their places.
  void skip_loops() {
    looked_back_ = size();
    if (!empty()) last_loop_path_m_ = keyframes_.back().path_m;
  }
  /// Takes out old keyframes where newer ones saw the same place, so that the memory grows with the building
  /// and not with the way driven. Returns how many.
  int fuse();
  /// What the memory takes, about.
  [[nodiscard]] std::size_t bytes() const;
  /// Solves the graph with the drawing's pulls.
  bool optimise(const std::vector<UnaryFactor>& unary, const GraphOptions& options = {});
  /// Nats by which the loops closed across `first` speak against such a move (Cauchy, as in the graph).
  [[nodiscard]] double loops_against(const Transform2<Map, Map>& by, std::size_t first) const;
  /// Moves the keyframes from `first` on rigidly.
  void move(const Transform2<Map, Map>& by, std::size_t first = 0);
  /// Becomes `other`, a copy made when this memory had `known` keyframes and changed since, and what this one
  /// has remembered since then behind it; `other` is of no use afterwards. Returns what moves this memory's
  /// newest surroundings there.
  Transform2<Map, Map> take_in(Memory& other, std::size_t known);
  /// Room for what the next seconds add, so that add() need not ask the heap for it.
  void make_room();

 private:
  void forget_across(std::size_t first);
  [[nodiscard]] std::size_t window_begin(std::size_t newest) const;
  [[nodiscard]] std::shared_ptr<const SurfaceScan> kept(const SurfaceScan& scan);

  MemoryOptions options_;
  std::vector<Keyframe> keyframes_;
  std::vector<Transform2<Map, Base>> poses_;
  std::vector<RelativeFactor> factors_;
  int loops_ = 0;
  bool broken_ = false;          ///< since the newest keyframe
  std::size_t looked_back_ = 0;  ///< keyframes for which loops were sought
  double last_loop_path_m_ = 0.0;
  double extra_open_m_ = 0.0;
  mutable MatchRoom room_;
};

/// A memory and the one of before it, both where the place was sure. A copy is cheap.
struct RememberedParts {
  Memory now;
  std::shared_ptr<const Memory> earlier;  ///< null: none

  /// As one, thinned to what the building holds. Takes milliseconds.
  [[nodiscard]] Memory together() const;
};

}  // namespace madori::localization
