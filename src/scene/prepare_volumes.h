#pragma once

#include <string>
#include <variant>
#include <vector>

#include "scene/grid_cache.h"

namespace mote {

/// What a grid is for.
enum class GridRole { Density, Temperature, Emission, Color, Velocity };

struct PlannedGrid {
    GridRole role = GridRole::Density;
    std::string name;  ///< in the file; of particles: as in ParticleGrids
};

struct FilePlan {
    std::string path;
};
struct ParticlesPlan {
    const ParticlesDescription* system = nullptr;
    float shutter_open_s = 0.0f;
    float shutter_close_s = 0.0f;
};
struct ProceduralPlan {
    ProceduralParams params;
    double time_s = 0.0;
};

/// Grids to take from one source at one frame. `version` changes when their content may.
struct GridPlan {
    std::variant<FilePlan, ParticlesPlan, ProceduralPlan> source;
    std::string version;
    std::vector<PlannedGrid> grids;

    [[nodiscard]] std::string key(const PlannedGrid& grid) const
    {
        return version + "\n" + grid.name;
    }
};

/// Where and when grids are built.
struct PlanContext {
    int frame = 0;
    double fps = 24.0;
    std::string base_dir;
};

/// Puts every grid of the plan that is missing into the cache. The one place of src/scene that
/// touches OpenVDB. Throws Error(Input) naming file and grid, or particle system and attribute.
void build_grids(const GridPlan& plan, const PlanContext& context, SceneCache::Impl& cache,
                 PrepareStats& stats);

}  // namespace mote
