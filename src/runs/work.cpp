#include "runs/work.h"

namespace mote {

namespace {

constexpr WorkField work_table[] = {
    {"camera_rays", &WorkCounts::camera_rays},
    {"lookups", &WorkCounts::lookups},
    {"cells", &WorkCounts::cells},
    {"bricks", &WorkCounts::bricks},
    {"shadow_rays", &WorkCounts::shadow_rays},
    {"candidates", &WorkCounts::candidates},
    {"reused", &WorkCounts::reused},
};

constexpr MemoryField memory_table[] = {
    {"grids", &MemoryUse::grids},           {"maps", &MemoryUse::maps},
    {"directions", &MemoryUse::directions}, {"environment", &MemoryUse::environment},
    {"cells", &MemoryUse::cells},           {"film", &MemoryUse::film},
    {"history", &MemoryUse::history},
};

double sum(int64_t a, int64_t b)
{
    return static_cast<double>(a + b);
}

}  // namespace

void WorkCounts::add(const WorkCounts& other, double factor)
{
    for (const WorkField& field : work_table) this->*field.value += factor * other.*field.value;
}

WorkCounts work_of(const FrameStats& stats)
{
    WorkCounts work;
    work.camera_rays = static_cast<double>(stats.camera_rays);
    work.lookups = static_cast<double>(stats.tracking.lookups);
    work.cells = sum(stats.cells, stats.coarse_ray_cells);
    work.bricks = sum(stats.uniform_bricks, stats.tracking.closed_bricks);
    work.shadow_rays = sum(stats.light_rays + stats.coarse_rays + stats.tracking.surface_rays,
                           stats.tracking.shadow_rays);
    work.candidates = static_cast<double>(stats.candidates);
    work.reused = sum(stats.histories_used, stats.neighbours_used);
    return work;
}

MemoryUse memory_of(const FrameStats& stats)
{
    MemoryUse use;
    use.grids = static_cast<double>(stats.memory.grids);
    use.maps = static_cast<double>(stats.caches.map_bytes);
    use.directions = static_cast<double>(stats.caches.direction_bytes);
    use.environment = static_cast<double>(stats.caches.environment_bytes);
    use.cells = static_cast<double>(stats.caches.cell_bytes);
    use.film = static_cast<double>(stats.memory.film);
    use.history = static_cast<double>(stats.memory.history);
    return use;
}

std::span<const WorkField> work_fields()
{
    return work_table;
}

std::span<const MemoryField> memory_fields()
{
    return memory_table;
}

}  // namespace mote
