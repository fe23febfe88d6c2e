#include "restir/light_caches.h"

#include <algorithm>

#include "restir/in_view.h"
#include "restir/same.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

bool is_same(const LocalLight& a, const LocalLight& b)
{
    return a.id == b.id && a.position == b.position && a.spread2 == b.spread2 &&
           a.facing == b.facing && a.power == b.power;
}

Vec3 camera_position(const Camera& camera)
{
    return Vec3(camera.world_from_camera.at(cache_time).translate);
}

/// What is built now and what the frame before had.
struct Builder {
    const Scene& scene;
    const CacheSizes& sizes;
    const LightCaches* previous;  ///< null: nothing can be taken over
    bool same_media;
    bool same_shadows;  ///< media and surfaces both
    LightCaches& out;

    void add_distant() const;
    void add_spots() const;
    void add_map(LightCaches::Distant distant) const;
    void add_environment() const;
    void add_extinction() const;
    [[nodiscard]] std::shared_ptr<const EmissiveBricks> emissive_bricks(size_t i) const;
    void add_local() const;
};

void Builder::add_distant() const
{
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const auto* lamp = std::get_if<DistantLight>(&scene.lights[i]);
        if (!lamp || !(max_component(lamp->irradiance) > 0.0f)) continue;
        add_map({static_cast<int>(i), -1, lamp->direction, lamp->irradiance, nullptr});
    }
}

void Builder::add_map(LightCaches::Distant distant) const
{
    if (same_shadows) {
        for (const LightCaches::Distant& old : previous->distant) {
            if (old.direction == distant.direction) distant.map = old.map;
        }
    }
    distant.map ? ++out.reused : ++out.built;
    if (!distant.map) {
        distant.map = std::make_shared<TransmittanceMap>(
            scene.media, distant.direction, TransmittanceMapParams{}, scene.surfaces.get());
    }
    out.distant.push_back(std::move(distant));
}

void Builder::add_spots() const
{
    for (size_t i = 0; i < out.parts->spots.size(); ++i) {
        const EnvironmentSpot& spot = out.parts->spots[i];
        add_map({-1, static_cast<int>(i), spot.direction, spot.irradiance, nullptr});
    }
}

void Builder::add_environment() const
{
    if (!sizes.sky || !scene.environment || !(max_component(scene.environment->radiance) > 0.0f))
        return;
    const bool same_light =
        previous && previous->parts && is_same(previous->parts->whole, *scene.environment);
    out.parts =
        same_light
            ? previous->parts
            : std::make_shared<const EnvironmentParts>(split_environment(*scene.environment));
    add_spots();
    DirectionTransmittanceParams params;
    if (sizes.pixel_passes < 100'000) {
        params.hats = {4, 8};
        params.node_spacing = 8.0f * finest_voxel(scene.media);
    }
    if (same_shadows) {
        out.directions = previous->directions;
        out.guess = previous->guess;
    }
    out.directions ? ++out.reused : ++out.built;
    if (!out.directions) {
        out.directions =
            std::make_shared<DirectionTransmittance>(scene.media, params, scene.surfaces.get());
        out.guess = std::make_shared<LightGuess>(make_light_guess(scene.media, *out.directions));
    }
    const bool same_radiance =
        same_light && previous->environment_radiance.size() ==
                          static_cast<size_t>(out.directions->hats().count());
    out.environment_radiance = same_radiance
                                   ? previous->environment_radiance
                                   : mean_radiance(out.parts->rest, out.directions->hats());
    out.environment.emplace(out.directions, out.environment_radiance, scene.media,
                            camera_position(scene.camera));
}

void Builder::add_extinction() const
{
    if (!sizes.extinction) return;
    constexpr float edge_voxels = 4.0f;
    constexpr size_t most_cells = 150'000;
    if (same_media) out.extinction = previous->extinction;
    out.extinction ? ++out.reused : ++out.built;
    if (out.extinction) return;
    out.extinction = std::make_shared<CoarseExtinction>(make_coarse_extinction(
        scene.media, find_smoke_cells(scene.media, edge_voxels, most_cells)));
}

