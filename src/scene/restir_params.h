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
    Balance,   ///< generalised balance heuristic in time; between neighbours, where it would be
               ///< quadratic in their number, as Pairwise
    Constant,  ///< confidence alone; biased where supports differ: for study
};

/// Where light scattered twice and more comes from.
enum class IndirectLight {
    Auto,    ///< Shared, unless volumes or objects move while the shutter is open
    Paths,   ///< paths of the pixel's own
    Shared,  ///< pairs of paths from the pixel's ray and from rays that pixels share
};

/// What the target function knows about shadows.
enum class TargetVisibility {
    Exact,   ///< closed-form transmittance, a ray per evaluation; nothing left to shade
    Cached,  ///< from the light caches where they know (lights at infinity), else none; the chosen
             ///< sample is shaded exactly
    None,    ///< exact for candidates, ignored in reuse, exact for the chosen sample: biased
};

/// Sets of parameters by name; keys that a scene gives besides win.
enum class RestirPreset {
    Default,
    Textbook,  ///< the papers' configuration: cached targets, long history; for comparison
    Preview,   ///< closed forms without corrections: biased by the caches' coarseness
    BiasedNoVisibility,  ///< reuse without shadow rays
    BiasedConstantMis,   ///< 1/M weights on the world-space shift
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
    float cap = 20.0f;         ///< most confidence a history may have [passes]
    int neighbours = 5;        ///< [0, 32]; two shadow rays each
    float radius_px = 10.0f;   ///< of the disk they are taken from [px]
    bool feedback = false;     ///< what neighbours brought becomes history, too
    int boost = 2;  ///< neighbours of pixels without history are this many times as many, [1, 8]
};

/// How the volumetric ReSTIR estimator samples. Unbiased unless a field says otherwise.
struct RestirParams {
    RestirPreset preset = RestirPreset::Default;
    ReuseMode reuse = ReuseMode::Auto;
    int candidates = 8;           ///< distances and lights tried per pixel and pass, [1, 256]
    bool control_variate = true;  ///< lights at infinity by closed form plus exact corrections;
                                  ///< else they take part in the candidates
    int distant_rays = 0;         ///< exact corrections per pass towards distant lights; 0: see
                                  ///< distant_rays_of
    int environment_rays = 0;     ///< and into the environment; 0: see environment_rays_of
    IndirectLight indirect = IndirectLight::Auto;
    int indirect_paths = 4;     ///< paths of two and more events per pass, by the path tracer
    int indirect_pairs = 2;     ///< pairs per pass, where rays are shared
    float node_paths = 1.0f;    ///< previews: paths from nodes per pass and pixel of smoke
    float node_spacing = 0.0f;  ///< previews: [m]; 0: by density and pixel size
    bool corrections = true;    ///< false: the closed form alone, a fast biased preview
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

/// Settles what the scene leaves open by how often light may scatter: next to the noise of light
/// scattered twice and more, that of few corrections is small.
[[nodiscard]] inline RestirParams settle_corrections(RestirParams p, int max_bounces)
{
    if (p.distant_rays == 0) p.distant_rays = max_bounces > 1 ? 1 : distant_rays_of(p);
    if (p.environment_rays == 0) p.environment_rays = max_bounces > 1 ? 2 : environment_rays_of(p);
    return p;
}

/// Whether images of these parameters have the right mean; the others are known to be biased.
[[nodiscard]] inline bool is_unbiased(const RestirParams& p)
{
    const bool reuses = p.reuse == ReuseMode::Temporal || p.reuse == ReuseMode::Spatial ||
                        p.reuse == ReuseMode::Both;
    const bool reuse_is_right =
        p.visibility != TargetVisibility::None && p.mis != ReuseMis::Constant;
    return p.corrections && (!reuses || reuse_is_right);
}

}  // namespace mote
