#pragma once

#include "core/sobol.h"
#include "restir/frame_domain.h"
#include "restir/guessed_rays.h"
#include "volumes/ray_bins.h"

namespace mote {

/// Random numbers of a pixel's pass that the corrections use: pairs of its PassSequence. Pixels of
/// an environment image are chosen by an Rng: 24 bits are too few for them.
struct CorrectionPairs {
    uint32_t distances = 0;
    uint32_t directions = 0;
    uint32_t choices = 0;
    uint32_t guesses = 0;
    uint32_t counts = 0;
};

/// What the caches think is scattered towards the camera, by kind of light.
struct KnownLight {
    Spectrum distant{0.0f};
    Spectrum environment{0.0f};
};

/// Of one ray, in closed form.
[[nodiscard]] KnownLight known_infinite_lights(const FrameDomain& frame, const Ray& ray,
                                               const RayBins& bins);

/// Rays of a tile's pixels towards lights.
struct TileRays {
    LightRays exact;
    GuessedRays guessed;

    void clear()
    {
        exact.clear();
        guessed.clear();
    }
    /// Traces them and calls bring(owner, value) for each.
    template <class Bring>
    void trace(const FrameDomain& frame, WalkCounts& guesses, WalkCounts& counts, Bring&& bring)
    {
        exact.trace(*frame.scene, counts);
        for (size_t i = 0; i < exact.size(); ++i) bring(exact.owners[i], exact.value(i));
        if (guessed.size() == 0) return;
        guessed.trace(*frame.scene, *frame.caches->guess, guesses, counts);
        for (size_t i = 0; i < guessed.size(); ++i) {
            bring(guessed.guesses.owners[i], guessed.values[i]);
        }
    }
};

/// Single scattering of lights at infinity (distant lights and the environment) towards the camera.
/// The caches tell the in-scattered radiance S at the bins' edges; between them it counts as linear
/// in optical depth, which integrates in closed form:
///     sum over bins of  integral T sigma_t [S_k + (S_{k+1} - S_k) (tau - tau_k) / D_k] dt.
/// That is returned. Added to it, as rays in `rays` under `owner` and as their known part in the
/// returned value, are exact corrections: (true minus cached light) at exact free flights. The sum
/// is unbiased whatever the caches say, and noise is what they do not know (the prototype's G2 to
/// G4). Without params.corrections the closed form alone: biased by the caches' coarseness.
[[nodiscard]] Spectrum scatter_infinite_lights(const FrameDomain& frame, const Ray& ray,
                                               const RayBins& bins, const PassSequence& numbers,
                                               const CorrectionPairs& pairs, Rng& rng, int owner,
                                               TileRays& rays);

}  // namespace mote
