#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "localization/drawing_fit/drawing_fit.hpp"
#include "localization/placement/free_ways.hpp"
#include "localization/placement/votes.hpp"

namespace madori::localization {

inline constexpr double kNearM = 0.5;    ///< what an answer may be off by and still be right
inline constexpr double kAroundM = 1.0;  ///< ... and be right, but not exactly

/// What is known of the start without looking: the pose of the memory's first keyframe.
struct StartPrior {
  Transform2<Map, Base> map_from_base;
  double sigma_m = 0.5;
  double sigma_rad = 0.17;
  /// Where the vehicle believed to be, and how surely, when a person told it the pose above.
  struct Former {
    Transform2<Map, Base> map_from_base;
    double probability = 0.0;
  };
  std::optional<Former> former{};

  /// What the vehicle drove since it was told.
  void carry(const Transform2<Base, Base>& driven) {
    map_from_base = map_from_base * driven;
    if (former) former->map_from_base = former->map_from_base * driven;
  }

  /// Of (x, y, yaw), about the pose: 1/m^2 and 1/rad^2.
  [[nodiscard]] Eigen::Matrix3d information() const {
    const double m2 = sigma_m * sigma_m;
    return Eigen::Vector3d(1.0 / m2, 1.0 / m2, 1.0 / (sigma_rad * sigma_rad)).asDiagonal();
  }
};

/// Log of the prior's density (1/(m^2 rad)) where the first keyframe is, on a drawing of `area_m2`; a pose
/// that was given may be of another place altogether.
[[nodiscard]] double log_prior(const StartPrior& prior, const Transform2<Map, Base>& first, double area_m2);

/// Probability that the given pose is of this place and not of another altogether, the first keyframe being
/// where it is: what it says about the pose counts by so much.
[[nodiscard]] double prior_holds(const StartPrior& prior, const Transform2<Map, Base>& first, double area_m2);

/// One way in which the memory may lie on the drawing.
struct Placement {
  Transform2<Map, Map> correction;  ///< of the memory's poses
  double nats = 0.0;                ///< log likelihood and prior as if every wall spoke for itself
  double log_prior = 0.0;
  Votes votes{};
  double probability = 0.0;  ///< among all that are known
  double explained = 0.0;    ///< share of what is remembered that lies on drawn walls there
  double near = 1.0;         ///< of this probability, the share within 0.5 m and 10 degrees of it
  double around = 1.0;       ///< ... within 1 m and 20 degrees
  bool mirrored = false;     ///< of the memory's mirror image: the drawing would be mirrored
};

/// The belief where the memory lies on the drawing: hypotheses, each weighed by everything that is remembered
/// at once, so that what is seen again and again from one place counts once. Evidence for a place: surfaces
/// on drawn walls, two metres of a wall being one observation, under the error of the drawing that suits the
/// place best (drawings differ, and the likelihood is averaged over exact and rough ones). Evidence against
/// it: beams and ways through drawn walls. Deterministic.
class PlaceBelief {
 public:
  explicit PlaceBelief(const mapping::Walls& walls);

  /// Weighs the hypotheses known so far, the memory as it lies and the places that it would put the vehicle
  /// (`proposed`); with `everywhere` all places and turns of the drawing and its mirror image are looked at
  /// anew. `at` is the vehicle, in the memory's frame.
  void weigh(const DrawingFit& fit, const Memory& memory, const MemoryCloud& cloud,
             const std::optional<StartPrior>& prior, const Transform2<Map, Base>& at, bool everywhere,
             const std::vector<Transform2<Map, Base>>& proposed = {});
  /// The memory was moved: what leads to a place from there.
  void moved(const Transform2<Map, Map>& by);
  /// Nothing is known of the place any more; whether the drawing is mirrored is not forgotten.
  void forget();

  /// An earlier drive lay on this drawing, and surely: it is not mirrored.
  void exclude_mirror();

  [[nodiscard]] double area_m2() const { return area_m2_; }
  /// Likeliest first.
  [[nodiscard]] const std::vector<Placement>& placements() const { return placements_; }
  /// The share of the belief within 0.5 m and 10 degrees of the memory as it lies, at the vehicle.
  [[nodiscard]] double probability_here(const Transform2<Map, Base>& at) const {
    return probability_near(at, at);
  }
  /// ... of `place`, where the memory puts the vehicle `at`.
  [[nodiscard]] double probability_near(const Transform2<Map, Base>& at,
                                        const Transform2<Map, Base>& place) const;
  /// ... within 1 m and 20 degrees of `place`, where the memory puts the vehicle `at`.
  [[nodiscard]] double probability_around(const Transform2<Map, Base>& at,
                                          const Transform2<Map, Base>& place) const;
  /// The middle of the belief within 1 m and 20 degrees of where the memory puts the vehicle; if `wide`, of
  /// twice as much around it, so that as much as possible is within 1 m and 20 degrees of the middle.
  [[nodiscard]] Transform2<Map, Base> middle_around(const Transform2<Map, Base>& at, bool wide) const;
  /// The likeliest that does not need a mirror; nothing before the first weigh().
  [[nodiscard]] std::optional<Placement> best() const;
  /// Of the likeliest place but where the memory lies.
  [[nodiscard]] double probability_elsewhere(const Transform2<Map, Base>& at) const;
  /// Of the mirror image, all places together.
  [[nodiscard]] double probability_mirrored() const;

 private:
  struct Seen;
  void judge(const DrawingFit& fit, const Seen& seen, const std::optional<StartPrior>& prior,
             Placement& placement) const;
  /// Of the placements that put the vehicle within m and rad of `place`, each by its share that is so near.
  [[nodiscard]] double probability_within(const Transform2<Map, Base>& at, const Transform2<Map, Base>& place,
                                          double m, double rad, double Placement::*share) const;
  /// Where the vehicle would be, and how likely that is.
  struct Way {
    Transform2<Map, Base> there;
    double probability;
  };
  /// Those within `scale` times 1 m and 20 degrees of `at`, where the memory puts it.
  [[nodiscard]] std::vector<Way> ways_around(const Transform2<Map, Base>& at, double scale) const;
  /// Of these; `at` where there are none.
  [[nodiscard]] Transform2<Map, Base> mean_around(const Transform2<Map, Base>& at, double scale) const;
  void share_out(std::vector<Placement> found, const Seen& seen, const Seen& mirrored);

  std::shared_ptr<const mapping::DistanceField> walls_;
  double area_m2_ = 1.0;  ///< of the drawing
  double log_mirrored_;   ///< prior of a mirrored drawing, by what places before said
  std::vector<Placement> placements_;
};

}  // namespace madori::localization
