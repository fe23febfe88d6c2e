#include "bench/play_run.h"

#include "bench/pixel_stats.h"
#include "core/error.h"
#include "image/color_of.h"

namespace mote {

namespace {

OutputDescription float_colors()
{
    OutputDescription output;
    output.color_type = PixelType::Float;
    return output;
}

}  // namespace

PlayedRun play_run(const FramePlan& plan, bool keeps_history, const RenderDescription& render,
                   StopRequested stop)
{
    MOTE_ASSERT(!plan.frames.empty());
    const OutputDescription output = float_colors();
    const size_t first = keeps_history ? 0 : plan.frames.size() - 1;
    FrameHistory history;
    PlayedRun run;
    double all_caches = 0.0;
    for (size_t i = first; i < plan.frames.size(); ++i) {
        FrameStats stats;
        const LayeredImage image =
            render_frame(plan.frames[i], render, output, history, stop, stats);
        if (image.channels.empty()) throw Error(ExitCode::Interrupted, "stopped by a signal");
        run.image = color_of(image);
        run.non_finite += stats.dropped_non_finite + replace_non_finite(run.image);
        run.cpu_seconds = stats.render_cpu_seconds - stats.cache_cpu_seconds;
        run.wall_seconds = stats.render_seconds;
        all_caches += stats.cache_cpu_seconds;
    }
    run.cache_cpu_seconds = all_caches / static_cast<double>(plan.frames.size() - first);
    run.cpu_seconds += run.cache_cpu_seconds;
    return run;
}

}  // namespace mote
