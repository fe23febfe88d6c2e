#include "study/verify_pilots.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "image/color_of.h"
#include "runs/run_error.h"

namespace mote {

namespace {

constexpr double most_samples = 4096.0;
constexpr double few_runs = 100.0;
constexpr int straight_pilot_passes = 16;

/// Of a pixel, by two images, without the share of the pixels where it is largest.
double variance_between(const LayeredImage& a, const LayeredImage& b, double left_out)
{
    PixelStats stats;
    for (const LayeredImage* image : {&a, &b}) {
        Buffer2D<Spectrum> color = color_of(*image);
        replace_non_finite(color);
        add_run(stats, color);
    }
    return trimmed_mean_variance(stats, left_out);
}

/// Samples of the reference's runs that make a difference of means known best in a given time: of
/// var_t + v / s over t + c s, the s of the minimum; but so few that there is time for many runs.
int reference_samples(const ShortRuns& tested, const ShortRuns& reference, double study_seconds)
{
    const double ratio =
        reference.variance * tested.seconds / std::max(tested.variance * reference.seconds, 1e-300);
    double most = most_samples;
    if (study_seconds > 0.0) most = std::min(most, study_seconds / few_runs / reference.seconds);
    return static_cast<int>(std::lround(std::clamp(std::sqrt(ratio), 1.0, std::max(1.0, most))));
}

/// Straight light that the tested runs' frames without events show bit by bit: the last one alone
/// or, if history keeps light of earlier ones, all of them. (Of the reference it is so by
/// definition.)
std::vector<std::string> parts_without_events(VerifySetup& setup, const Pilots& tested)
{
    std::vector<std::string> parts;
    for (const bool plays_frames : {false, true}) {
        setup.straight.plays_frames = plays_frames;
        parts = straight_parts(tested.runs.images[0],
                               straight_run(setup, tested.method, tested.samples, tested.seed),
                               setup.parts);
        if (!parts.empty()) break;
    }
    return parts;
}

}  // namespace

ShortRuns short_runs(const RunSource& source, uint32_t seed)
{
    ShortRuns runs;
    for (uint32_t k = 0; k < 2; ++k) {
        const auto start = std::chrono::steady_clock::now();
        runs.images[k] = source(seed + k);
        runs.seconds = std::max(seconds_since(start), 1e-6);
    }
    runs.variance = variance_between(runs.images[0], runs.images[1], trimmed_share);
    return runs;
}

Pilots::Pilots(VerifySetup& setup, const Method& m, int n, uint32_t s)
    : method(m),
      samples(n),
      seed(s),
      runs(short_runs(source_of(setup, m, n), s)),
      straight(short_runs(
          [&](uint32_t k) { return straight_run(setup, m, straight_pilot_passes, k); }, s))
{
}

double Pilots::rest_variance(const std::vector<std::string>& parts) const
{
    return variance_between(without_parts(runs.images[0], parts),
                            without_parts(runs.images[1], parts), trimmed_share);
}

double Pilots::straight_variance(const std::vector<std::string>& parts) const
{
    return straight_pilot_passes * variance_between(only_parts(straight.images[0], parts),
                                                    only_parts(straight.images[1], parts), 0.0);
}

void choose_parts(VerifySetup& setup, std::initializer_list<const ShortRuns*> all_runs)
{
    std::vector<std::string> parts;
    const auto shows = [](const LayeredImage& image, const std::string& part) {
        return std::any_of(image.channels.begin(), image.channels.end(), [&](const Channel& c) {
            return c.name.rfind(part + ".", 0) == 0 &&
                   std::any_of(c.data.begin(), c.data.end(), [](float v) { return v != 0.0f; });
        });
    };
    for (const std::string& part : part_names()) {
        bool is_seen = false;
        for (const ShortRuns* runs : all_runs) {
            is_seen = is_seen || shows(runs->images[0], part) || shows(runs->images[1], part);
        }
        if (is_seen) parts.push_back(part);
    }
    setup.parts = std::move(parts);
}

int share_out(VerifySetup& setup, Pilots& tested, Pilots& reference)
{
    const std::vector<std::string> parts = parts_without_events(setup, tested);
    // Alike in both but for how evenly their rays fill a pixel; and either may have missed what is
    // rare.
    const double pass_variance =
        std::max(tested.straight_variance(parts), reference.straight_variance(parts));
    const auto variance_of = [&](const Pilots& p) {
        return std::max(p.straight_variance(parts), pass_variance / straight_pilot_passes);
    };
    const int passes = setup.straight.plays_frames
                           ? tested.samples * static_cast<int>(setup.plan.frames.size())
                           : tested.samples;
    const bool is_worth_it = pass_variance / passes > tested.rest_variance(parts);
    if (is_worth_it) {
        for (Pilots* p : {&tested, &reference}) {
            p->runs.variance = p->rest_variance(parts);
        }
    }
    const int samples = reference_samples(tested.runs, reference.runs, setup.params.study.seconds);
    if (!is_worth_it) return samples;
    const double rest = tested.runs.variance + reference.runs.variance / samples;
    const double seconds = tested.runs.seconds + samples * reference.runs.seconds;
    const auto passes_of = [&](const Pilots& p) {
        return best_straight_passes(variance_of(p), p.straight.seconds / straight_pilot_passes,
                                    rest, seconds);
    };
    setup.straight.parts = parts;
    setup.straight.tested_passes = passes_of(tested);
    setup.straight.reference_passes = passes_of(reference);
    return samples;
}

}  // namespace mote
