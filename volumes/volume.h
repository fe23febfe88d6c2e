#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/transform.h"
#include "volumes/bricks.h"
#include "volumes/phase.h"

namespace mote {

/// Light given off by a volume. Emission coefficient j [W/(m^3 sr), relative]:
///   j(x) = emission_scale * E(x) * emission_color
///        + blackbody_scale * sigma_t(x) * (T/1500 K)^4 * blackbody_rgb(T),
///   T(x) = temperature_scale * temperature grid + temperature_offset.
/// blackbody_rgb has luminance 1. The first term needs no density, the second follows it.
struct Emission {
    float emission_scale = 0.0f;  ///< [1/m] per unit of the emission grid
    Spectrum emission_color{1.0f};
    float blackbody_scale = 0.0f;     ///< radiance of an opaque medium at 1500 K
    float temperature_scale = 1.0f;   ///< [K] per unit of the temperature grid
    float temperature_offset = 0.0f;  ///< [K]

    [[nodiscard]] bool is_on() const { return emission_scale > 0.0f || blackbody_scale > 0.0f; }
};

/// World space to the local coordinates of one grid (index minus its `lo`). In double: floats
/// would lose whole voxels where a grid or a camera is far from the world's origin.
struct GridFrame {
    glm::dmat3 linear{1.0};
    Vec3d offset{0.0};

    [[nodiscard]] Vec3d point(Vec3 p) const { return linear * Vec3d(p) + offset; }
    [[nodiscard]] Vec3d vector(Vec3 v) const { return linear * Vec3d(v); }
};

/// A volume's transforms at one instant.
struct VolumeFrames {
    GridFrame density;
    GridFrame emission;  ///< of the emission grid, if there is one
};

/// One participating medium, ready to render. sigma_t(x) = density_scale * density(x), where
/// density is the trilinear reconstruction of the grid. Grids are shared between frames that do
/// not change them. All grids share `object_from_world`'s object space; each has its own
/// index_from_object.
struct Volume {
    std::string name;
    std::shared_ptr<const BrickGrid> density;
    std::shared_ptr<const BrickGrid> temperature;  ///< null: none
    std::shared_ptr<const BrickGrid> emission;     ///< null: none
    std::shared_ptr<const ColorGrid> color;        ///< null: `albedo` everywhere
    std::shared_ptr<const ColorGrid> velocity;     ///< [m/s] in object space; null: at rest
    float density_scale = 1.0f;                    ///< sigma_t per density unit [1/m]
    Spectrum albedo{1.0f};                         ///< multiplies `color` where there is one
    Phase phase;
    Emission emission_params;
    MovingTransform world_from_object;

    /// Filled by finalize(): saves every ray and lookup from inverting matrices.
    std::optional<Affine> object_from_local;  ///< local coordinates of `density` -> object space
    std::optional<VolumeFrames> at_rest;      ///< stays empty if the volume moves
};

/// Whether a volume scatters and absorbs nothing anywhere.
[[nodiscard]] inline bool is_void(const Volume& volume)
{
    return !volume.density || volume.density->index_bounds.is_empty() ||
           !(volume.density_scale > 0.0f);
}

/// Caches the transforms. Call it once all fields are set, and again after changing density,
/// emission or world_from_object. Without it everything works, slower.
void finalize(Volume& volume);

/// Transforms at ray time [0,1]; a copy of the cache for volumes at rest.
[[nodiscard]] VolumeFrames frames_at(const Volume& volume, float time);

/// Local coordinates of the density grid -> object space.
[[nodiscard]] Affine object_from_local(const Volume& volume);

/// A world point in the volume's object space, at ray time.
[[nodiscard]] Vec3 object_point(const Volume& volume, Vec3 p, float time);

/// Where a ray meets a volume's density at its time; empty if it misses.
[[nodiscard]] Interval volume_interval(const Volume& volume, const Ray& ray, Interval range);

/// World-space bounds of density and emission over the whole shutter; empty for an empty volume.
[[nodiscard]] Bounds3 world_bounds(const Volume& volume);

}  // namespace mote
