#pragma once

#include <span>
#include <vector>

#include "restir/candidates.h"
#include "restir/light_rays.h"
#include "restir/pass_state.h"
#include "restir/reuse_mis.h"
#include "restir/shift.h"
#include "restir/surface_domain.h"

namespace mote {

/// How a tile's reservoirs are combined.
struct CombineRules {
    ShiftKind shift = ShiftKind::RandomNumbers;
    MisForm mis = MisForm::Pairwise;
    TargetVisibility visibility = TargetVisibility::Exact;
};

/// A pixel's own reservoir from its candidates: streaming RIS with known * luminance(f) as target.
/// `color` becomes the sum over all candidates: their light, if f is complete, shadows included.
[[nodiscard]] PixelReservoir resample(std::span<const Candidate> candidates, Rng& rng,
                                      Spectrum& color);

/// Combines each pixel's own reservoir with others, for all pixels of a tile together, so that the
/// shadow rays of all evaluations are traced in one go:
///   1. begin_pixel, then add_other for each reservoir to reuse: shifts the other's sample here and
///      the own sample there, and asks for their shadow rays;
///   2. trace (targets that know of shadows by caches only ask for none);
///   3. finish each pixel: weights, choice, and the sum of all inputs' contributions.
/// Targets are luminances of exact contributions, shadows included, each in the domain it is
/// evaluated in: what another pixel or the pass before could have drawn decides its weight. Nothing
/// about an input's sample decides whether it takes part.
class Combination {
  public:
    explicit Combination(const CombineRules& rules) : rules_(rules) {}

    void clear();

    /// Starts a pixel; its number is the return value. `own` stays where it is until finish.
    int begin_pixel(const PixelReservoir& own);

    /// Lets the pixel started last combine with `other`, whose confidence is `confidence`.
    /// `map` leads from the other's ray to the own; ends must be valid during this call only.
    void add_other(const ShiftEnd& own, const ShiftEnd& from, const Reservoir& other,
                   float confidence, const RayMap& map);
    /// The same on surfaces, which take samples as they are.
    void add_other(const SurfaceEnd& own, const SurfaceEnd& from, const Reservoir& other,
                   float confidence);

    /// Traces the shadow rays: `here` is the scene of the pixels' own domains, `there` that of the
    /// others' (the same for neighbours).
    void trace(const Scene& here, const Scene& there, WalkCounts& counts);

    /// Result of one pixel. `color` becomes the estimate of its light: all inputs shaded with their
    /// MIS weights, which has the mean of shading the chosen sample and less noise, at no cost. The
    /// result's f is that of the chosen sample.
    [[nodiscard]] PixelReservoir finish(int pixel, Rng& rng, Spectrum& color) const;

  private:
    struct Other {
        PathSample y;           ///< here
        Spectrum f{0.0f};       ///< of y here, shadows apart
        float shadow = 0.0f;    ///< transmittance of y's shadow ray here
        float jacobian = 0.0f;  ///< of the shift here; 0: undefined
        float p_hat_there = 0.0f;
        float W = 0.0f;
        float M = 0.0f;
        float age = 0.0f;
        float own_there = 0.0f;  ///< target of the own sample there, Jacobian and shadows included
    };
    struct Pixel {
        const PixelReservoir* own = nullptr;
        size_t first = 0;
        size_t count = 0;
    };

    /// A sample in a domain that it was shifted to.
    struct Shifted {
        Candidate c;
        float jacobian = 1.0f;
        float time = 0.0f;  ///< of its shadow ray
    };
    void add(const Reservoir& other, float confidence, const std::optional<Shifted>& here,
             const std::optional<Shifted>& own_there);
    [[nodiscard]] std::optional<Shifted> shifted(const PathSample& y, const ShiftEnd& from,
                                                 const ShiftEnd& to, const RayMap& map) const;

    CombineRules rules_;
    std::vector<Pixel> pixels_;
    std::vector<Other> others_;
    LightRays here_;
    LightRays there_;
};

}  // namespace mote
