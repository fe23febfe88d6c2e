#pragma once

#include "reference/path_tracer.h"
#include "support/media.h"
#include "support/trials.h"

namespace mote::test {

/// Statistics of luminance(L) over `count` paths along one ray.
inline RunningStats trace(const Scene& scene, const PathTracerParams& params, const Ray& ray,
                          uint32_t count, uint32_t seed)
{
    const LightSampler lights = build_light_sampler(scene, params);
    return run_trials(count, seed, [&](Rng& rng) {
        return luminance(trace_path(scene, lights, params, ray, rng).L());
    });
}

/// Distance between two independent estimates in standard errors.
inline double z_score(const RunningStats& a, const RunningStats& b)
{
    return std::abs(a.mean - b.mean) /
           std::max(1e-30, std::sqrt(a.variance_of_mean() + b.variance_of_mean()));
}

inline double z_score(const RunningStats& a, double exact)
{
    return std::abs(a.mean - exact) / std::max(1e-30, a.standard_error());
}

}  // namespace mote::test
