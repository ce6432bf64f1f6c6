#include "paloc/tools/synth_raycaster.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <stdexcept>

namespace paloc::synth {
namespace {

constexpr std::size_t kPacket = 8;

void check(RTCDevice device, const char* what) {
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    throw std::runtime_error(std::string("Embree: cannot ") + what);
  }
}

}  // namespace

struct Raycaster::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<std::uint32_t> triangle_surface;

  ~Impl() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
  }
};

Raycaster::Raycaster(const SceneMesh& mesh) : impl_(std::make_unique<Impl>()) {
  // One thread builds, so that the tree, and with it the choice between surfaces that touch, is the
  // same in every run.
  impl_->device = rtcNewDevice("threads=1");
  if (!impl_->device) throw std::runtime_error("Embree: cannot create a device");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);  // no ray slips between two triangles
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  impl_->triangle_surface = mesh.triangle_surface;

  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Point3f*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                              sizeof(Point3f), mesh.vertices.size()));
  auto* triangles = static_cast<std::array<std::uint32_t, 3>*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                              sizeof(mesh.triangles[0]), mesh.triangles.size()));
  check(impl_->device, "hold the scene");
  std::copy(mesh.vertices.begin(), mesh.vertices.end(), vertices);
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(impl_->scene);
  check(impl_->device, "index the scene");
}

Raycaster::~Raycaster() = default;

void Raycaster::cast(const Vec3& origin_scene, std::span<const Eigen::Vector3f> directions_scene,
                     std::span<RayHit> hits) const {
  const Eigen::Vector3f origin = origin_scene.cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  alignas(32) RTCRayHit8 packet;
  alignas(32) int valid[kPacket];
  for (std::size_t first = 0; first < directions_scene.size(); first += kPacket) {
    const std::size_t count = std::min(kPacket, directions_scene.size() - first);
    for (std::size_t i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      const Eigen::Vector3f& direction = directions_scene[first + std::min(i, count - 1)];
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = direction.x();
      packet.ray.dir_y[i] = direction.y();
      packet.ray.dir_z[i] = direction.z();
      packet.ray.tnear[i] = 0;
      packet.ray.tfar[i] = std::numeric_limits<float>::infinity();
      packet.ray.time[i] = 0;
      packet.ray.mask[i] = 0xffffffffU;
      packet.ray.id[i] = 0;
      packet.ray.flags[i] = 0;
      packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    rtcIntersect8(valid, impl_->scene, &context, &packet);
    for (std::size_t i = 0; i < count; ++i) {
      RayHit& hit = hits[first + i];
      hit = RayHit{};
      if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
      hit.distance_m = packet.ray.tfar[i];
      hit.surface = impl_->triangle_surface[packet.hit.primID[i]];
      hit.normal_scene =
          Eigen::Vector3f(packet.hit.Ng_x[i], packet.hit.Ng_y[i], packet.hit.Ng_z[i]).normalized();
      if (hit.normal_scene.dot(directions_scene[first + i]) > 0) hit.normal_scene *= -1;
    }
  }
}

}  // namespace paloc::synth
