#pragma once

#include <string>
#include <vector>

#include "localization/global/place_index.hpp"
#include "localization/particle_filter/likelihood_field.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/registration/segment_grid.hpp"
#include "localization/registration/segment_icp.hpp"
#include "mapping/wall_map/distance_field.hpp"

namespace madori::localization {

struct GlobalOptions {
  std::size_t candidates = 1000;   ///< views most like the scan's that are looked at closer
  std::size_t refined = 60;        ///< of these, as many are registered
  double certain = 0.9999;         ///< probability from which on the best is an answer
  double well_explained = 0.6;     ///< a best that puts less of the scan on walls must also ...
  double clear_nats = 25.0;        ///< ... lead by this log-likelihood: chance fits lead by up to 20
  double least_explained = 0.35;   ///< share of the scan's weight that an answer puts on walls
  double doubtful_through = 0.12;  ///< share of beams through drawn walls, above which a best must both ...
                                   ///< ... explain well and lead clearly
  double most_through = 0.25;      ///< share of the beams that an answer may lead through drawn walls
  double through_wall_nats = 3.0;  ///< against a pose, for each effective beam through a wall
  double same_m = 0.4;             ///< poses nearer than both are one hypothesis
  double same_rad = 0.15;
  SegmentIcpOptions icp = [] {
    SegmentIcpOptions near;  // candidates are near: a wide start would only draw them to the wall beside
    near.first_scale_m = 0.5;
    near.coarse_points = 180;
    return near;
  }();
};

/// A place where the vehicle may be.
struct Hypothesis {
  RegistrationResult fit;
  double log_likelihood = 0.0;  ///< over clutter, tempered to the effective beams
  double through_walls = 0.0;   ///< share of the beams
  double probability = 0.0;     ///< among the hypotheses
};

enum class GlobalState { Found, Ambiguous, Nowhere };
[[nodiscard]] const char* to_string(GlobalState state);

/// The answer to "where am I?" without history: the hypotheses, likeliest first, and whether the first is to
/// be believed.
struct GlobalAnswer {
  GlobalState state = GlobalState::Nowhere;
  std::string reason;  ///< in an operator's words; empty when found
  std::vector<Hypothesis> hypotheses;
};

/// The noise of the points themselves: how far each lies off the middle of its neighbours in the scan's
/// order, robustly; 0 when too few points have near neighbours to tell.
[[nodiscard]] double scan_noise_m(const ScanPoints& points);

/// Kidnapped robot: Algorithm 2 of Kis, Csemesz, Csáji (2021), and further. All places and turns are compared
/// by their precomputed views at once; the likeliest are weighed by the likelihood field, registered, and
/// judged by the whole scan: points on walls speak for a pose, beams through walls against it. How close is
/// close follows the scan's own noise.
class GlobalLocalizer {
 public:
  /// Prepares the tables of `walls` (seconds for a large site); `index` is taken when it was saved for them.
  explicit GlobalLocalizer(const mapping::Walls& walls, const GlobalOptions& options = {},
                           std::optional<PlaceIndex> index = std::nullopt,
                           const BeamModel& model = {.hit_sigma_m = 0.04});

  /// From one scan alone.
  [[nodiscard]] GlobalAnswer locate(const ScanPoints& points) const;
  /// Carries `before` along by the odometry since and judges it by one more scan, beside fresh candidates.
  /// What one scan leaves ambiguous, a few resolve.
  [[nodiscard]] GlobalAnswer locate(const ScanPoints& points, const GlobalAnswer& before,
                                    const Transform2<Base, Base>& moved) const;
  /// Registers and judges given poses only.
  [[nodiscard]] GlobalAnswer judge(const ScanPoints& points,
                                   const std::vector<Transform2<Map, Base>>& poses) const;

  /// By how many nats the best of the poses within 2 m and 12 degrees explains the points better, coarsely:
  /// near zero where the pose is right (0.2 ms).
  [[nodiscard]] double lead_of_nearby(const ScanPoints& points,
                                      const Transform2<Map, Base>& map_from_base) const;

  [[nodiscard]] const PlaceIndex& index() const { return index_; }
  [[nodiscard]] const SegmentGrid& grid() const { return grid_; }
  [[nodiscard]] const LikelihoodField& field() const { return fine_; }
  [[nodiscard]] const mapping::DistanceField& distance_field() const { return distance_; }

 private:
  [[nodiscard]] std::vector<Transform2<Map, Base>> candidates(const ScanPoints& points) const;
  [[nodiscard]] std::vector<Hypothesis> refine(const ScanPoints& points,
                                               const std::vector<Transform2<Map, Base>>& poses) const;
  [[nodiscard]] std::vector<Hypothesis> registered(const ScanPoints& points, double noise_m,
                                                   const std::vector<Transform2<Map, Base>>& poses,
                                                   SegmentIcpOptions icp) const;
  void weigh(const ScanPoints& points, double noise_m, std::vector<Hypothesis>& hypotheses) const;
  [[nodiscard]] GlobalAnswer answer(std::vector<Hypothesis> hypotheses) const;

  GlobalOptions options_;
  mapping::DistanceField distance_;
  SegmentGrid grid_;
  LikelihoodField coarse_;
  LikelihoodField fine_;
  PlaceIndex index_;
};

}  // namespace madori::localization
