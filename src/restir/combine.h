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
    /// For targets without shadows: the others' samples get a shadow ray each where they arrive,
    /// which becomes their V; else they keep the V that they bring.
    bool traces_V = false;
    /// The result's V is the mean over all inputs by their resampling weights (weighted importance
    /// sampling), else that of the chosen sample.
    bool averages_V = false;
    /// Light is that of all inputs, else that of the chosen sample.
    bool shades_all = true;
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
///   3. where chooses_first: choose for each pixel, then trace_chosen;
///   4. finish each pixel: weights, choice, and the sum of all inputs' contributions.
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
    /// The same on surfaces, which take samples as they are. Ends must be valid until all pixels
    /// are finished. Balance of more than one other input exists here only, as does Contribution.
    void add_other(const SurfaceEnd& own, const SurfaceEnd& from, const Reservoir& other,
                   float confidence);

    /// Traces the shadow rays: `here` is the scene of the pixels' own domains, `there` that of the
    /// others' (the same for neighbours).
    void trace(const Scene& here, const Scene& there, WalkCounts& counts);

    /// Whether weights depend on the choice (Contribution): `choose` comes before `finish` then,
    /// for every pixel in order, and trace_chosen between them.
    [[nodiscard]] bool chooses_first() const { return rules_.mis == MisForm::Contribution; }
    void choose(Rng& rng);
    void trace_chosen(const Scene& there, WalkCounts& counts);

    /// Result of one pixel. `color` becomes the estimate of its light: all inputs shaded with their
    /// MIS weights, which has the mean of shading the chosen sample and less noise, at no cost (by
    /// Contribution, and without shades_all, the chosen sample alone). The result's f is that of
    /// the chosen sample. `rng` is not asked again for what has been chosen.
    [[nodiscard]] PixelReservoir finish(int pixel, Rng& rng, Spectrum& color) const;

  private:
    struct Other {
        PathSample y;           ///< here
        Spectrum f{0.0f};       ///< of y here, shadows apart
        float shadow = 0.0f;    ///< what the target knows of y's shadow here
        float V = 1.0f;         ///< and what it leaves out
        float jacobian = 0.0f;  ///< of the shift here; 0: undefined
        float p_hat_there = 0.0f;
        float W = 0.0f;
        float M = 0.0f;
        float age = 0.0f;
        float own_there = 0.0f;  ///< target of the own sample there, Jacobian and shadows included

        /// y's target here.
        [[nodiscard]] float p_hat() const { return luminance(shadow * f); }
        /// The other's own target at y, pulled back: known without another evaluation.
        [[nodiscard]] float pulled_back() const { return p_hat_there / jacobian; }
    };
    /// Where another's samples live, and the frame that the pixel's own live in.
    struct Site {
        const FrameDomain* own = nullptr;
        const FrameDomain* frame = nullptr;
        const SurfaceDomain* domain = nullptr;
    };
    struct Pixel {
        const PixelReservoir* own = nullptr;
        size_t first = 0;
        size_t count = 0;
        size_t first_cross = 0;  ///< [count x count]: target of other i's sample at other j
    };
    /// A pixel's choice; `which`: the other that brought it, count: its own.
    struct Choice {
        PixelReservoir out;
        Spectrum color{0.0f};
        size_t which = 0;
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
    [[nodiscard]] std::optional<Shifted> taken(const PathSample& y, const FrameDomain& from,
                                               const SurfaceEnd& to) const;
    [[nodiscard]] bool knows_all() const { return rules_.visibility == TargetVisibility::Exact; }

    /// Targets of own-domain samples at others' places: asked for slot by slot, then traced.
    void ask_target(const PathSample& y, size_t other, size_t slot);
    void ask_crosses();
    void trace_targets(const Scene& there, WalkCounts& counts);

    [[nodiscard]] Confidences confidences(const Pixel& pixel) const;
    [[nodiscard]] float own_weight(const Pixel& pixel, const Confidences& c) const;
    [[nodiscard]] float weight_of(const Pixel& pixel, size_t i, const Confidences& c,
                                  float p_hat) const;
    [[nodiscard]] Choice select(const Pixel& pixel, Rng& rng) const;

    CombineRules rules_;
    std::vector<Pixel> pixels_;
    std::vector<Other> others_;
    std::vector<Site> sites_;  ///< of others_, on surfaces
    std::vector<float> targets_;
    std::vector<Choice> chosen_;
    LightRays here_;
    LightRays there_;
    LightRays target_rays_;  ///< owners are slots of targets_
};

}  // namespace mote
