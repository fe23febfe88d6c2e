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
    const auto played = [&](size_t, const LayeredImage& image, const FrameStats& stats) {
        run.image = color_of(image);
        run.non_finite += stats.dropped_non_finite + replace_non_finite(run.image);
        run.cpu_seconds = stats.render_cpu_seconds - stats.cache_cpu_seconds;
        run.wall_seconds = stats.render_seconds;
        all_caches += stats.cache_cpu_seconds;
        ++frame_count;
    };
    play_frames(plan, keeps_history, render, float_output(), stop, nullptr, played);
    run.cache_cpu_seconds = all_caches / frame_count;
    run.cpu_seconds += run.cache_cpu_seconds;
    return run;
}

}  // namespace mote
