#pragma once

#include <optional>

#include "localization/registration/point_icp.hpp"
#include "localization/registration/point_map.hpp"
#include "localization/registration/rdnm.hpp"
#include "localization/registration/registration_result.hpp"
#include "localization/scan_points.hpp"

namespace madori::localization {

/// What a scan says of a pose beyond how near its points lie to the map's.
struct LikelihoodOptions {
  Point2<Base> sensor;      ///< where the lidar sits: its beams begin there
  double sigma_m = 0.06;    ///< of a point from the nearest of the map
  double other = 0.1;       ///< of a point that lies on nothing that is in the map, or passes it by
  double margin_m = 0.3;    ///< a beam that ends so much farther has passed a point by
  double view_m = 20.0;     ///< points farther than this are not asked
  double turn_share = 2.0;  ///< of a full turn beside the lidar's field of view: beams a direction
};

/// The localization strategies of Kis, Csemesz, Csáji (2021). Their map is a PointMap, whatever it was made
/// of: sampled walls of a drawing, the points of a growing map, the surfaces of keyframes.
struct StrategyOptions {
  double most_e_psr_m = 0.10;  ///< e_max: a registration of a larger error has failed
  double least_near = 0.6;     ///< share of the scan that must lie within 1 m of the map (own addition:
                               ///< e_psr of few near points is small anywhere)
  double most_e_psr_expected_m =
      0.3;  ///< e_max around a pose that is expected; a scan laid anywhere comes to 0.4 m
  double least_near_expected =
      0.3;  ///< the same around a pose that is expected: the rest looks around a corner
  double candidate_radius_m = 0.3;  ///< of the six local candidates around the assumed position
  double most_turn_rad = kPi / 4.0;
  double grid_m = 0.5;  ///< g of the global candidates
  double clearance_m =
      0.25;  ///< from every point of the map: where the vehicle would not fit is no candidate
  std::size_t refined = 300;  ///< candidates of Algorithm 2 that ICP looks at (the paper: the best alone),
  int rough_iterations = 8;   ///< first with so many steps,
  std::size_t rough_points = 90;     ///< and about so many points of the scan;
  std::size_t refined_exactly = 20;  ///< then the best of them to the end;
  std::size_t most_refined =
      3000;                      ///< the next so many where none of them explains the scan, up to this many:
  double enough_a_point = -0.3;  ///< nats of likelihood a point that do explain it
  double view_radius_m = 30.0;   ///< the map's points within it make the candidates' views,
  double global_view_m = 15.0;  ///< the same for the candidates of Algorithm 2, of which there are thousands,
  double view_spacing_m = 0.15;  ///< thinned to this: a section averages over half a metre anyway
  RdnOptions rdn;
  /// How Algorithm 2 ranks: in a building one open door is metres of difference, and the published norm
  /// squares it.
  RdnNorm global_norm = RdnNorm::CappedMean;
  PointIcpOptions icp;
  LikelihoodOptions likelihood;
};

/// The same where the points of the scan and of the map scatter about their surfaces by `noise_m` (sigma).
[[nodiscard]] StrategyOptions with_noise(StrategyOptions options, double noise_m);

enum class Strategy { Rdnm, Cpd, Absolute };
[[nodiscard]] const char* to_string(Strategy strategy);

struct StrategyResult {
  RegistrationResult fit;
  Strategy strategy = Strategy::Rdnm;  ///< the one that succeeded
};

/// Positions on a grid over the map's box that are clear of its points.
[[nodiscard]] std::vector<Point2<Map>> global_candidates(const PointMap& map, double grid_m,
                                                         double clearance_m);

/// What RDN sees of a map from every candidate position: made once for all scans that are sought in it.
class GlobalViews {
 public:
  GlobalViews(const PointMap& map, const StrategyOptions& options);

  /// Algorithm 1 over all candidates, most like the scan first.
  [[nodiscard]] std::vector<RdnmResult> ranked(const ScanPoints& scan, const RdnOptions& options) const;
  [[nodiscard]] std::size_t size() const { return places_.size(); }

 private:
  std::vector<Point2<Map>> places_;
  std::vector<RdnDescriptor> views_;
};

/// Logarithm of the likelihood of a scan at a pose: where its points lie beside the map's, and which of these
/// its beams pass by. A scan that looks through walls is wrong, however well its points fit.
[[nodiscard]] double log_likelihood(const ScanPoints& scan, const PointMap& map,
                                    const Transform2<Map, Base>& pose, const LikelihoodOptions& options = {});

/// Share of the directions in which the scan and the map say something of each other at a pose, in which they
/// contradict: beams that pass points of the map by, beside those that end at some.
[[nodiscard]] double contradiction(const ScanPoints& scan, const PointMap& map,
                                   const Transform2<Map, Base>& pose, const LikelihoodOptions& options = {});

/// Algorithm 2: RDNM over the whole map's grid, then ICP; nothing when e_psr stays above the limit.
[[nodiscard]] std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const PointMap& map,
                                                                const GlobalViews& views,
                                                                const StrategyOptions& options = {});
[[nodiscard]] std::optional<StrategyResult> localize_absolutely(const ScanPoints& scan, const PointMap& map,
                                                                const StrategyOptions& options = {});

/// The first two parts of Algorithm 3 (the third is Algorithm 2, whose ICP leans on nothing): RDNM around the
/// assumed pose and ICP; failing that CPD and ICP.
[[nodiscard]] std::optional<StrategyResult> localize_around(const ScanPoints& scan, const PointMap& map,
                                                            const Transform2<Map, Base>& assumed,
                                                            const StrategyOptions& options = {});

}  // namespace madori::localization
