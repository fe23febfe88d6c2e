#include "scene/fields.h"

namespace mote {
namespace {

constexpr std::array reuse_names = {"auto", "off", "temporal", "spatial", "both"};
constexpr std::array shift_names = {"random_numbers", "world", "fraction"};
constexpr std::array mis_names = {"auto", "pairwise", "balance", "constant"};
constexpr std::array surface_mis_names = {"auto", "pairwise", "balance", "constant",
                                          "contribution"};
constexpr std::array surface_visibility_names = {"exact", "none", "reused", "weighted"};
constexpr std::array surface_shading_names = {"auto", "chosen", "all"};
constexpr std::array visibility_names = {"exact", "cached", "none"};
constexpr std::array indirect_names = {"auto", "paths", "shared", "cached"};
constexpr std::array indirect_reuse_names = {"off", "temporal", "spatial", "both"};
constexpr std::array indirect_suffix_names = {"traced", "biased-validated"};
constexpr std::array preset_names = {"default",
                                     "textbook",
                                     "preview",
                                     "biased-no-visibility",
                                     "biased-constant-mis",
                                     "biased-reused-visibility",
                                     "biased-weighted-visibility"};

}  // namespace

void describe(FieldVisitor& v, RestirParams& restir)
{
    visit_choice(
        v,
        {.key = "preset",
         .doc = "Sets the keys below, those given besides win: textbook is the papers' "
                "configuration, for comparison; preview leaves out exact corrections; "
                "biased-no-visibility reuses without shadow rays, biased-constant-mis with "
                "1/M weights, biased-reused-visibility and biased-weighted-visibility with "
                "surfaces' shadows as kept from before"},
        restir.preset, preset_names);
    if (v.assigns()) restir = make_restir_params(restir.preset);
    visit_choice(
        v,
        {.key = "reuse",
         .doc = "Reservoirs that a pixel combines with its own; auto: none (measured best), "
                "but frames of one pass each of a scene at rest are means of all passes so "
                "far"},
        restir.reuse, reuse_names);
    visit(v,
          {.key = "candidates",
           .doc = "Distances and lights tried per pixel and pass, for lamps and glowing media; one "
                  "exact shadow ray each",
           .range = between(1, 256)},
          restir.candidates);
    visit(
        v,
        {.key = "control_variate",
         .doc = "Distant lights and the environment by closed form plus exact corrections; false: "
                "they take part in the candidates"},
        restir.control_variate);
    visit(v,
          {.key = "distant_rays",
           .doc = "Exact corrections per pixel and pass towards distant lights, where these are as "
                  "bright as in the mean pixel; 0: 2",
           .range = between(0, 64)},
          restir.distant_rays);
    visit(v,
          {.key = "environment_rays",
           .doc = "Corrections per pixel and pass into the environment, likewise, through coarser "
                  "media where these are good guesses, few of which are corrected exactly; 0: 8",
           .range = between(0, 64)},
          restir.environment_rays);
    visit(v,
          {.key = "indirect_paths",
           .doc =
               "Paths per pixel and pass for light scattered twice and more, first in a medium, if "
               "`bounces` allows",
           .range = between(1, 256)},
          restir.indirect_paths);
    visit_choice(
        v,
        {.key = "indirect",
         .doc =
             "Light scattered twice and more in media: by paths of each pixel's own, or by paths "
             "from which pixels of a tile share all that is behind the first event; auto: "
             "shared, unless more than the camera moves while the shutter is open. With 8 bounces "
             "and more, and no small lamps, a fiftieth of the paths (and the frames before, where "
             "`reuse` takes from them) tell the mean radiance beforehand, which takes noise from "
             "those that are shared. cached, for study: walks that correct a coarse cache of "
             "radiance, made anew each frame for a tenth of the paths; unbiased whatever it says. "
             "Measured against the path tracer per CPU time: 0.76 (plume of g 0.3) and 1.0 times "
             "(1000 lamps) as good, where shared is 2.2 and 4.8"},
        restir.indirect, indirect_names);
    visit(v,
          {.key = "indirect_guide",
           .doc = "Where paths are shared: draw their first events not in proportion to what "
                  "collides along the ray, but to that times the mean radiance known beforehand. "
                  "Unbiased whatever is known; takes a fiftieth of the paths where the mean is not "
                  "known anyway (see `indirect`). For study: measured variance times time is 0.9 "
                  "(1000 lamps) to 1.2 times (plume, dense cloud) that without"},
          restir.indirect_guide);
    visit_choice(
        v,
        {.key = "indirect_reuse",
         .doc =
             "Reservoirs of paths of two and more events in media that a pixel combines with its "
             "own, instead of sharing paths; `shift`, `mis`, `temporal` and `spatial` hold for "
             "them, too. Unbiased; 500 bytes per pixel of smoke for history, and a walk per "
             "reservoir where lobes are narrow or media change. Measured, temporal against "
             "shared paths per CPU time: 0.5 (1000 lamps), 1.4 (smoke of g 0.3) and 3.9 times "
             "(dense, g 0.85) as good after 5 to 8 frames at rest, which add up anyway if "
             "`reuse` is auto; 0.1 to 0.6 times in motion. off wherever more than the camera "
             "moves while the shutter is open"},
        restir.indirect_reuse, indirect_reuse_names);
    visit_choice(
        v,
        {.key = "indirect_suffix",
         .doc = "What history has found behind a path's second event, where media, lights or "
                "surfaces have changed: traced again, then and now; or biased-validated: kept, but "
                "dropped where one in four is traced again and disagrees (biased: lags)"},
        restir.indirect_suffix, indirect_suffix_names);
    visit(v,
          {.key = "node_paths",
           .doc =
               "Of previews (`corrections` false): paths from nodes, per pass and pixel that smoke "
               "fills",
           .range = between(0.01, 1000)},
          restir.node_paths);
    visit(v,
          {.key = "node_spacing",
           .doc = "Of previews, between nodes; 0: by the smoke's density and the size of pixels",
           .unit = "m",
           .range = at_least(0)},
          restir.node_spacing);
    visit(v,
          {.key = "corrections",
           .doc = "false: distant lights and the environment by closed form alone, without noise "
                  "and fast, but biased by the light caches' coarseness (measured: 1 % on a plume "
                  "of optical depth 8, 10 % at 40, more in smoke of a few voxels)"},
          restir.corrections);
    visit(v,
          {.key = "edge_strata",
           .doc = "Where a pixel sees edges of surfaces or lamps, camera rays per pass: the square "
                  "of this. Rays that look alike share one sample of light. As many look for each "
                  "lamp that is narrow on the film, where it is; 1: neither",
           .range = between(1, 16)},
          restir.edge_strata);
    visit_choice(v,
                 {.key = "shift",
                  .doc = "What a reused sample keeps: its random numbers, its place in the moving "
                         "medium (world), or the share of light lost before it (fraction)"},
                 restir.shift, shift_names);
    visit_choice(
        v,
        {.key = "mis",
         .doc = "Weights between reservoirs; between neighbours in media balance is pairwise; "
                "constant is biased where smoke does not overlap: for study"},
        restir.mis, mis_names);
    visit_choice(
        v,
        {.key = "visibility",
         .doc = "Shadows in the target function: exact rays; cached: what the light caches "
                "know, with an exact ray for the chosen sample; none: no shadow rays in "
                "reuse, biased"},
        restir.visibility, visibility_names);
    visit_table(v, {.key = "temporal", .doc = "Reuse of the pass before"}, restir.temporal);
    visit_table(v, {.key = "spatial", .doc = "Reuse of neighbours"}, restir.spatial);
    visit_table(v, {.key = "surface", .doc = "Direct light of the first surface"}, restir.surface);
}

void describe(FieldVisitor& v, SurfaceRestirParams& surface)
{
    visit(
        v,
        {.key = "light_candidates",
         .doc = "Lamps tried per pixel and pass; fewer where the scene has few; one shadow ray for "
                "the chosen one. 4 to 8 gave the least error per time in measurements, where the "
                "literature has 32: cells of lamps propose well, and each costs an evaluation",
         .range = between(1, 256)},
        surface.light_candidates);
    visit(v,
          {.key = "bsdf_candidates",
           .doc = "Directions from the material tried besides",
           .range = between(1, 64)},
          surface.bsdf_candidates);
    visit(v,
          {.key = "indirect_paths",
           .doc = "Paths per pixel and pass for light that surfaces in view pass on from what is "
                  "lit itself, if `bounces` allows",
           .range = between(1, 256)},
          surface.indirect_paths);
    visit(v,
          {.key = "cap",
           .doc = "Most confidence that history may have",
           .unit = "passes",
           .range = between(0, 10'000)},
          surface.cap);
    visit(v,
          {.key = "neighbours",
           .doc = "Reservoirs taken from around; two shadow rays each",
           .range = between(0, 32)},
          surface.neighbours);
    visit(v,
          {.key = "radius",
           .doc = "Of the disk they are taken from",
           .unit = "pixels",
           .range = between(0.5, 256)},
          surface.radius_px);
    visit(v, {.key = "feedback", .doc = "What neighbours brought becomes history, too"},
          surface.feedback);
    visit(v,
          {.key = "boost",
           .doc = "Pixels without history take this many times as many neighbours",
           .range = between(1, 8)},
          surface.boost);
    visit_choice(
        v,
        {.key = "mis",
         .doc = "Weights between surfaces' reservoirs; auto: those of `mis` above; balance takes "
                "n (n - 1) shadow rays more for n neighbours; contribution (1/Z) is linear as "
                "pairwise is, and noisier; constant (1/M) is biased at shadows and edges: for "
                "study"},
        surface.mis, surface_mis_names);
    visit_choice(
        v,
        {.key = "visibility",
         .doc =
             "Shadows in reuse between surfaces: exact, two rays per reservoir (full rays, smoke "
             "included, not coarse guesses: what is seen then needs no further ray, and weights "
             "are right at the edges of shadows); none, one ray "
             "for the chosen sample, noisier; reused, one ray where a sample is drawn, kept "
             "for good: biased, darker beside shadows and lit inside; weighted, one ray per "
             "neighbour, averaged with what history had: biased in time, colours leak and "
             "moving shadows lag"},
        surface.visibility, surface_visibility_names);
    visit_choice(
        v,
        {.key = "shading",
         .doc = "Samples that are shaded of those which reuse brings together: the chosen one, or "
                "all by their weights, which has less noise, of colour above all; auto: all where "
                "their shadows are known, chosen where `visibility` is none (all takes a ray for "
                "each there) or `mis` is contribution (which has weights for the chosen one "
                "only). Unbiased either way"},
        surface.shading, surface_shading_names);
}

void describe(FieldVisitor& v, TemporalParams& temporal)
{
    visit(v,
          {.key = "cap",
           .doc = "Most confidence that history may have; 0: 16 at rest, 1 in motion",
           .unit = "passes",
           .range = between(0, 10'000)},
          temporal.cap);
    visit(v,
          {.key = "validation",
           .doc = "How strongly history loses confidence where the smoke along the ray has "
                  "changed; 0: not at all",
           .range = between(0, 1000)},
          temporal.validation);
}

void describe(FieldVisitor& v, SpatialParams& spatial)
{
    visit(v,
          {.key = "neighbours",
           .doc = "Reservoirs taken from around; two shadow rays each",
           .range = between(0, 16)},
          spatial.neighbours);
    visit(v,
          {.key = "radius",
           .doc = "Of the disk they are taken from",
           .unit = "pixels",
           .range = between(0.5, 256)},
          spatial.radius_px);
    visit(v, {.key = "feedback", .doc = "The result becomes history"}, spatial.feedback);
}

}  // namespace mote
