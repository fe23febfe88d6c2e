#pragma once

#include <memory>
#include <string>

#include "scene/description.h"
#include "scene/scene.h"

namespace mote {

/// What a frame's preparation did; zero for whatever the frame did not need.
struct PrepareStats {
    double particle_seconds = 0.0;
    double rasterize_seconds = 0.0;
    double load_seconds = 0.0;
    double brick_seconds = 0.0;
    int grids_built = 0;
    int grids_reused = 0;  ///< unchanged since an earlier frame of this run
    int64_t particles = 0;
    size_t brick_bytes = 0;
    int meshes_built = 0;          ///< read, and their trees built
    int meshes_reused = 0;         ///< unchanged since an earlier frame of this run
    int instance_trees_built = 0;  ///< 1 if anything with a surface is new or has moved
    size_t mesh_bytes = 0;
    size_t texture_bytes = 0;
    int64_t non_finite_values = 0;  ///< set to 0 on load
    int64_t negative_values = 0;    ///< clamped to 0 on load
};

/// Keeps grids and meshes between frames, keyed by what they were built from.
class SceneCache {
  public:
    SceneCache();
    ~SceneCache();
    SceneCache(const SceneCache&) = delete;
    SceneCache& operator=(const SceneCache&) = delete;
    struct Impl;
    [[nodiscard]] Impl& impl() { return *impl_; }

  private:
    std::unique_ptr<Impl> impl_;
};

/// Which optional grids the renderer needs beyond what shading needs.
struct PrepareNeeds {
    bool velocity = false;  ///< motion AOV or temporal reuse
    /// Take .vdb files without the velocity grid as at rest; else they are an error.
    bool velocity_may_be_missing = false;
};

/// What to do about a volume file without velocities when the motion layer is asked for.
inline constexpr const char* no_velocity_advice =
    "The motion layer needs it: name the file's grid by \"velocity_grid\", set that to \"\" for a "
    "volume at rest, or leave \"motion\" out of output.aovs";

/// Everything of `description` at a whole frame, ready to render. The one place where particles,
/// grids and media meet. Throws Error(Input) naming file and grid.
[[nodiscard]] Scene prepare_frame(const SceneDescription& description, int frame,
                                  const PrepareNeeds& needs, SceneCache& cache,
                                  PrepareStats& stats);

}  // namespace mote
