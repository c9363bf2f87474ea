#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "localization/memory/memory.hpp"
#include "localization/memory/sights.hpp"

namespace madori::localization {

/// Sizes of a stretch of keyframes, and when two of them show the same place.
struct StretchOptions {
  double half_path_m = 4.0;         ///< of driving to each side of the middle keyframe,
  std::size_t half_keyframes = 6;   ///< at most so many keyframes of it,
  std::size_t least_keyframes = 1;  ///< and at least so many, however far apart
  double spacing_m = 0.12;          ///< of the points that are searched with
  double map_radius_m = 20.0;
  double search_m = 1.5;  ///< around the guess
  double search_rad = 0.15;
  std::size_t witnesses = 5;          ///< keyframes of either stretch whose sights are compared
  int least_seen = 150;               ///< points that both must have had in view
  double most_through = 0.2;          ///< share of these that may contradict
  double least_inliers = 0.35;        ///< of the points, those that lie on the other's surfaces
  double least_information = 2000.0;  ///< in the direction that is seen worst, 1/m² (a radian counts as a
                                      ///< metre): a corridor's walls hold a scan across it, and not along it
};

/// The keyframes around `middle`, inclusive. They are of one drive: no cut between them.
struct Stretch {
  std::size_t first = 0;
  std::size_t middle = 0;
  std::size_t last = 0;
};
[[nodiscard]] Stretch stretch_around(const std::vector<Keyframe>& keyframes, std::size_t middle,
                                     const StretchOptions& options = {});

/// All that a stretch saw as one scan, axes of its middle keyframe.
[[nodiscard]] SurfaceScan stretch_scan(const Memory& memory, const Stretch& stretch, double spacing_m);

/// What the keyframes of two stretches say of each other with `to`'s middle seen from `from`'s at `motion`.
[[nodiscard]] SightCount stretch_sights(const Memory& memory, const Stretch& from, const Stretch& to,
                                        const Transform2<Base, Base>& motion, std::size_t witnesses);

/// Whether the stretches around the ends of a loop contradict each other no more than two of one place do.
[[nodiscard]] bool is_seen_alike(const Memory& memory, const RelativeFactor& loop,
                                 const StretchOptions& options = {});

struct StretchMatch {
  RelativeFactor factor;  ///< from the middle of the one to the middle of the other
  SightCount sights;
};

/// Lays one stretch on another where the wheels led from the middle of `from` to the middle of `to`
/// (`wheels` and its covariance: x, y, yaw, axes of `from`'s middle): where they contradict each other least
/// and the wheels little, sought from there and from `laid`, and from that place by what they have in common,
/// however little that is. The factor's information is that of both.
[[nodiscard]] StretchMatch lean_stretches(const Memory& memory, const Stretch& from, const Stretch& to,
                                          const Transform2<Base, Base>& wheels,
                                          const Eigen::Matrix3d& covariance,
                                          const Transform2<Base, Base>& laid,
                                          const StretchOptions& options = {});

/// Lays one stretch on another, `guess` being the middle of `to` seen from the middle of `from`. Nothing
/// where they do not fit, or where what the one saw stands in what the other looked through.
[[nodiscard]] std::optional<StretchMatch> match_stretches(const Memory& memory, const Stretch& from,
                                                          const Stretch& to,
                                                          const Transform2<Base, Base>& guess,
                                                          const StretchOptions& options = {});

}  // namespace madori::localization
