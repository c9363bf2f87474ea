#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include "simulation/world/mesh.hpp"

namespace madori::simulation {

/// Eight rays, Building frame; directions of unit length. Lanes with mask 0 are left out.
struct RayPacket {
  static constexpr std::size_t kLanes = 8;
  std::array<float, kLanes> x_m{}, y_m{}, z_m{};
  std::array<float, kLanes> dx{}, dy{}, dz{};
};

/// What a beam meets: the first opaque surface, and the first pane of glass before it.
struct Hit {
  static constexpr float kNothing = std::numeric_limits<float>::infinity();
  float range_m = kNothing;
  float incidence_cos = 1.0F;  ///< of the opaque surface
  Material material = Material::Wall;
  float glass_m = kNothing;
  float glass_cos = 0.0F;  ///< 1 = square on the pane
};

/// Casts rays against a mesh with Embree. Not thread-safe beyond concurrent cast() calls. The tree is built
/// by one thread, so that the same mesh gives the same tree and the same bits.
class RayCaster {
 public:
  /// Throws Error when Embree cannot be started.
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  void cast(const RayPacket& rays, std::span<Hit, RayPacket::kLanes> hits) const;
  [[nodiscard]] std::size_t triangles() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace madori::simulation
