#pragma once

#include "restir/candidates.h"

namespace mote {

/// Where a pixel's surface samples live in one pass: the first surface on its camera ray. A sample
/// is a light and its numbers, as in the volume, at the surface instead of on the ray (y.u counts
/// for nothing). Another pixel's surface takes the numbers as they are: Jacobian 1.
struct SurfaceDomain {
    SurfaceVertex v;  ///< v.object < 0: none
    Vec3 wo{0.0f};    ///< towards the camera [unit]
    float time = 0.0f;
    float distance = 0.0f;  ///< from the camera [m]
    /// Share of the surface's light that media let through to the camera, over the probability with
    /// which passes go on to sample it. 0: this one does not.
    float share = 0.0f;

    [[nodiscard]] bool is_sampled() const { return share > 0.0f; }
};

/// A surface as one end of a shift.
struct SurfaceEnd {
    const FrameDomain& frame;
    const SurfaceDomain& domain;
};

/// The surface that ends the ray of `domain`, which must have one (asserted). Where media hide it
/// only few passes sample its light: Russian roulette by u in [0,1).
[[nodiscard]] SurfaceDomain make_surface_domain(const FrameDomain& frame, const PixelDomain& domain,
                                                float u);

/// What sample y brings to the camera-side radiance of the surface, shadow apart; f is black where
/// it brings nothing. density is not set.
[[nodiscard]] Candidate evaluate(const FrameDomain& frame, const SurfaceDomain& domain,
                                 const PathSample& y);

/// The same of light that arrives at the surface's point, for those who know it already. Fills x,
/// arrival and f of c (f is black where nothing is scattered); returns the density [1/sr] with
/// which the BSDF's own sampling draws the direction.
float light_surface(const SurfaceDomain& domain, const Arrival& arrival, Candidate& c);

/// Draws params.surface.light_candidates lamps (fewer where there are few) with a point each, every
/// distant light, and params.surface.bsdf_candidates directions from the BSDF, which meet what they
/// meet; with an environment environment_rays of those, and half as many from its image; all
/// weighted against each other by the balance heuristic. Candidates that bring nothing are left
/// out. Their `known` is what the caches know of shadows. Appends to `out`.
void draw_surface_candidates(const FrameDomain& frame, const SurfaceDomain& domain, Rng& rng,
                             std::vector<Candidate>& out);

}  // namespace mote
