#pragma once

#include "localization/landmarks/bare_math.hpp"
#include "localization/landmarks/landmark_graph.hpp"

namespace madori::localization::landmarks {

/// The arms of a star that stands for a triangle: the star's middle seen from each corner.
struct StarArms {
  ScalarPose from_a, from_b, from_c;
};

/// Delta-star, corrected. The loop is closed first, the error shared out by variance (the printed (11) to
/// (13) share it in thirds, and their orientations contradict each other); each arm's variance is the product
/// of its two sides over the sum of all three (the printed (14) to (16) have no unit of length). `ab` is B
/// seen from A.
[[nodiscard]] StarArms star_of_delta(const ScalarPose& ab, const ScalarPose& bc, const ScalarPose& ac);

namespace reduction {

/// Takes node `k` out; every two of its neighbours are tied instead, with w_ij = w_i w_j / (w_1 + ... + w_n):
/// one neighbour is the dead end, two the series rule, three the inverse of delta-star.
template <int kCapacity>
void star_to_mesh(LandmarkGraph<ScalarUncertainty, kCapacity>& graph, int k) {
  double position_weight = 0.0, yaw_weight = 0.0;
  ScalarPose arms[kCapacity];
  int ends[kCapacity];
  int count = 0;
  for (NodeSet rest = graph.neighbours(k); !rest.empty(); ++count) {
    ends[count] = rest.take_first();
    arms[count] = graph.edge(k, ends[count]);
    position_weight += 1.0 / arms[count].uncertainty.position_m2;
    yaw_weight += 1.0 / arms[count].uncertainty.yaw_rad2;
  }
  graph.remove_node(k);
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j) {
      const ScalarUncertainty& u = arms[i].uncertainty;
      const ScalarUncertainty& v = arms[j].uncertainty;
      graph.fuse(ends[i], ends[j],
                 {(negated(arms[i]).motion * arms[j].motion),
                  {u.position_m2 * v.position_m2 * position_weight, u.yaw_rad2 * v.yaw_rad2 * yaw_weight}});
    }
}

/// A corner with three neighbours, two of which are tied: after delta-star it has two and goes by the series
/// rule, so that every conversion takes an edge away and the procedure ends.
template <int kCapacity>
bool delta_to_star(LandmarkGraph<ScalarUncertainty, kCapacity>& graph, int corner, int middle) {
  NodeSet rest = graph.neighbours(corner);
  if (rest.size() != 3) return false;
  const int n[3] = {rest.take_first(), rest.take_first(), rest.take_first()};
  for (int skipped = 0; skipped < 3; ++skipped) {
    const int b = n[(skipped + 1) % 3];
    const int c = n[(skipped + 2) % 3];
    if (!graph.connected(b, c)) continue;
    const StarArms star = star_of_delta(graph.edge(corner, b), graph.edge(b, c), graph.edge(corner, c));
    graph.remove_edge(corner, b), graph.remove_edge(b, c), graph.remove_edge(corner, c);
    graph.fuse(corner, middle, star.from_a);
    graph.fuse(b, middle, star.from_b);
    graph.fuse(c, middle, star.from_c);
    star_to_mesh(graph, corner);
    return true;
  }
  return false;
}

/// The first node of `alive` with at most `degree` neighbours; -1 where there is none.
template <int kCapacity>
int node_of_degree(const LandmarkGraph<ScalarUncertainty, kCapacity>& graph, NodeSet alive, int degree) {
  while (!alive.empty()) {
    const int node = alive.take_first();
    if (graph.neighbours(node).size() <= degree) return node;
  }
  return -1;
}

}  // namespace reduction

/// LmPosUpdate as published, corrected so that it always ends: dead ends, series and parallel edges; then a
/// delta-star; where there is none, the node with the fewest neighbours by star-mesh; until only `origin` and
/// `target` are left. Nodes 0 .. count-1 of `graph`, which must have a free place behind them. Returns the
/// target seen from the origin, unknown where nothing ties them.
template <int kCapacity>
[[nodiscard]] ScalarPose landmark_position(LandmarkGraph<ScalarUncertainty, kCapacity> graph, int count,
                                           int origin, int target) {
  NodeSet alive;
  for (int node = 0; node < count; ++node)
    if (node != origin && node != target) alive.add(node);
  int free = count;
  const auto convert = [&] {
    for (NodeSet corners = alive; !corners.empty();) {
      const int corner = corners.take_first();
      if (!reduction::delta_to_star(graph, corner, free)) continue;
      alive.add(free);
      alive.remove(corner);
      free = corner;
      return true;
    }
    return false;
  };
  while (!alive.empty()) {
    int node = reduction::node_of_degree(graph, alive, 2);
    if (node < 0 && convert()) continue;
    for (int degree = 3; node < 0; ++degree) node = reduction::node_of_degree(graph, alive, degree);
    reduction::star_to_mesh(graph, node);
    alive.remove(node);
  }
  return graph.edge(origin, target);
}

}  // namespace madori::localization::landmarks
