#pragma once

namespace mote {

/// Which reservoirs a pixel combines with its own.
enum class ReuseMode {
    Auto,      ///< reservoirs are left alone; single passes of a still scene add up
    Off,       ///< none: independent passes
    Temporal,  ///< that of the pixel it came from, one pass ago
    Spatial,   ///< those of neighbours
    Both,
};

/// How a sample travels from one pixel's domain to another's.
enum class ShiftKind {
    RandomNumbers,  ///< keeps the random number of the distance: Jacobian 1, equal supports
    World,          ///< keeps the point, moved by the medium's velocity, projected on the new ray
    Fraction,       ///< keeps the share of the ray's light that is lost before the point
};

/// Weights between the reservoirs that could have made a sample.
enum class ReuseMis {
    Auto,      ///< Balance for one input where nothing moved, Pairwise otherwise
    Pairwise,  ///< defensive pairwise: linear in the inputs, bounded in motion
    Balance,   ///< generalised balance heuristic; between neighbours its cost is quadratic in their
               ///< number, so in media it is Pairwise there
    Constant,  ///< confidence alone; biased where supports differ: for study
    Contribution,  ///< surfaces only: confidence alone, and the chosen sample's weight set right by
                   ///< 1/Z; unbiased, linear, noisier than Pairwise
};

/// Where light scattered twice and more comes from.
enum class IndirectLight {
    Auto,    ///< Shared where that is possible: only the camera moves while the shutter is open
    Paths,   ///< paths of the pixel's own
    Shared,  ///< paths whose later vertices pixels share
    Cached,  ///< walks from the pixel's own first events that correct a coarse cache of radiance
};

/// Which paths of light scattered twice and more a pixel combines with its own.
enum class IndirectReuse {
    Off,       ///< none: see IndirectLight
    Temporal,  ///< those of the pixel it came from, one pass ago
    Spatial,   ///< those of neighbours
    Both,
};

/// What becomes of what lies behind a path's second vertex where media, lights or surfaces have
/// changed since.
enum class IndirectSuffix {
    Traced,           ///< it is traced again, with the same random numbers, then and now: unbiased
    BiasedValidated,  ///< its light is kept; a quarter of the histories are checked by tracing
                      ///< again, and dropped if that disagrees (Ouyang et al. 2021): biased
};

/// What the target function knows about shadows.
enum class TargetVisibility {
    Exact,   ///< closed-form transmittance, a ray per evaluation; nothing left to shade
    Cached,  ///< from the light caches where they know (lights at infinity), else none; the chosen
             ///< sample is shaded exactly
    None,    ///< exact for candidates, ignored in reuse, exact for the chosen sample: biased
};

/// What reuse between surfaces knows about shadows. Rays per pixel and pass with n neighbours and
/// one history, beside those of weights (see ReuseMis).
enum class SurfaceVisibility {
    Exact,     ///< in all targets: 1 + 2 (n + 1) rays
    None,      ///< in none of them; the finally chosen sample is shaded exactly: 1 ray, noisier
    Reused,    ///< tested once for each pixel's own sample, which is dropped if occluded and else
               ///< keeps what it has for good, wherever it goes: 1 ray, biased (Bitterli et al.
               ///< 2020, Wyman and Panteleev 2021)
    Weighted,  ///< in no target; each sample has a visibility, its own by a ray, a neighbour's by a
               ///< ray where it is taken to, history's as it was, averaged by resampling weights:
               ///< 1 + n rays. Biased in time: colours leak, shadows lag in motion; between
               ///< neighbours alone it is not.
};

/// Which of the samples that meet in a surface's reservoir are shaded.
enum class SurfaceShading {
    Auto,    ///< All where that takes no further ray: not by Contribution, nor by visibility None
    Chosen,  ///< the one that is chosen: colours of lamps mix from pass to pass only
    All,     ///< the sum over all of them by their weights, each with its shadow where it is taken
             ///< to; a ray for each by visibility None. Contribution has no such weights.
};

/// Sets of parameters by name; keys that a scene gives besides win.
enum class RestirPreset {
    Default,
    Textbook,  ///< the papers' configuration: cached targets, long history; for comparison
    Preview,   ///< closed forms without corrections: biased by the caches' coarseness
    BiasedNoVisibility,        ///< reuse without shadow rays
    BiasedConstantMis,         ///< 1/M weights on the world-space shift
    BiasedReusedVisibility,    ///< surfaces keep the visibility of where samples were drawn
    BiasedWeightedVisibility,  ///< surfaces average visibilities over time
};

/// Reuse of the reservoir that a pixel had one pass ago.
struct TemporalParams {
    float cap = 0.0f;  ///< most confidence a history may have [passes]; 0: 16 at rest, 1 in motion
    float validation = 4.0f;  ///< history's confidence falls with the change of its optical-depth
                              ///< profile, this strongly; 0: not at all
};

/// Reuse of neighbours' reservoirs.
struct SpatialParams {
    int neighbours = 3;      ///< [0, 16]; two shadow rays each
    float radius_px = 3.0f;  ///< of the disk they are taken from [px]
    bool feedback = false;   ///< the result becomes the next pass's history
};

/// Direct light of the first surface by reservoirs.
struct SurfaceRestirParams {
    int light_candidates = 8;  ///< lamps tried per pixel and pass, [1, 256]
    int bsdf_candidates = 1;   ///< directions tried besides, [1, 64]
    int indirect_paths = 8;    ///< paths of two and more events per pass, [1, 256]
    float cap = 20.0f;         ///< most confidence a history may have [passes]
    int neighbours = 5;        ///< [0, 32]; two shadow rays each
    float radius_px = 10.0f;   ///< of the disk they are taken from [px]
    bool feedback = false;     ///< what neighbours brought becomes history, too
    int boost = 2;  ///< neighbours of pixels without history are this many times as many, [1, 8]
    ReuseMis mis = ReuseMis::Auto;  ///< Auto: RestirParams::mis. Balance costs n (n - 1) rays more
                                    ///< where targets know shadows
    SurfaceVisibility visibility = SurfaceVisibility::Exact;
    SurfaceShading shading = SurfaceShading::Auto;
};

/// How the volumetric ReSTIR estimator samples. Unbiased unless a field says otherwise.
struct RestirParams {
    RestirPreset preset = RestirPreset::Default;
    ReuseMode reuse = ReuseMode::Auto;
    int candidates = 8;           ///< distances and lights tried per pixel and pass, [1, 256]
    bool control_variate = true;  ///< lights at infinity by closed form plus exact corrections;
                                  ///< else they take part in the candidates
    int distant_rays = 0;         ///< corrections per pass and mean pixel towards distant lights;
                                  ///< 0: see distant_rays_of
    int environment_rays = 0;     ///< and into the environment; 0: see environment_rays_of
    IndirectLight indirect = IndirectLight::Auto;
    IndirectReuse indirect_reuse = IndirectReuse::Off;
    IndirectSuffix indirect_suffix = IndirectSuffix::Traced;
    int indirect_paths = 16;      ///< paths of two and more events per pass, first in a medium
    bool indirect_guide = false;  ///< shared paths start where the mean radiance is high
    float node_paths = 1.0f;      ///< previews: paths from nodes per pass and pixel of smoke
    float node_spacing = 0.0f;    ///< previews: [m]; 0: by density and pixel size
    bool corrections = true;      ///< false: the closed form alone, a fast biased preview
    int edge_strata = 4;          ///< camera rays per pass where a pixel sees edges or lamps: this
                                  ///< squared, [1, 16]
    ShiftKind shift = ShiftKind::RandomNumbers;
    ReuseMis mis = ReuseMis::Auto;
    TargetVisibility visibility = TargetVisibility::Exact;
    TemporalParams temporal;
    SpatialParams spatial;
    SurfaceRestirParams surface;
};

/// The parameters that a preset stands for.
[[nodiscard]] inline RestirParams make_restir_params(RestirPreset preset)
{
    RestirParams p;
    p.preset = preset;
    switch (preset) {
        case RestirPreset::Default:
            break;
        case RestirPreset::Textbook:
            p.reuse = ReuseMode::Both;
            p.candidates = 4;
            p.control_variate = false;
            p.shift = ShiftKind::World;
            p.visibility = TargetVisibility::Cached;
            p.temporal = {20.0f, 0.0f};
            p.spatial = {5, 10.0f, true};
            break;
        case RestirPreset::Preview:
            p.corrections = false;
            break;
        case RestirPreset::BiasedNoVisibility:
            p.reuse = ReuseMode::Both;
            p.candidates = 4;
            p.visibility = TargetVisibility::None;
            break;
        case RestirPreset::BiasedConstantMis:
            p.reuse = ReuseMode::Both;
            p.candidates = 4;
            p.shift = ShiftKind::World;
            p.mis = ReuseMis::Constant;
            break;
        case RestirPreset::BiasedReusedVisibility:
            p.reuse = ReuseMode::Both;
            p.surface.visibility = SurfaceVisibility::Reused;
            break;
        case RestirPreset::BiasedWeightedVisibility:
            p.reuse = ReuseMode::Both;
            p.surface.visibility = SurfaceVisibility::Weighted;
            break;
    }
    return p;
}

/// Exact corrections per pass where the scene leaves it open.
[[nodiscard]] inline int distant_rays_of(const RestirParams& p)
{
    return p.distant_rays > 0 ? p.distant_rays : 2;
}
[[nodiscard]] inline int environment_rays_of(const RestirParams& p)
{
    return p.environment_rays > 0 ? p.environment_rays : 8;
}

/// Weights between surfaces' reservoirs.
[[nodiscard]] inline ReuseMis surface_mis(const RestirParams& p)
{
    return p.surface.mis == ReuseMis::Auto ? p.mis : p.surface.mis;
}

/// Whether surfaces shade all samples that they combine.
[[nodiscard]] inline bool shades_all(const RestirParams& p)
{
    if (surface_mis(p) == ReuseMis::Contribution) return false;
    if (p.surface.shading != SurfaceShading::Auto) return p.surface.shading == SurfaceShading::All;
    return p.surface.visibility != SurfaceVisibility::None;
}

/// Whether surfaces that reuse samples have the right mean. README has the table.
[[nodiscard]] inline bool is_surface_reuse_unbiased(const RestirParams& p)
{
    const ReuseMis mis = surface_mis(p);
    switch (p.surface.visibility) {
        case SurfaceVisibility::Exact:
        case SurfaceVisibility::None:
            return mis != ReuseMis::Constant;
        case SurfaceVisibility::Reused:
            return false;
        case SurfaceVisibility::Weighted:
            return p.reuse == ReuseMode::Spatial && mis != ReuseMis::Constant &&
                   mis != ReuseMis::Contribution;
    }
    return false;
}

/// Whether paths of many events of the frame before take part.
[[nodiscard]] inline bool reuses_paths_in_time(const RestirParams& p)
{
    return p.indirect_reuse == IndirectReuse::Temporal || p.indirect_reuse == IndirectReuse::Both;
}

/// Whether images of these parameters have the right mean; the others are known to be biased.
[[nodiscard]] inline bool is_unbiased(const RestirParams& p)
{
    const bool reuses = p.reuse == ReuseMode::Temporal || p.reuse == ReuseMode::Spatial ||
                        p.reuse == ReuseMode::Both;
    const bool reuse_is_right =
        p.visibility != TargetVisibility::None && p.mis != ReuseMis::Constant;
    // `auto` may reuse surfaces' samples.
    const bool surfaces_are_right = p.reuse == ReuseMode::Off || is_surface_reuse_unbiased(p);
    const bool paths_are_right =
        p.indirect_reuse == IndirectReuse::Off ||
        (p.mis != ReuseMis::Constant &&
         (!reuses_paths_in_time(p) || p.indirect_suffix == IndirectSuffix::Traced));
    return p.corrections && (!reuses || reuse_is_right) && surfaces_are_right && paths_are_right;
}

}  // namespace mote
