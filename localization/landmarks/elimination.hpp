#pragma once

#include "localization/landmarks/bare_math.hpp"
#include "localization/landmarks/landmark_graph.hpp"

namespace madori::localization::landmarks {

/// A landmark seen from the origin, solved; unknown where nothing ties it to the origin.
struct SolvedLandmark {
  Displacement pose;
  FullUncertainty uncertainty = FullUncertainty::unknown();
};

namespace elimination {

/// A measured edge around the present poses, in twists of the origin's axes (a small turn about the origin,
/// then a shift): there an edge constrains the difference of its ends' twists alone, so that edges in series
/// and in parallel combine like resistors, with matrices for conductances.
struct Linearised {
  Matrix3 weight;
  Vector3 pull;  ///< weight times the twist difference that would satisfy the edge
  double cost;   ///< of the present poses: squared sigmas
};

inline Linearised linearised(const FullPose& edge, const Displacement& from, const Displacement& to) {
  double s = 0.0, c = 1.0;
  sine_cosine(from.yaw_rad, s, c);
  const double dx = to.x_m - from.x_m, dy = to.y_m - from.y_m;
  const Vector3 error{{c * dx + s * dy - edge.motion.x_m, c * dy - s * dx - edge.motion.y_m,
                       wrapped(to.yaw_rad - from.yaw_rad - edge.motion.yaw_rad)}};
  // By the difference of the twists: R_from' (shift + turn x the end's place).
  const Matrix3 jacobian{
      {{c, s, s * to.x_m - c * to.y_m}, {-s, c, c * to.x_m + s * to.y_m}, {0.0, 0.0, 1.0}}};
  const Matrix3 information = inverse(edge.uncertainty.covariance);
  const Matrix3 weighted = transposed(jacobian) * information;
  return {symmetric(weighted * jacobian), -1.0 * (weighted * error), dot(error, information * error)};
}

/// Gaussian elimination written as star-mesh on a graph of matrix conductances. After a star of more than two
/// arms the new conductances W_ij = W_ik S^-1 W_kj are not symmetric, so no edge with a covariance of its own
/// stands for one of them: that is why delta-star does not exist with full covariances, and this does.
template <int kCapacity>
class Mesh {
 public:
  /// The nodes `tied` to the origin by a chain of edges, at `poses`.
  Mesh(const LandmarkGraph<FullUncertainty, kCapacity>& graph, const SolvedLandmark* poses, NodeSet tied,
       int origin)
      : origin_(origin) {
    for (NodeSet rows = tied; !rows.empty();) {
      const int row = rows.take_first();
      for (NodeSet columns = graph.neighbours(row); !columns.empty();) {
        const int column = columns.take_first();
        if (column >= row) break;
        const Linearised e = linearised(graph.edge(column, row), poses[column].pose, poses[row].pose);
        block_[pair(row, column)] = e.weight;
        pull_[row] = pull_[row] + e.pull;
        pull_[column] = pull_[column] - e.pull;
        cost_ += e.cost;
        neighbours_[row].add(column), neighbours_[column].add(row);
      }
    }
    tied.remove(origin_);
    eliminate(tied);
  }

  [[nodiscard]] double cost() const { return cost_; }

  /// The twist of every node that brings the cost down to its least, to first order.
  void solve(Vector3* twists) const {
    twists[origin_] = {};
    for (int k = eliminated_ - 1; k >= 0; --k) {
      const int node = order_[k];
      twists[node] = pull_[node];
      for (NodeSet rest = neighbours_[node]; !rest.empty();) {
        const int other = rest.take_first();
        twists[node] = twists[node] + get(node, other) * twists[other];
      }
    }
  }

  /// Turns the mesh into the covariances of the twists: afterwards `covariance(node)` holds.
  void invert() {
    inner_[origin_] = {};
    for (int k = eliminated_ - 1; k >= 0; --k) {
      const int node = order_[k];
      Matrix3 gains[kCapacity];
      for (NodeSet rest = neighbours_[node]; !rest.empty();) {
        const int other = rest.take_first();
        gains[other] = get(node, other);
      }
      for (NodeSet columns = neighbours_[node]; !columns.empty();) {
        const int column = columns.take_first();
        Matrix3 cross;
        for (NodeSet rest = neighbours_[node]; !rest.empty();) {
          const int other = rest.take_first();
          if (other == origin_ || column == origin_) continue;  // the origin does not move
          cross = cross + gains[other] * (other == column ? inner_[column] : get(other, column));
        }
        set(node, column, cross);
        inner_[node] = inner_[node] + cross * transposed(gains[column]);
      }
      inner_[node] = symmetric(inner_[node]);
    }
  }
  [[nodiscard]] const Matrix3& covariance(int node) const { return inner_[node]; }

 private:
  [[nodiscard]] static int pair(int a, int b) { return a > b ? a * (a - 1) / 2 + b : b * (b - 1) / 2 + a; }
  [[nodiscard]] Matrix3 get(int row, int column) const {
    const Matrix3& stored = block_[pair(row, column)];
    return row > column ? stored : transposed(stored);
  }
  void set(int row, int column, const Matrix3& value) {
    block_[pair(row, column)] = row > column ? value : transposed(value);
  }

  /// The node with the fewest neighbours.
  [[nodiscard]] int loosest(NodeSet nodes) const {
    int best = -1;
    int fewest = kCapacity;
    while (!nodes.empty()) {
      const int node = nodes.take_first();
      const int degree = neighbours_[node].size();
      if (degree < fewest) best = node, fewest = degree;
    }
    return best;
  }

