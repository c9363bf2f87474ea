#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "localization/memory/memory.hpp"
#include "localization/slam/graph_spread.hpp"
#include "localization/slam/place_views.hpp"
#include "localization/slam/stretch.hpp"

namespace madori::localization {

/// Lengths of driving unless said otherwise.
struct LoopFinderOptions {
  StretchOptions stretch;
  double every_m = 0.6;          ///< a place is sought after so much driving
  double young_m = 15.0;         ///< no loop is sought with what was driven so shortly before
  double sure_m = 1.0;           ///< three sigmas: surer than this, the search around the estimate is enough
  double most_unlike = 0.45;     ///< of two views of one place
  double apart_m = 2.5;          ///< candidates of one search are this far apart
  std::size_t tried = 4;         ///< candidates laid on each other a search,
  std::size_t tried_apart = 10;  ///< and where a piece is tied to nothing yet
  double joint_m = 1.5;          ///< around the wheels' word where a drive was cut
  double joint_rad = 0.5;
  std::size_t together = 3;        ///< loops that must lead to the same place, and what must have been driven
  double span_m = 1.0;             ///< from the first to the last of them;
  double span_apart_m = 4.0;       ///< between pieces, of which the graph knows nothing, on either side,
  double surer = 3.0;              ///< between pieces this many times the longest mistake, on either side,
  std::size_t surveys = 20;        ///< at once while driving,
  double around_m = 12.0;          ///< and all that they saw of each other so far around the loop,
  double near_m = 6.0;             ///< keyframes so near to each other,
  double most_through_all = 0.15;  ///< may contradict to this share
  double comparable_m = 20.0;      ///< loops with so much driving between them are compared
  double match_sigma_m = 0.15;     ///< of a loop against another, and its growth with that driving
  double match_sigma_rad = 0.02;
  double drift_m = 0.04;  ///< a root-metre
  double drift_rad = 0.008;
};

/// Finds places again by what they look like, over all that is remembered and however far the estimate has
/// drifted: views of stretches of keyframes are compared (RDNM), likely pairs laid on each other, weighed
/// against the graph's own covariance, and believed when several lead to the same place and none of as much
/// weight to another. Between pieces, of which the graph knows nothing, it says itself how far a building is
/// to be trusted: places that the graph knows to be others are laid on each other, too, and over how much
/// driving they pass for one (the longest mistake) is what a tie has to exceed.
class LoopFinder {
 public:
  explicit LoopFinder(const LoopFinderOptions& options = {}) : options_(options) {}

  /// Looks at the keyframes since the last time whose surroundings are complete; at the end of a drive at all
  /// of them. Returns the loops to be closed: each inner list leads from one piece to one.
  [[nodiscard]] std::vector<std::vector<RelativeFactor>> look(const Memory& memory, bool at_end);

  /// A drive was cut before `keyframe`, `motion` being what led there: the stretches on both sides will be
  /// laid on each other once, in a wide window, when they are complete. It may have been no more than a scan
  /// that was matched wrongly.
  void note_cut(std::size_t keyframe, const Transform2<Base, Base>& motion) {
    cuts_.emplace_back(keyframe, motion);
  }
  /// For every keyframe a number that it has in common with those to which it is surely tied: by the motions
  /// of a drive, and by ties that exceed also the mistakes that were found after them.
  [[nodiscard]] std::vector<std::size_t> surely_tied(const Memory& memory) const;
  [[nodiscard]] const LoopFinderOptions& options() const { return options_; }

 private:
  struct Candidate {
    std::size_t keyframe;
    double difference;
    Transform2<Base, Base> motion;  ///< of the place sought, seen from the keyframe
  };
  struct Laid {
    RelativeFactor factor;
    bool may_be;  ///< the same place, by the graph
  };
  /// Loops that lead to one place, and the driving from the first to the last of them on either side.
  struct Group {
    std::vector<RelativeFactor> loops;
    double here_m = 0.0;
    double there_m = 0.0;
    std::size_t against = 0;  ///< lead elsewhere
  };
  /// Drives were tied between these keyframes.
  struct Tie {
    std::size_t from = 0;
    std::size_t to = 0;
    double length_m = 0.0;
  };
  [[nodiscard]] bool is_complete(const Memory& memory, std::size_t k) const;
  [[nodiscard]] std::vector<Candidate> candidates(const Memory& memory, std::size_t newest) const;
  [[nodiscard]] std::vector<Candidate> apart(const Memory& memory, std::vector<Candidate> found,
                                             std::size_t count) const;
  [[nodiscard]] std::optional<Laid> lay(const Memory& memory, const GraphSpread& spread, const Candidate& c,
                                        const Stretch& here) const;
  void seek(const Memory& memory, std::size_t newest);
  void survey(const Memory& memory, std::size_t k);
  bool survey_for(const Memory& memory, double length_m);
  [[nodiscard]] double longest_mistake_m(const Memory& memory) const;
  [[nodiscard]] std::vector<std::vector<RelativeFactor>> mended_cuts(const Memory& memory);
  [[nodiscard]] bool fit_all_over(const Memory& memory, const std::vector<std::size_t>& pieces,
                                  const RelativeFactor& loop) const;
  [[nodiscard]] bool comparable(const Memory& memory, const RelativeFactor& a, const RelativeFactor& b) const;
  [[nodiscard]] bool agree(const Memory& memory, const RelativeFactor& a, const RelativeFactor& b) const;
  [[nodiscard]] Group group_of(const Memory& memory, const std::vector<std::size_t>& pieces,
                               const std::vector<RelativeFactor>& loops, const RelativeFactor& one) const;
  [[nodiscard]] std::vector<RelativeFactor> believed(const Memory& memory, const RelativeFactor& newest);
  [[nodiscard]] std::vector<std::vector<RelativeFactor>> taken(const Memory& memory, std::size_t from);

  LoopFinderOptions options_;
  std::vector<PlaceView> views_;        ///< one a keyframe, of those whose surroundings are complete
  std::vector<RelativeFactor> likely_;  ///< laid on each other, not yet believed
  std::vector<std::pair<std::size_t, Transform2<Base, Base>>> cuts_;  ///< not yet looked at
  double sought_path_m_ = -1e9;
  std::vector<std::size_t> sought_;
  std::vector<char> is_surveyed_;         ///< by the number in sought_
  std::size_t surveys_left_ = 0;          ///< of this look
  bool is_put_off_ = false;               ///< a tie, until more is surveyed
  std::vector<RelativeFactor> mistakes_;  ///< laid on each other, and known to be different places
  std::vector<Tie> ties_;
};

}  // namespace madori::localization
