#pragma once

#include <vector>

#include "localization/memory/pose_graph.hpp"

namespace madori::localization {

/// The factor read the other way round: pose `from` seen from pose `to`.
[[nodiscard]] RelativeFactor reversed(const RelativeFactor& factor);
/// The two motions one after the other, first order in their errors; `first.to` must be `second.from`.
[[nodiscard]] RelativeFactor chained(const RelativeFactor& first, const RelativeFactor& second);
/// Two measurements of the same motion as one; never more exact than a scan match can be.
[[nodiscard]] RelativeFactor merged(const RelativeFactor& a, const RelativeFactor& b);

/// Whether it is a loop that the solved `poses` show to be wrong.
[[nodiscard]] bool contradicts(const RelativeFactor& factor, const std::vector<Transform2<Map, Base>>& poses);

/// Takes one pose out of the graph: what tied it to others ties the neighbour that it was tied to best
/// instead, so the graph stays as sparse as it was. Loops that contradict the solved `poses` are forgotten.
/// The numbers of the other poses stay. Returns false, nothing changed, when no factor touches the pose.
bool take_out(int node, const std::vector<Transform2<Map, Base>>& poses,
              std::vector<RelativeFactor>& factors);

/// No scan match is better than this, however many points agree: 1 cm and 0.15 degrees, and the variances
/// `grown` on top.
[[nodiscard]] Eigen::Matrix3d limited(const Eigen::Matrix3d& information,
                                      const Eigen::Vector3d& grown = Eigen::Vector3d::Zero());

}  // namespace madori::localization