  /// Star-mesh on every node but the origin, the one with the fewest neighbours first. A node that is out
  /// keeps its neighbours of that moment, with S^-1 W_kj in their blocks, S^-1 b_k in its pull, S^-1 in
  /// `inner_`.
  void eliminate(NodeSet alive) {
    while (!alive.empty()) {
      const int k = loosest(alive);
      alive.remove(k);
      order_[eliminated_++] = k;
      Matrix3 sum;
      for (NodeSet rest = neighbours_[k]; !rest.empty();) sum = sum + get(k, rest.take_first());
      inner_[k] = inverse(symmetric(sum));
      pull_[k] = inner_[k] * pull_[k];
      for (NodeSet rows = neighbours_[k]; !rows.empty();) {
        const int row = rows.take_first();
        const Matrix3 out = get(row, k);
        pull_[row] = pull_[row] + out * pull_[k];
        neighbours_[row].remove(k);
        const Matrix3 through = out * inner_[k];
        for (NodeSet columns = rows; !columns.empty();) {
          const int column = columns.take_first();
          const Matrix3 added = through * get(k, column);
          const bool there = neighbours_[row].has(column);
          set(row, column, there ? get(row, column) + added : added);
          neighbours_[row].add(column), neighbours_[column].add(row);
        }
      }
      for (NodeSet rest = neighbours_[k]; !rest.empty();) {
        const int other = rest.take_first();
        set(k, other, inner_[k] * get(k, other));
      }
    }
  }

  Matrix3 block_[kCapacity * (kCapacity - 1) / 2];  ///< only pairs that are neighbours hold anything
  Matrix3 inner_[kCapacity];
  Vector3 pull_[kCapacity];
  NodeSet neighbours_[kCapacity];
  int order_[kCapacity] = {};
  int eliminated_ = 0;
  int origin_;
  double cost_ = 0.0;
};

/// The nodes that a chain of edges ties to the origin; those without a pose yet get one along that chain.
template <int kCapacity>
NodeSet tied_to_origin(const LandmarkGraph<FullUncertainty, kCapacity>& graph, int count,
                       SolvedLandmark* poses, int origin) {
  const Displacement back = poses[origin].pose.inverse();
  for (int i = 0; i < count; ++i) poses[i].pose = back * poses[i].pose;
  NodeSet tied, front;
  tied.add(origin), front.add(origin);
  poses[origin] = {{}, {}};
  while (!front.empty()) {
    const int node = front.take_first();
    for (NodeSet rest = graph.neighbours(node); !rest.empty();) {
      const int next = rest.take_first();
      if (tied.has(next)) continue;
      if (poses[next].uncertainty.is_unknown())
        poses[next].pose = poses[node].pose * graph.edge(node, next).motion;
      tied.add(next), front.add(next);
    }
  }
  return tied;
}

inline Displacement moved(const Displacement& pose, const Vector3& twist, double share) {
  Displacement out{pose.x_m, pose.y_m, wrapped(pose.yaw_rad + share * twist[2])};
  turn(share * twist[2], out.x_m, out.y_m);
  out.x_m += share * twist[0];
  out.y_m += share * twist[1];
  return out;
}

}  // namespace elimination

/// All landmarks at once, seen from landmark `origin`: least squares over all edges with their full
/// covariances, by Gauss-Newton steps, each of which is one round of star-mesh with the stars remembered.
/// `landmarks[0 .. count-1]` hold the poses to start from (unknown ones are laid along the edges) and get the
/// answer with its covariance in the origin's axes. Returns the number of steps; nothing is allocated, about
/// sizeof(Mesh<kCapacity>) of stack is used.
template <int kCapacity>
int solve_landmarks(const LandmarkGraph<FullUncertainty, kCapacity>& graph, int count,
                    SolvedLandmark* landmarks, int origin = 0) {
  constexpr int kMostSteps = 50;
  constexpr double kConverged = 1e-9;  // metres and radians
  const NodeSet tied = elimination::tied_to_origin(graph, count, landmarks, origin);
  Displacement before[kCapacity];
  Vector3 twists[kCapacity];
  double cost = kInfinity;
  double share = 1.0;
  bool converged = false;
  for (int step = 1;; ++step) {
    elimination::Mesh<kCapacity> mesh(graph, landmarks, tied, origin);
    const bool better = mesh.cost() <= cost * (1.0 + 1e-9) + 1e-12;
    if (converged || step > kMostSteps) {
      mesh.invert();
      for (int i = 0; i < count; ++i) {
        const Displacement& p = landmarks[i].pose;
        const Matrix3 lever{{{1.0, 0.0, -p.y_m}, {0.0, 1.0, p.x_m}, {0.0, 0.0, 1.0}}};
        landmarks[i].uncertainty = tied.has(i)
                                       ? FullUncertainty{symmetric(carried(lever, mesh.covariance(i)))}
                                       : FullUncertainty::unknown();
      }
      return step;
    }
    if (better) {
      cost = mesh.cost();
      share = 1.0;
      mesh.solve(twists);
      for (int i = 0; i < count; ++i) before[i] = landmarks[i].pose;
    } else {
      share *= 0.5;  // too far for a straight line: half the way
    }
    double largest = 0.0;
    for (NodeSet rest = tied; !rest.empty();) {
      const int i = rest.take_first();
      landmarks[i].pose = elimination::moved(before[i], twists[i], share);
      for (int k = 0; k < 3; ++k) {
        const double size = twists[i][k] < 0.0 ? -twists[i][k] : twists[i][k];
        largest = size > largest ? size : largest;
      }
    }
    converged = largest * share < kConverged;
  }
}

}  // namespace madori::localization::landmarks
