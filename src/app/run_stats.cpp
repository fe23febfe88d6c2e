#include "app/run_stats.h"

#include <algorithm>
#include <ctime>

#include <nlohmann/json.hpp>

#include "app/image_metadata.h"
#include "app/text_file.h"

namespace mote {

namespace {

using Json = nlohmann::ordered_json;

double seconds_of(clockid_t clock)
{
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Work of the ReSTIR estimator: what a scene does not need shows as 0.
Json restir_json(const FrameStats& stats)
{
    return {{"cache_cpu_s", stats.cache_cpu_seconds},
            {"caches_built", stats.caches_built},
            {"caches_reused", stats.caches_reused},
            {"transmittance_maps", stats.caches.transmittance_maps},
            {"direction_sets", stats.caches.direction_sets},
            {"local_lights", stats.caches.local_lights},
            {"light_cells", stats.caches.light_cells},
            {"cache_bytes",
             {{"transmittance_maps", stats.caches.map_bytes},
              {"directions", stats.caches.direction_bytes},
              {"environment", stats.caches.environment_bytes},
              {"light_cells", stats.caches.cell_bytes}}},
            {"camera_rays", stats.camera_rays},
            {"missed_rays", stats.missed_rays},
            {"light_rays", stats.light_rays},
            {"cells", stats.cells},
            {"light_ray_cells", stats.light_ray_cells},
            {"coarse_rays", stats.coarse_rays},
            {"coarse_ray_cells", stats.coarse_ray_cells},
            {"uniform_bricks", stats.uniform_bricks},
            {"candidates", stats.candidates},
            {"surfaces", stats.surfaces},
            {"emission_integrals", stats.emission_integrals},
            {"histories_used", stats.histories_used},
            {"neighbours_used", stats.neighbours_used}};
}

Json to_json(const FrameRecord& r)
{
    Json j{{"frame", r.frame}, {"file", r.file}, {"skipped", r.skipped}, {"reason", r.reason}};
    if (r.skipped) return j;
    j["wall_s"] = {{"total", r.total_seconds},
                   {"prepare", r.prepare_seconds},
                   {"render", r.render.render_seconds},
                   {"write", r.write_seconds}};
    j["cpu_s"] = {{"total", r.total_cpu_seconds},
                  {"prepare", r.prepare_cpu_seconds},
                  {"render", r.render.render_cpu_seconds}};
    j["prepare"] = {{"particles_s", r.prepare.particle_seconds},
                    {"rasterize_s", r.prepare.rasterize_seconds},
                    {"load_s", r.prepare.load_seconds},
                    {"bricks_s", r.prepare.brick_seconds},
                    {"grids_built", r.prepare.grids_built},
                    {"grids_reused", r.prepare.grids_reused},
                    {"particles", r.prepare.particles},
                    {"brick_bytes", r.prepare.brick_bytes},
                    {"meshes_built", r.prepare.meshes_built},
                    {"meshes_reused", r.prepare.meshes_reused},
                    {"instance_trees_built", r.prepare.instance_trees_built},
                    {"mesh_bytes", r.prepare.mesh_bytes},
                    {"texture_bytes", r.prepare.texture_bytes},
                    {"non_finite_values", r.prepare.non_finite_values},
                    {"negative_values", r.prepare.negative_values}};
    j["paths"] = r.render.paths;
    j["dropped_non_finite"] = r.render.dropped_non_finite;
    const Truncation& truncation = r.render.truncation;
    j["truncated_paths"] = truncation.paths;
    j["truncated_weight"] =
        truncation.weight / static_cast<double>(std::max<int64_t>(r.render.paths, 1));
    j["majorant_violations"] = r.render.tracking.majorant_violations;
    j["tracking"] = {{"free_flights", r.render.tracking.free_flights},
                     {"shadow_rays", r.render.tracking.shadow_rays},
                     {"surface_rays", r.render.tracking.surface_rays},
                     {"density_lookups", r.render.tracking.lookups},
                     {"closed_bricks", r.render.tracking.closed_bricks}};
    j["memory_bytes"] = {{"grids", r.render.memory.grids},
                         {"film", r.render.memory.film},
                         {"history", r.render.memory.history}};
    if (r.render.camera_rays + r.render.missed_rays > 0) j["restir"] = restir_json(r.render);
    j["peak_memory_bytes"] = r.peak_memory;
    return j;
}

}  // namespace

double wall_seconds()
{
    return seconds_of(CLOCK_MONOTONIC);
}

double cpu_seconds()
{
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

void write_run_stats(const std::string& path, const SceneDescription& scene, int threads,
                     const std::vector<FrameRecord>& records, bool finished)
{
    Json frames = Json::array();
    for (const FrameRecord& record : records) frames.push_back(to_json(record));
    const Json j{{"version", MOTE_VERSION},
                 {"scene", scene.path},
                 {"scene_hash", scene_hash_text(scene)},
                 {"width", scene.render.width},
                 {"height", scene.render.height},
                 {"samples", scene.render.samples},
                 {"seed", scene.render.seed},
                 {"threads", threads},
                 {"finished", finished},
                 {"frames", std::move(frames)}};
    write_text_file(path, j.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace mote
