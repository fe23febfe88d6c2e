#pragma once

#include "restir/light_guess.h"
#include "restir/light_rays.h"

namespace mote {

/// Rays towards lights on two levels: all of them through coarse media, which guess their
/// transmittance T_c, and few of them, each with a chance q of its own, also through the media
/// themselves. A ray brings
///     weight (T_c + (T - T_c) / q)  if it is chosen,  weight T_c  if not:
/// weight T in the mean, whatever the coarse media are. q follows the error that the guess may
/// have, so what is known to be dark or clear is hardly ever walked again.
/// Multilevel Monte Carlo, Giles 2008, with the levels chosen by roulette.
struct GuessedRays {
    LightRays guesses;
    LightRays corrections;         ///< their owners are guesses
    std::vector<float> numbers;    ///< of each guess: its owner's number
    std::vector<Spectrum> values;  ///< what each guess brings; filled by trace

    void clear();
    /// A ray as in LightRays. All rays of an owner follow each other and bring the same `number` in
    /// [0,1), uniform and independent of the rays; it chooses among them.
    void add(int owner, Vec3 x, Vec3 wi, float time, Spectrum weight, float tau_max, float number);
    /// `guess`: about the scene's media, or anything: then only noise grows. Surfaces are asked
    /// once. Cost: of a coarse ray each, and about one exact ray for five of them.
    void trace(const Scene& scene, const LightGuess& guess, WalkCounts& coarse_counts,
               WalkCounts& counts);
    [[nodiscard]] size_t size() const { return guesses.size(); }
};

}  // namespace mote
