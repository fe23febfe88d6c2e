#include "scene/prepare_volumes.h"

#include <chrono>

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "particles/rasterize.h"
#include "scene/particle_system.h"
#include "volumes/grid_io.h"
#include "volumes/make_bricks.h"
#include "volumes/procedural.h"

namespace mote {
namespace {

class Timer {
  public:
    explicit Timer(double& seconds) : seconds_(seconds) {}
    ~Timer()
    {
        const auto now = std::chrono::steady_clock::now();
        seconds_ += std::chrono::duration<double>(now - start_).count();
    }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

  private:
    double& seconds_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

bool is_vector(GridRole role)
{
    return role == GridRole::Color || role == GridRole::Velocity;
}

CachedGrid to_bricks(const openvdb::GridBase::Ptr& grid, GridRole role, const std::string& place,
                     PrepareStats& stats)
{
    const Timer timer(stats.brick_seconds);
    GridLoadReport report;
    CachedGrid out;
    if (const auto scalar = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        scalar && !is_vector(role)) {
        out.scalar = make_bricks(*scalar, {}, report);
    } else if (const auto vector = openvdb::gridPtrCast<openvdb::Vec3SGrid>(grid);
               vector && is_vector(role)) {
        out.vector = make_color_bricks(*vector, {}, report);
    } else {
        throw Error(ExitCode::Input, fmt::format("{}: must hold {}", place,
                                                 is_vector(role) ? "three numbers per voxel"
                                                                 : "one number per voxel"));
    }
    stats.non_finite_values += report.non_finite;
    stats.negative_values += report.negative;
    if (report.non_finite + report.negative > 0) {
        spdlog::warn("{}: {} values that are not finite and {} negative ones count as 0", place,
                     report.non_finite, report.negative);
    }
    ++stats.grids_built;
    return out;
}

void build(const FilePlan& file, const GridPlan& plan, const std::vector<PlannedGrid>& missing,
           const PlanContext&, SceneCache::Impl& cache, PrepareStats& stats)
{
    std::vector<std::string> names;
    names.reserve(missing.size());
    for (const PlannedGrid& grid : missing) names.push_back(grid.name);
    openvdb::GridPtrVec grids;
    {
        const Timer timer(stats.load_seconds);
        grids = read_grids(file.path, names);
    }
    for (size_t i = 0; i < missing.size(); ++i) {
        const std::string place = fmt::format("{}: grid \"{}\"", file.path, names[i]);
        cache.grids[plan.key(missing[i])] = to_bricks(grids[i], missing[i].role, place, stats);
        grids[i].reset();  // the unpacked tree and its bricks are not needed at once
    }
}

void build(const ParticlesPlan& from, const GridPlan& plan, const std::vector<PlannedGrid>&,
           const PlanContext& context, SceneCache::Impl& cache, PrepareStats& stats)
{
    const ParticlesDescription& system = *from.system;
    RasterizeParams params;
    params.voxel_size = system.voxel_size;
    params.shutter_open_s = from.shutter_open_s;
    params.shutter_close_s = from.shutter_close_s;
    for (const PlannedGrid& grid : plan.grids) {
        params.channels.velocity |= grid.role == GridRole::Velocity;
        params.channels.temperature |= grid.role == GridRole::Temperature;
        params.channels.color |= grid.role == GridRole::Color;
    }
    AttributeMask mask;
    mask.velocity = params.channels.velocity || from.shutter_open_s != from.shutter_close_s;
    mask.temperature = params.channels.temperature;
    mask.color = params.channels.color;
    mask.id = mask.age = false;

    ParticleGrids grids;
    {
        ParticleSet particles;
        {
            const Timer timer(stats.particle_seconds);
            particles =
                particles_at(system.source, context.frame, context.fps, context.base_dir, mask);
        }
        stats.particles += static_cast<int64_t>(particles.size());
        if (particles.size() > 0) {
            if (params.channels.velocity && particles.velocity.empty()) {
                missing_attribute(system, "velocity", "the motion layer");
            }
            if (params.channels.temperature && particles.temperature.empty()) {
                missing_attribute(system, "temperature", "blackbody emission");
            }
            if (params.channels.color && particles.color.empty()) {
                missing_attribute(system, "color", "\"use_color\"");
            }
            if (from.shutter_open_s != from.shutter_close_s && particles.velocity.empty()) {
                spdlog::warn(
                    "particles \"{}\": no velocities, so they do not blur along their motion; name "
                    "the file's attribute under \"attributes\" if it has one",
                    system.name);
            }
        }
        const Timer timer(stats.rasterize_seconds);
        try {
            grids = rasterize(particles, params);
        } catch (const Error& error) {
            throw Error(error.code(),
                        fmt::format("particles \"{}\": {}", system.name, error.what()));
        }
    }
    for (const PlannedGrid& grid : plan.grids) {
        const openvdb::GridBase::Ptr built =
            grid.role == GridRole::Density       ? grids.density
            : grid.role == GridRole::Temperature ? grids.temperature
            : grid.role == GridRole::Color       ? openvdb::GridBase::Ptr(grids.color)
                                                 : openvdb::GridBase::Ptr(grids.velocity);
        if (!built) continue;  // no particles at this frame
        const std::string place = fmt::format("particles \"{}\": {}", system.name, grid.name);
        cache.grids[plan.key(grid)] = to_bricks(built, grid.role, place, stats);
    }
}

void build(const ProceduralPlan& from, const GridPlan& plan,
           const std::vector<PlannedGrid>& missing, const PlanContext&, SceneCache::Impl& cache,
           PrepareStats& stats)
{
    openvdb::FloatGrid::Ptr grid;
    {
        const Timer timer(stats.load_seconds);
        grid = make_procedural(from.params, from.time_s);
    }
    for (const PlannedGrid& planned : missing) {
        cache.grids[plan.key(planned)] = to_bricks(grid, planned.role, "procedural", stats);
    }
}

}  // namespace

void build_grids(const GridPlan& plan, const PlanContext& context, SceneCache::Impl& cache,
                 PrepareStats& stats)
{
    std::vector<PlannedGrid> missing;
    for (const PlannedGrid& grid : plan.grids) {
        if (cache.grids.count(plan.key(grid)) > 0) {
            ++stats.grids_reused;
        } else {
            missing.push_back(grid);
        }
    }
    if (missing.empty()) return;
    std::visit([&](const auto& source) { build(source, plan, missing, context, cache, stats); },
               plan.source);
}

}  // namespace mote
