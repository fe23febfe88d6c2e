#include "runs/pilot.h"

#include <algorithm>
#include <cmath>

#include "runs/pixel_stats.h"
#include "runs/run_error.h"
#include "runs/trimmed_mean.h"

namespace mote {

namespace {

/// Seeds that neither runs nor reference use.
constexpr uint32_t pilot_seed = 0xA0000000u;

constexpr int slowest_row_samples = 4;
constexpr double most_samples = 1e6;

/// Far beyond what two short runs misjudge.
constexpr double hopeless_cost = 3.0;

}  // namespace

Pilot run_pilot(const FramePlan& plan, const Method& method, const RenderDescription& render,
                StopRequested stop)
{
    RenderDescription edited = render;
    method.edit(edited);
    edited.samples = std::max(method.samples_per_frame, 1);
    PixelStats stats;
    Pilot pilot;
    double seconds = 0.0;
    for (uint32_t k = 0; k < 2; ++k) {
        edited.seed = pilot_seed + k;
        const PlayedRun run = play_run(plan, method.keeps_history, edited, stop);
        add_run(stats, run.image);
        pilot.cache_seconds = run.cache_cpu_seconds;
        const double without_caches = run.cpu_seconds - run.cache_cpu_seconds;
        // Others on the machine only ever make it slower.
        seconds = k == 0 ? without_caches : std::min(seconds, without_caches);
    }
    pilot.sample_seconds = std::max(seconds, 1e-9) / edited.samples;
    pilot.sample_variance = trimmed_mean_variance(stats, trimmed_share) * edited.samples;
    return pilot;
}

std::vector<int> equal_time_samples(const std::vector<Method>& methods,
                                    const std::vector<Pilot>& pilots, int samples)
{
    std::vector<double> own_times;
    double slowest = 0.0;
    for (size_t i = 0; i < methods.size(); ++i) {
        slowest = std::max(slowest, pilots[i].sample_seconds);
        if (methods[i].samples_per_frame == 0) continue;
        own_times.push_back(methods[i].samples_per_frame * pilots[i].sample_seconds);
    }
    const double target = own_times.empty() ? slowest_row_samples * slowest : median(own_times);
    std::vector<int> result;
    for (size_t i = 0; i < methods.size(); ++i) {
        const double matched = std::round(target / pilots[i].sample_seconds);
        const int equal_time = static_cast<int>(std::clamp(matched, 1.0, most_samples));
        const int own = methods[i].samples_per_frame;
        result.push_back(own > 0 ? own : (samples > 0 ? samples : equal_time));
    }
    return result;
}

std::vector<bool> worth_measuring(const std::vector<Method>& methods,
                                  const std::vector<Pilot>& pilots)
{
    std::vector<bool> worth(methods.size(), true);
    const int best = best_reference_row(methods, pilots);
    if (best < 0) return worth;
    const double limit = hopeless_cost * pilots[static_cast<size_t>(best)].cost();
    for (size_t i = 0; i < methods.size(); ++i) {
        worth[i] = !methods[i].is_reference || !(pilots[i].cost() > limit);
    }
    return worth;
}

int best_reference_row(const std::vector<Method>& methods, const std::vector<Pilot>& pilots)
{
    int best = -1;
    double least = 0.0;
    for (size_t i = 0; i < methods.size(); ++i) {
        if (!methods[i].is_reference) continue;
        if (best >= 0 && !(pilots[i].cost() < least)) continue;
        best = static_cast<int>(i);
        least = pilots[i].cost();
    }
    return best;
}

}  // namespace mote
