#include "runs/play_run.h"

#include "image/color_of.h"
#include "runs/pixel_stats.h"
#include "runs/play_frames.h"

namespace mote {

PlayedRun play_run(const FramePlan& plan, bool keeps_history, const RenderDescription& render,
                   StopRequested stop)
{
    PlayedRun run;
    double all_caches = 0.0;
    int frame_count = 0;
    const auto compared = static_cast<size_t>(plan.compared);
    const size_t first_compared = plan.frames.size() - compared;
    const float share = 1.0f / static_cast<float>(compared);
    const auto played = [&](size_t index, const LayeredImage& layers, const FrameStats& stats) {
        all_caches += stats.cache_cpu_seconds;
        ++frame_count;
        run.non_finite += stats.dropped_non_finite;
        if (index < first_compared) return;
        Buffer2D<Spectrum> image = color_of(layers);
        run.non_finite += replace_non_finite(image);
        if (index == first_compared) {
            run.image = Buffer2D<Spectrum>(image.width(), image.height(), Spectrum(0.0f));
        }
        for (size_t i = 0; i < image.size(); ++i) run.image.data()[i] += share * image.data()[i];
        run.cpu_seconds += stats.render_cpu_seconds - stats.cache_cpu_seconds;
        run.wall_seconds += stats.render_seconds;
        run.work.add(work_of(stats));
        run.memory = memory_of(stats);
    };
    play_frames(plan, keeps_history, render, float_output(), stop, nullptr, played);
    run.cache_cpu_seconds = all_caches * plan.compared / frame_count;
    run.cpu_seconds += run.cache_cpu_seconds;
    return run;
}

}  // namespace mote
