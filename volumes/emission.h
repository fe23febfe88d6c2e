#pragma once

#include <functional>
#include <vector>

#include "core/rng.h"
#include "volumes/volume.h"

namespace mote {

/// Temperature of the medium [K]; the offset alone without a temperature grid.
[[nodiscard]] float temperature_at(const Volume& volume, Vec3 p_object);

/// Emission coefficient j [W/(m^3 sr)] at an object-space point.
[[nodiscard]] Spectrum emission_at(const Volume& volume, Vec3 p_object);

/// Unbiased estimate of the integral of j along the range, absorption left out. With a range that
/// ends at the free flight's collision its mean is the emitted radiance that arrives, since
/// E[integral_0^{t_c} j dt] = integral T j dt. One jittered lookup per brick.
[[nodiscard]] Spectrum estimate_emission(const Volume& volume, const Ray& ray, Interval range,
                                         Rng& rng);

/// Factor on each lookup of estimate_emission: world distance t and object-space point.
using EmissionWeight = std::function<float(float t, Vec3 p_object)>;

/// The same with every lookup multiplied by `weight`: a share for multiple importance sampling.
[[nodiscard]] Spectrum estimate_emission(const Volume& volume, const Ray& ray, Interval range,
                                         Rng& rng, const EmissionWeight& weight);

/// The emission grid's term of j alone, with a lookup for every `cells_per_lookup` cells or less:
/// for few rays that have to be exact.
[[nodiscard]] Spectrum estimate_grid_emission(const Volume& volume, const Ray& ray, Interval range,
                                              float cells_per_lookup, Rng& rng,
                                              const EmissionWeight& weight);

/// Source function of the term that follows the density: j over sigma_t [W/(m^2 sr)] at an
/// object-space point. Where it is constant, a medium of optical depth tau shows 1 - exp(-tau) of
/// it.
[[nodiscard]] Spectrum source_at(const Volume& volume, Vec3 p_object);

/// Where a volume emits: a distribution over brick positions, about in proportion to the power
/// they give off, never 0 where j is not. Object space, so it holds for the whole shutter.
struct EmissiveBricks {
    /// Positions of one grid's table that emit.
    struct Part {
        const BrickGrid* grid = nullptr;
        std::vector<float> pmf;     ///< per table entry, over both parts together
        double brick_volume = 0.0;  ///< of one brick in object space [m^3]
    };
    struct Brick {
        int part = 0;
        Vec3i position{0};
        float power = 0.0f;     ///< luminance, 4 pi sr included [W, relative]
        float majorant = 0.0f;  ///< upper bound of the luminance of its term of j in the brick
    };
    Part parts[2];  ///< of the density grid (black body) and of the emission grid
    std::vector<Brick> bricks;
    std::vector<float> cdf;    ///< cdf[i]: share of bricks 0..i; the last is 1
    double total_power = 0.0;  ///< luminance [W, relative], in object space; 0: does not emit

    [[nodiscard]] bool empty() const { return bricks.empty(); }
};

/// Parallel over bricks; 64 lookups each. Keeps pointers to the volume's grids.
[[nodiscard]] EmissiveBricks make_emissive_bricks(const Volume& volume);

/// A point picked for its emission.
struct EmissionSample {
    Vec3 p{0.0f};             ///< world space [m]
    Spectrum j{0.0f};         ///< emission coefficient there, both terms
    float pdf_volume = 0.0f;  ///< [1/m^3], world space
};

/// Picks a point; the mean of j / pdf_volume is the integral of j over the volume. Precondition:
/// bricks not empty.
[[nodiscard]] EmissionSample sample_emission(const Volume& volume, const EmissiveBricks& bricks,
                                             float time, Rng& rng);

/// Density [1/m^3, world space] with which sample_emission picks an object-space point.
[[nodiscard]] float emission_pdf(const Volume& volume, const EmissiveBricks& bricks, float time,
                                 Vec3 p_object);

}  // namespace mote
