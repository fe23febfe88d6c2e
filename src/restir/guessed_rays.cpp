#include "restir/guessed_rays.h"

#include <algorithm>
#include <cmath>

namespace mote {
namespace {

/// Depth at which guesses end: what they miss is for corrections to find.
constexpr float deepest_guess = 8.0f;

}  // namespace

void GuessedRays::clear()
{
    guesses.clear();
    numbers.clear();
}

void GuessedRays::add(int owner, Vec3 x, Vec3 wi, float time, Spectrum weight, float tau_max,
                      float number)
{
    guesses.add(owner, x, wi, infinity, time, weight, tau_max);
    numbers.resize(guesses.size(), number);
}

void GuessedRays::trace(const Scene& scene, const LightGuess& guess, WalkCounts& coarse_counts,
                        WalkCounts& counts)
{
    std::vector<float> tau_max(size());
    for (size_t i = 0; i < size(); ++i) {
        tau_max[i] = guesses.queries[i].tau_max;
        guesses.queries[i].tau_max = std::min(tau_max[i], deepest_guess);
    }
    guesses.guess(scene.surfaces.get(), guess.media, coarse_counts);
    corrections.clear();
    values.resize(size());
    // Systematic sampling: the chances of an owner's rays are laid end to end, and those that hold
    // one of the marks number + 0, 1, 2, ... are chosen. So owners have about equally many.
    float place = 0.0f;
    for (size_t i = 0; i < size(); ++i) {
        const float tau = guesses.depths[i];
        values[i] = guesses.value(i);
        if (i == 0 || guesses.owners[i] != guesses.owners[i - 1]) place = numbers[i];
        if (!(tau < infinity)) continue;  // a surface is in the way
        const float chance = correction_chance(guess.slope, tau);
        const float before = place;
        place += chance;
        if (std::floor(place) == std::floor(before)) continue;
        const DepthQuery& q = guesses.queries[i];
        corrections.add(static_cast<int>(i), q.o, q.d, q.t1, q.time, guesses.weights[i] / chance,
                        tau_max[i]);
    }
    corrections.trace(nullptr, scene.media, counts);
    for (size_t j = 0; j < corrections.size(); ++j) {
        const auto i = static_cast<size_t>(corrections.owners[j]);
        const float guessed = std::exp(-guesses.depths[i]);
        values[i] += corrections.value(j) - corrections.weights[j] * guessed;
    }
}

}  // namespace mote
