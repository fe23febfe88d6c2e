#pragma once

#include <memory>
#include <span>
#include <vector>

#include "core/transform.h"
#include "surfaces/mesh_bvh.h"

namespace mote {

/// A mesh, and where it is while the shutter is open.
struct MeshInstance {
    std::shared_ptr<const MeshBvh> mesh;
    MovingTransform world_from_object;
};

/// An instance's transform at one instant: exactly the one that Embree traces by.
struct InstanceFrame {
    glm::dmat3 linear{1.0};  ///< world from object
    Vec3d offset{0.0};       ///< [m]
    glm::dmat3 inverse{1.0};

    [[nodiscard]] Vec3d point(Vec3d p_object) const { return linear * p_object + offset; }
};

/// Tree over the instances of a frame. Meshes keep their own trees, so what moves costs only this
/// one (about 1 us per instance).
class InstanceBvh {
  public:
    /// Precondition: at least one instance. Throws Error(Memory).
    explicit InstanceBvh(std::vector<MeshInstance> instances);
    ~InstanceBvh();
    InstanceBvh(const InstanceBvh&) = delete;
    InstanceBvh& operator=(const InstanceBvh&) = delete;

    [[nodiscard]] const std::vector<MeshInstance>& instances() const { return instances_; }
    [[nodiscard]] RTCSceneTy* embree() const { return scene_; }
    [[nodiscard]] InstanceFrame frame_at(size_t instance, float time) const;
    /// World bounds over the whole shutter.
    [[nodiscard]] Bounds3 bounds() const;

  private:
    std::vector<MeshInstance> instances_;
    std::vector<InstanceFrame> at_rest_;  ///< of those that do not move
    std::shared_ptr<EmbreeDevice> device_;
    RTCSceneTy* scene_ = nullptr;
};

}  // namespace mote
