#include "bench/bench_rows.h"

namespace mote {

namespace {

RunFigures figures_of(const PlayedRun& run, const PixelStats& reference)
{
    const double scale = 1e6 / static_cast<double>(run.image.size());
    return {measure_error(run.image, reference), scale * run.cpu_seconds,
            scale * run.cache_cpu_seconds, scale * run.wall_seconds};
}

}  // namespace

std::vector<int> curve_factors(const FramePlan& plan)
{
    std::vector<int> factors;
    for (int factor = 1; factor < plan.sample_factor; factor *= 4) factors.push_back(factor);
    factors.push_back(plan.sample_factor);
    return factors;
}

RenderDescription settings_of(const RenderDescription& render, const Method& method, int samples,
                              uint32_t seed)
{
    RenderDescription edited = render;
    method.edit(edited);
    edited.samples = samples;
    edited.seed = seed;
    return edited;
}

RowRuns start_row(const RowInputs& inputs)
{
    RowRuns runs;
    runs.row.name = inputs.method.name;
    runs.row.is_reference = inputs.method.is_reference;
    runs.row.is_biased = inputs.method.is_biased;
    runs.row.samples = inputs.samples * inputs.plan.sample_factor;
    runs.row.compared = inputs.plan.compared;
    runs.row.frames = frames_rendered(inputs.plan, inputs.method.keeps_history);
    runs.shorter.resize(curve_factors(inputs.plan).size() - 1);
    return runs;
}

void add_run(const RowInputs& inputs, uint32_t seed, RowRuns& runs)
{
    const auto play = [&](int samples) {
        PlayedRun run =
            play_run(inputs.plan, inputs.method.keeps_history,
                     settings_of(inputs.render, inputs.method, samples, seed), inputs.stop);
        runs.row.non_finite += run.non_finite;
        return run;
    };
    const std::vector<int> factors = curve_factors(inputs.plan);
    for (size_t i = 0; i < runs.shorter.size(); ++i) {
        runs.shorter[i].push_back(figures_of(play(inputs.samples * factors[i]), inputs.reference));
    }
    const PlayedRun run = play(runs.row.samples);
    runs.row.runs.push_back(figures_of(run, inputs.reference));
    const double samples = double(runs.row.samples) * runs.row.compared;
    runs.row.work.add(run.work, 1.0 / (samples * static_cast<double>(run.image.size())));
    runs.row.memory = run.memory;
    add_run(runs.images, run.image);
}

MethodResult finish_row(const RowInputs& inputs, RowRuns runs)
{
    MethodResult row = std::move(runs.row);
    const std::vector<int> factors = curve_factors(inputs.plan);
    for (size_t i = 0; i < runs.shorter.size(); ++i) {
        row.curve.push_back(curve_point(inputs.samples * factors[i], runs.shorter[i]));
    }
    if (!row.curve.empty()) row.curve.push_back(curve_point(row.samples, row.runs));
    WorkCounts mean;
    mean.add(row.work, 1.0 / static_cast<double>(row.runs.size()));
    row.work = mean;
    row.figures = summarize(row, runs.images, inputs.reference);
    return row;
}

}  // namespace mote
