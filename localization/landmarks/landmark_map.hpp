#pragma once

#include "localization/landmarks/descriptor_match.hpp"
#include "localization/landmarks/elimination.hpp"

namespace madori::localization::landmarks {

/// All that is kept of the building: the descriptors, the measured edges, where the landmarks lie. Landmark 0
/// is the origin. One block of fixed size.
template <int kCapacity>
class LandmarkMap {
 public:
  using Graph = LandmarkGraph<FullUncertainty, kCapacity>;

  [[nodiscard]] int size() const { return size_; }
  [[nodiscard]] bool full() const { return size_ == kCapacity; }
  [[nodiscard]] const Descriptor& descriptor(int landmark) const { return descriptors_[landmark]; }
  [[nodiscard]] const SolvedLandmark& landmark(int i) const { return landmarks_[i]; }
  [[nodiscard]] const Graph& graph() const { return graph_; }

  /// The number of the new landmark; the map must not be full. It lies nowhere until an edge ties it.
  int add(const Descriptor& descriptor) {
    descriptors_[size_] = descriptor;
    return size_++;
  }
  /// Landmark `to` seen from landmark `from`, measured; all landmarks are solved anew. Returns the steps.
  int measure(int from, int to, const FullPose& edge) {
    graph_.fuse(from, to, edge);
    return solve_landmarks(graph_, size_, landmarks_);
  }

 private:
  int size_ = 0;
  Descriptor descriptors_[kCapacity];
  Graph graph_;
  SolvedLandmark landmarks_[kCapacity];
};

/// The map and the larger of the two working sets beside it on the stack.
template <int kCapacity>
inline constexpr auto kLandmarkBytes = [] {
  constexpr auto kSolving = sizeof(elimination::Mesh<kCapacity>) +
                            kCapacity * (sizeof(Displacement) + sizeof(Vector3) + sizeof(Matrix3));
  constexpr auto kMatching =
      sizeof(DescriptorField) + 2 * sizeof(DescriptorPoints) + Descriptor::kMost * (4 + 2);
  return sizeof(LandmarkMap<kCapacity>) + (kSolving > kMatching ? kSolving : kMatching);
}();
static_assert(kLandmarkBytes<20> <= 64 * 1024,
              "20 landmarks and what is needed to match and solve them: 64 KiB");

}  // namespace madori::localization::landmarks
