#include "surfaces/mesh_bvh.h"

#include "core/error.h"
#include "surfaces/embree_device.h"

namespace mote {

MeshBvh::MeshBvh(Mesh mesh) : mesh_(std::move(mesh)), device_(embree_device())
{
    MOTE_ASSERT(!mesh_.triangles.empty());
    // Embree reads whole 16-byte lanes: past the last element, never past the storage.
    mesh_.positions.reserve(mesh_.positions.size() + 1);
    mesh_.triangles.reserve(mesh_.triangles.size() + 1);
    const RTCGeometry geometry = rtcNewGeometry(device_->get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               mesh_.positions.data(), 0, sizeof(Vec3), mesh_.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh_.triangles.data(), 0, sizeof(glm::uvec3),
                               mesh_.triangles.size());
    rtcCommitGeometry(geometry);
    scene_ = rtcNewScene(device_->get());
    // Watertight along shared edges; what has texture coordinates may be cut out (see cutout.h).
    rtcSetSceneFlags(scene_, mesh_.uvs.empty()
                                 ? RTC_SCENE_FLAG_ROBUST
                                 : RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    commit_alone(scene_);
    try {
        device_->check();
    } catch (...) {
        rtcReleaseScene(scene_);
        throw;
    }
}

MeshBvh::~MeshBvh()
{
    rtcReleaseScene(scene_);
}

size_t MeshBvh::memory_bytes() const
{
    // The tree takes about 100 bytes per triangle (Embree 3.13, 8 wide, robust).
    return mesh_.positions.capacity() * sizeof(Vec3) + mesh_.normals.capacity() * sizeof(Vec3) +
           mesh_.uvs.capacity() * sizeof(Vec2) +
           mesh_.triangles.capacity() * (sizeof(glm::uvec3) + 100);
}

}  // namespace mote
