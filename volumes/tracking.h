#pragma once

#include <optional>
#include <vector>

#include "core/rng.h"
#include "volumes/emission.h"
#include "volumes/volume.h"

namespace mote {

/// All media of a scene; they may overlap. Each is tracked on its own: the first of independent
/// free flights is a free flight of the sum, and transmittances multiply.
struct Media {
    std::vector<Volume> volumes;

    [[nodiscard]] bool empty() const { return volumes.empty(); }
};

/// How transmittance is estimated; all are unbiased.
enum class TransmittanceKind { Ratio, ResidualRatio, Exact };

/// A real collision on a ray.
struct Collision {
    float t = 0.0f;   ///< world distance [m]
    int volume = -1;  ///< whose particle was hit
    Vec3 p_object;    ///< in that volume's object space
};

/// First real collision in range, or empty if the ray leaves. Delta tracking with the majorants of
/// 8^3 bricks. Cost: about one density lookup per tentative collision.
[[nodiscard]] std::optional<Collision> sample_free_flight(const Media& media, const Ray& ray,
                                                          Interval range, Rng& rng);

/// Where the optical depth of one volume, counted from range.t0, reaches `tau`; empty if it does
/// not within the range. With tau = sample_exponential(u) this is an exact free flight from one
/// random number. Cost: every cell up to there (about 20 ns each).
[[nodiscard]] std::optional<Collision> invert_optical_depth(const Volume& volume, const Ray& ray,
                                                            Interval range, float tau);

/// Unbiased transmittance over the range; Exact is deterministic and uses no random numbers.
[[nodiscard]] float estimate_transmittance(const Media& media, const Ray& ray, Interval range,
                                           TransmittanceKind kind, Rng& rng);

/// Optical depth of one volume over the range, closed form per cell: along a ray the trilinear
/// density is a cubic in t, so Simpson's rule is exact. Relative error: float rounding.
[[nodiscard]] float optical_depth(const Volume& volume, const Ray& ray, Interval range);

/// Sum over all volumes.
[[nodiscard]] float optical_depth(const Media& media, const Ray& ray, Interval range);

/// Single-scattering albedo at a collision, colour grid included. [0,1] per channel.
[[nodiscard]] Spectrum albedo_at(const Volume& volume, Vec3 p_object);

/// Extinction [1/m].
[[nodiscard]] float sigma_t_at(const Volume& volume, Vec3 p_object);

/// Extinction of all media at a world point and ray time [1/m].
[[nodiscard]] float sigma_t_at(const Media& media, Vec3 p, float time);

/// Velocity of the medium in object space [m/s]; 0 without a velocity grid.
[[nodiscard]] Vec3 velocity_at(const Volume& volume, Vec3 p_object);

}  // namespace mote
