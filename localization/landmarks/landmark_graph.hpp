#pragma once

#include <stdint.h>

#include "localization/landmarks/uncertain_pose.hpp"

namespace madori::localization::landmarks {

/// A set of nodes, one bit each.
class NodeSet {
 public:
  static constexpr int kMost = 64;

  void add(int node) { bits_ |= uint64_t{1} << node; }
  void remove(int node) { bits_ &= ~(uint64_t{1} << node); }
  [[nodiscard]] bool has(int node) const { return (bits_ >> node & 1U) != 0; }
  [[nodiscard]] bool empty() const { return bits_ == 0; }
  [[nodiscard]] int size() const { return __builtin_popcountll(bits_); }
  /// The smallest member; the set must not be empty.
  [[nodiscard]] int first() const { return __builtin_ctzll(bits_); }
  int take_first() {
    const int node = first();
    bits_ &= bits_ - 1;
    return node;
  }

 private:
  uint64_t bits_ = 0;
};

/// Landmarks and what was measured between them: lower-triangular pages of fixed size, one number a pair and
/// page (x, y, yaw and the uncertainty: five pages with the published scalars, nine with full covariances).
/// Entry (row, column), row > column, holds landmark `row` seen from landmark `column`. Nothing is allocated.
template <class Uncertainty, int kCapacity>
class LandmarkGraph {
  static_assert(kCapacity <= NodeSet::kMost);

 public:
  using Edge = UncertainPose<Uncertainty>;

  [[nodiscard]] const NodeSet& neighbours(int node) const { return neighbours_[node]; }
  [[nodiscard]] bool connected(int a, int b) const { return neighbours_[a].has(b); }

  /// Node `to` seen from node `from`, as measured; unknown where the pair has no edge.
  [[nodiscard]] Edge edge(int from, int to) const {
    if (!connected(from, to)) return {{}, Uncertainty::unknown()};
    const int place = pair(from, to);
    float u[Uncertainty::kPages];
    for (int page = 0; page < Uncertainty::kPages; ++page) u[page] = uncertainty_[page][place];
    const Edge stored{{motion_[0][place], motion_[1][place], motion_[2][place]}, Uncertainty::from_pages(u)};
    return from < to ? stored : negated(stored);
  }
  /// Another measurement of a pair: fused with what is there (the parallel rule).
  void fuse(int from, int to, const Edge& measured) {
    if (from > to) return fuse(to, from, negated(measured));
    store(from, to, fused(edge(from, to), measured));
  }
  void remove_edge(int a, int b) {
    neighbours_[a].remove(b);
    neighbours_[b].remove(a);
  }
  void remove_node(int node) {
    for (NodeSet rest = neighbours_[node]; !rest.empty();) remove_edge(node, rest.take_first());
  }

 private:
  [[nodiscard]] static int pair(int a, int b) { return a > b ? a * (a - 1) / 2 + b : b * (b - 1) / 2 + a; }
  void store(int from, int to, const Edge& edge) {
    const int place = pair(from, to);
    motion_[0][place] = edge.motion.x_m;
    motion_[1][place] = edge.motion.y_m;
    motion_[2][place] = edge.motion.yaw_rad;
    float u[Uncertainty::kPages];
    edge.uncertainty.to_pages(u);
    for (int page = 0; page < Uncertainty::kPages; ++page) uncertainty_[page][place] = u[page];
    neighbours_[from].add(to);
    neighbours_[to].add(from);
  }

  static constexpr int kPairs = kCapacity * (kCapacity - 1) / 2;
  double motion_[3][kPairs] = {};
  float uncertainty_[Uncertainty::kPages][kPairs] = {};
  NodeSet neighbours_[kCapacity];
};

}  // namespace madori::localization::landmarks
