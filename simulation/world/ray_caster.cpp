#include "simulation/world/ray_caster.hpp"

#include <embree3/rtcore.h>

#include <cmath>
#include <cstring>

#include "core/result.hpp"

namespace madori::simulation {
namespace {

constexpr std::size_t kLanes = RayPacket::kLanes;
constexpr int kMostPanes = 6;          ///< looked through before a beam counts as lost
constexpr float kBehindPaneM = 1e-3F;  ///< where the beam goes on behind a pane

}  // namespace

struct RayCaster::State {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<Material> materials;
  bool has_glass = false;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const Mesh& mesh) : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.materials = mesh.materials;
  for (const Material m : s.materials) s.has_glass = s.has_glass || m == Material::Glass;
  s.device = rtcNewDevice("threads=1,set_affinity=0");
  if (s.device == nullptr) throw Error("Embree", "cannot be started", "check that libembree3 is installed");
  s.scene = rtcNewScene(s.device);
  rtcSetSceneFlags(s.scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(s.scene, RTC_BUILD_QUALITY_HIGH);
  if (!mesh.triangles.empty()) {
    RTCGeometry geometry = rtcNewGeometry(s.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                             sizeof(Vertex), mesh.vertices.size());
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                            sizeof(Triangle), mesh.triangles.size());
    std::memcpy(vertices, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vertex));
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(s.scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(s.scene);
}

RayCaster::~RayCaster() = default;

std::size_t RayCaster::triangles() const {
  return state_->materials.size();
}

void RayCaster::cast(const RayPacket& rays, std::span<Hit, RayPacket::kLanes> hits) const {
  alignas(32) std::array<int, kLanes> valid;
  valid.fill(-1);
  alignas(32) RTCRayHit8 packet;
  std::memcpy(packet.ray.org_x, rays.x_m.data(), sizeof rays.x_m);
  std::memcpy(packet.ray.org_y, rays.y_m.data(), sizeof rays.y_m);
  std::memcpy(packet.ray.org_z, rays.z_m.data(), sizeof rays.z_m);
  std::memcpy(packet.ray.dir_x, rays.dx.data(), sizeof rays.dx);
  std::memcpy(packet.ray.dir_y, rays.dy.data(), sizeof rays.dy);
  std::memcpy(packet.ray.dir_z, rays.dz.data(), sizeof rays.dz);
  for (std::size_t i = 0; i < kLanes; ++i) {
    packet.ray.tnear[i] = 0.0F;
    packet.ray.time[i] = 0.0F;
    packet.ray.mask[i] = ~0U;
    packet.ray.flags[i] = 0;
    packet.ray.id[i] = 0;
    hits[i] = Hit{};
  }
  bool again = true;
  for (int pane = 0; again && pane < kMostPanes; ++pane) {
    for (std::size_t i = 0; i < kLanes; ++i) {
      packet.ray.tfar[i] = Hit::kNothing;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid.data(), state_->scene, &context, &packet);
    again = false;
    for (std::size_t i = 0; i < kLanes; ++i) {
      if (valid[i] == 0) continue;
      valid[i] = 0;
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      const float nx = packet.hit.Ng_x[i], ny = packet.hit.Ng_y[i], nz = packet.hit.Ng_z[i];
      const float along = nx * rays.dx[i] + ny * rays.dy[i] + nz * rays.dz[i];
      const float cosine = std::abs(along) / std::sqrt(nx * nx + ny * ny + nz * nz);
      const Material material = state_->materials[packet.hit.primID[i]];
      if (material != Material::Glass) {
        hits[i].range_m = packet.ray.tfar[i];
        hits[i].incidence_cos = cosine;
        hits[i].material = material;
        continue;
      }
      if (hits[i].glass_m == Hit::kNothing) {
        hits[i].glass_m = packet.ray.tfar[i];
        hits[i].glass_cos = cosine;
      }
      packet.ray.tnear[i] = packet.ray.tfar[i] + kBehindPaneM;
      valid[i] = -1;
      again = true;
    }
  }
}

}  // namespace madori::simulation