/// Where a volume glows, in object space: wherever it moves to.
std::shared_ptr<const EmissiveBricks> Builder::emissive_bricks(size_t i) const
{
    const Volume& volume = scene.media.volumes[i];
    if (previous && i < previous->volumes.size() && previous->emissive[i]) {
        const Volume& old = previous->volumes[i];
        if (old.density == volume.density && old.density_scale == volume.density_scale &&
            is_same_look(old, volume)) {
            ++out.reused;
            return previous->emissive[i];
        }
    }
    auto bricks = std::make_shared<const EmissiveBricks>(make_emissive_bricks(volume));
    if (bricks->empty()) return nullptr;
    ++out.built;
    return bricks;
}

void Builder::add_local() const
{
    out.local_lights = local_lights(scene.lights);
    out.emissive.resize(scene.media.volumes.size());
    int id = static_cast<int>(scene.lights.size());
    for (size_t i = 0; i < scene.media.volumes.size(); ++i) {
        const Volume& volume = scene.media.volumes[i];
        if (!volume.emission_params.is_on()) continue;
        out.emissive[i] = emissive_bricks(i);
        if (out.emissive[i]) {
            add_emissive_volume(volume, *out.emissive[i], id++, out.local_lights);
        }
    }
    if (out.local_lights.empty()) return;
    const Vec3 eye = camera_position(scene.camera);
    const bool same = same_media && previous->cells &&
                      std::equal(out.local_lights.begin(), out.local_lights.end(),
                                 previous->local_lights.begin(), previous->local_lights.end(),
                                 [](const auto& a, const auto& b) { return is_same(a, b); });
    same ? ++out.reused : ++out.built;
    if (same) {
        out.cells = previous->cells;
        out.cells->set_eye(eye);
    } else {
        out.cells.emplace(scene.media, out.local_lights, eye);
    }
}

}  // namespace

std::shared_ptr<const LightCaches> make_light_caches(
    const Scene& scene, const CacheSizes& sizes, const std::shared_ptr<const LightCaches>& previous)
{
    auto out = std::make_shared<LightCaches>();
    out->media = media_key(scene.media);
    const std::vector<Volume>& volumes = scene.media.volumes;
    const bool in_view =
        !std::all_of(volumes.begin(), volumes.end(), is_void) && media_in_view(scene);
    if (!in_view && !scene.surfaces) {
        out->emissive.resize(volumes.size());
        return out;
    }
    out->surfaces = scene.surfaces;
    out->volumes = volumes;
    const bool same_media = previous && previous->media == out->media;
    const bool same_shadows = same_media && is_same(previous->surfaces.get(), scene.surfaces.get());
    const Builder builder{scene, sizes, previous.get(), same_media, same_shadows, *out};
    if (in_view) {
        builder.add_distant();
        builder.add_environment();
        builder.add_extinction();
    }
    builder.add_local();
    return out;
}

CacheParts parts_of(const LightCaches& caches)
{
    CacheParts parts;
    parts.transmittance_maps = static_cast<int>(caches.distant.size());
    parts.direction_sets = caches.directions ? 1 : 0;
    parts.local_lights = static_cast<int64_t>(caches.local_lights.size());
    for (const LightCaches::Distant& distant : caches.distant) {
        parts.map_bytes += distant.map->stats().bytes;
    }
    if (caches.directions) parts.direction_bytes = caches.directions->stats().bytes;
    if (caches.extinction) {
        parts.extinction_bytes =
            static_cast<int64_t>(caches.extinction->sigma_t.size() * sizeof(float));
    }
    if (caches.environment) parts.environment_bytes = caches.environment->stats().bytes;
    if (caches.cells) {
        parts.light_cells = static_cast<int64_t>(caches.cells->cell_count());
        parts.cell_bytes = static_cast<int64_t>(caches.cells->memory_bytes());
    }
    return parts;
}

}  // namespace mote
