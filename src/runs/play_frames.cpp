#include "runs/play_frames.h"

#include "core/error.h"
#include "render/restir_frame.h"

namespace mote {

void play_frames(const FramePlan& plan, bool keeps_history, const RenderDescription& render,
                 const OutputDescription& output, StopRequested stop, PlanCaches* caches,
                 const FramePlayed& played)
{
    MOTE_ASSERT(!plan.frames.empty());
    if (caches != nullptr) caches->frames.resize(plan.frames.size());
    FrameHistory history;
    const auto count = static_cast<size_t>(frames_rendered(plan, keeps_history));
    for (size_t i = plan.frames.size() - count; i < plan.frames.size(); ++i) {
        // Frames at rest take over the caches of the one before.
        if (caches != nullptr && caches->frames[i]) history.impl().caches = caches->frames[i];
        FrameStats stats;
        const LayeredImage image =
            render_frame(plan.frames[i], render, output, history, stop, stats);
        if (image.channels.empty()) throw Error(ExitCode::Interrupted, "stopped by a signal");
        if (caches != nullptr) caches->frames[i] = history.impl().caches;
        played(i, image, stats);
    }
}

OutputDescription float_output(std::vector<std::string> aovs)
{
    OutputDescription output;
    output.aovs = std::move(aovs);
    output.color_type = PixelType::Float;
    return output;
}

}  // namespace mote
