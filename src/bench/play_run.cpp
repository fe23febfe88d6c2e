#include "bench/play_run.h"

#include "bench/pixel_stats.h"
#include "core/error.h"

namespace mote {

namespace {

Buffer2D<Spectrum> color_of(const LayeredImage& image)
{
    Buffer2D<Spectrum> color(image.width, image.height);
    const Channel* channels[] = {image.find("R"), image.find("G"), image.find("B")};
    for (int c = 0; c < 3; ++c) {
        const float* from = channels[c]->data.data();
        for (Spectrum& pixel : color) pixel[c] = *from++;
    }
    return color;
}

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
    const auto measured = static_cast<size_t>(plan.measured);
    MOTE_ASSERT(measured >= 1 && measured <= plan.frames.size());
    const size_t first_measured = plan.frames.size() - measured;
    const OutputDescription output = float_colors();
    PlayedRun run;
    FrameHistory history;
    double all_caches = 0.0;
    size_t rendered = 0;
    for (size_t i = keeps_history ? 0 : first_measured; i < plan.frames.size(); ++i, ++rendered) {
        FrameStats stats;
        const LayeredImage image = render_frame(plan.frames[i], render, output, history, stop, stats);
        if (image.channels.empty()) throw Error(ExitCode::Interrupted, "stopped by a signal");
        const double cache = stats.cache_cpu_seconds;
        all_caches += cache;
        run.non_finite += stats.dropped_non_finite;
        if (i < first_measured) continue;
        Buffer2D<Spectrum> color = color_of(image);
        run.non_finite += replace_non_finite(color);
        if (i == first_measured) run.image = Buffer2D<Spectrum>(color.width(), color.height());
        const float weight = 1.0f / static_cast<float>(measured);
        for (size_t p = 0; p < color.size(); ++p) run.image.data()[p] += weight * color.data()[p];
        run.cpu_seconds += stats.render_cpu_seconds - cache;
        run.wall_seconds += stats.render_seconds;
    }
    const double share = static_cast<double>(measured) / static_cast<double>(rendered);
    run.cache_cpu_seconds = all_caches * share;
    run.cpu_seconds += run.cache_cpu_seconds;
    return run;
}

}  // namespace mote
