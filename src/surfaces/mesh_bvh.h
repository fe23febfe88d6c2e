#pragma once

#include <memory>

#include "surfaces/mesh.h"

struct RTCSceneTy;

namespace mote {

class EmbreeDevice;

/// A mesh with the Embree tree that rays find its triangles by. Never changes once made, so frames
/// and instances share it.
class MeshBvh {
  public:
    /// Builds the tree, by one thread: its layout, and so which of two triangles at equal distance
    /// is hit, must not depend on the thread count. `mesh` is finished. Throws Error(Memory). Cost:
    /// about 0.5 s of CPU time per million triangles.
    explicit MeshBvh(Mesh mesh);
    ~MeshBvh();
    MeshBvh(const MeshBvh&) = delete;
    MeshBvh& operator=(const MeshBvh&) = delete;

    [[nodiscard]] const Mesh& mesh() const { return mesh_; }
    [[nodiscard]] RTCSceneTy* embree() const { return scene_; }
    [[nodiscard]] const std::shared_ptr<EmbreeDevice>& device() const { return device_; }
    [[nodiscard]] size_t memory_bytes() const;

  private:
    Mesh mesh_;
    std::shared_ptr<EmbreeDevice> device_;
    RTCSceneTy* scene_ = nullptr;
};

/// Embree devices made by this process so far: 0 as long as no scene had a mesh.
[[nodiscard]] int embree_devices_made();

}  // namespace mote
