#include <algorithm>
#include <atomic>
#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "app/commands.h"
#include "app/frame_files.h"
#include "app/frame_range.h"
#include "app/image_metadata.h"
#include "app/memory.h"
#include "app/progress.h"
#include "app/run_stats.h"
#include "app/scene_options.h"
#include "app/signals.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "image/color_of.h"
#include "image/exr.h"
#include "image/png.h"
#include "render/aov.h"
#include "render/frame.h"
#include "scene/inputs.h"
#include "scene/prepare.h"

namespace mote {

namespace {

/// The renderer tells of finished tiles through a plain function.
std::atomic<Progress*> listening_progress{nullptr};

void step_progress()
{
    if (Progress* progress = listening_progress.load(std::memory_order_relaxed)) progress->step();
}

/// A whole run, so that the steps below need no long argument lists.
struct Run {
    const RenderOptions& options;
    const SceneDescription& scene;
    std::vector<FrameFiles> files;
    int threads = 1;
    SceneCache cache;
    FrameHistory history;
    std::vector<FrameRecord> records;
    bool is_warm = false;
};

PrepareNeeds needs_of(const SceneDescription& scene)
{
    const bool shows_motion = parse_aovs(scene.output.aovs).needs_motion();
    const ReuseMode reuse = scene.render.restir.reuse;
    const bool follows_motion = scene.render.estimator == EstimatorKind::Restir &&
                                (reuse == ReuseMode::Temporal || reuse == ReuseMode::Both ||
                                 reuses_paths_in_time(scene.render.restir));
    PrepareNeeds needs;
    needs.velocity = shows_motion || follows_motion;
    needs.velocity_may_be_missing = !shows_motion;  // then reuse is only noisier
    return needs;
}

[[noreturn]] void throw_interrupted(int frame)
{
    throw Error(ExitCode::Interrupted,
                fmt::format("stopped before frame {} was done; the files so far are whole, "
                            "--existing skip goes on from here",
                            frame));
}

void write_preview(const LayeredImage& image, const FrameFiles& files, const Run& run)
{
    if (files.preview.empty()) return;
    write_png(files.preview, color_of(image), run.scene.output.view);
}

/// A kept frame may still lack its preview: another run may not have asked for one.
void restore_preview(const FrameFiles& files, const Run& run)
{
    if (files.preview.empty()) return;
    if (std::FILE* file = std::fopen(files.preview.c_str(), "re")) {
        std::fclose(file);
        return;
    }
    write_preview(read_exr(files.image), files, run);
}

/// Whether the frame's image is there already. Input files count as they are now.
ExistingImage existing_image(const FrameFiles& files, const Run& run)
{
    const SceneDescription& scene = run.scene;
    ExpectedImage expected{scene.render.width, scene.render.height, scene_hash_text(scene), ""};
    if (run.options.existing == ExistingMode::Verify) {
        expected.inputs_hash = inputs_hash(scene, files.frame);
    }
    return check_existing(files.image, run.options.existing, expected);
}

/// Renders the frames before `first` into the history, and nowhere else.
void warm_up(int first, Run& run)
{
    const SceneDescription& scene = run.scene;
    if (run.options.warmup == 0 || !uses_history(scene.render)) return;
    const int start = std::max(first - run.options.warmup, std::min(scene.first_frame, first));
    for (int frame = start; frame < first; ++frame) {
        if (stop_requested()) throw_interrupted(first);
        spdlog::info("frame {} warms up frame {}", frame, first);
        PrepareStats prepared;
        const Scene before = prepare_frame(scene, frame, needs_of(scene), run.cache, prepared);
        FrameStats stats;
        (void)render_frame(before, scene.render, {}, run.history, stop_requested, stats);
    }
}

void render_one(const FrameFiles& files, Run& run, Progress& progress, FrameRecord& record)
{
    const double start = wall_seconds();
    const double cpu_start = cpu_seconds();
    const SceneDescription& scene = run.scene;
    const std::string inputs = inputs_hash(scene, files.frame);  // before they are read
    spdlog::debug("preparing frame {}", files.frame);
    const Scene frame =
        prepare_frame(scene, files.frame, needs_of(scene), run.cache, record.prepare);
    record.prepare_seconds = wall_seconds() - start;
    record.prepare_cpu_seconds = cpu_seconds() - cpu_start;
    if (stop_requested()) throw_interrupted(files.frame);
    require_memory(run.options.memory_limit, scene, record.prepare);

    const int64_t tiles =
        ((scene.render.width + 15) / 16) * int64_t{(scene.render.height + 15) / 16};
    const int64_t steps = progress.steps_of_last_frame();
    progress.begin_frame(files.frame, steps > 0 ? steps : tiles);
    listening_progress = &progress;
    LayeredImage image = render_frame(frame, scene.render, scene.output, run.history,
                                      stop_requested, record.render, step_progress);
    listening_progress = nullptr;
    if (image.channels.empty()) throw_interrupted(files.frame);
    if (record.render.dropped_non_finite > 0) {
        spdlog::warn("frame {}: {} samples were not finite and count as black", files.frame,
                     record.render.dropped_non_finite);
    }
    if (record.render.tracking.majorant_violations > 0) {
        spdlog::warn("frame {}: {} densities were above their majorants: this frame is biased",
                     files.frame, record.render.tracking.majorant_violations);
    }

    const double write_start = wall_seconds();
    add_metadata(image, scene, files.frame, inputs, write_start - start, run.options.reproducible);
    // The image last: it is what marks the frame as done.
    write_preview(image, files, run);
    write_exr(files.image, image, scene.output.compression);
    record.write_seconds = wall_seconds() - write_start;
    record.total_seconds = wall_seconds() - start;
    record.total_cpu_seconds = cpu_seconds() - cpu_start;
    record.peak_memory = peak_memory();
    progress.end_frame(files.image);
    spdlog::info("{} written: prepared in {:.2f} s, rendered in {:.2f} s, written in {:.2f} s",
                 files.image, record.prepare_seconds, record.render.render_seconds,
                 record.write_seconds);
}

void write_stats(const Run& run, bool finished)
{
    if (run.options.stats.empty()) return;
    write_run_stats(run.options.stats, run.scene, run.threads, run.records, finished);
}

void render_all(Run& run, Progress& progress)
{
    for (const FrameFiles& files : run.files) {
        if (stop_requested()) throw_interrupted(files.frame);
        FrameRecord record;
        record.frame = files.frame;
        record.file = files.image;
        // Asked only now: another process may have made the file in the meantime.
        const ExistingImage existing = existing_image(files, run);
        record.skipped = existing.keep;
        record.reason = existing.reason;
        if (existing.keep) {
            restore_preview(files, run);
            spdlog::info("{} kept: {}", files.image, existing.reason);
            progress.skip_frame(files.frame, files.image);
        } else {
            if (!run.is_warm) warm_up(files.frame, run);
            run.is_warm = true;
            if (files.frame == run.files.back().frame) run.history.expect_no_more();
            render_one(files, run, progress, record);
        }
        run.records.push_back(std::move(record));
        write_stats(run, run.records.size() == run.files.size());
    }
}

/// What would be done, on stdout. The first frame is prepared, so that the memory is measured and
/// missing inputs come to light.
void dry_run(Run& run)
{
    const SceneDescription& scene = run.scene;
    fmt::print("{}: {}x{}, {} samples per pixel, {} threads\n", scene.path, scene.render.width,
               scene.render.height, scene.render.samples, run.threads);
    std::vector<int> to_render;
    for (const FrameFiles& files : run.files) {
        const ExistingImage existing = existing_image(files, run);
        fmt::print("frame {:>6}  {}  {}{}  ({})\n", files.frame,
                   existing.keep ? "skip  " : "render", files.image,
                   files.preview.empty() ? "" : " + " + files.preview, existing.reason);
        if (!existing.keep) to_render.push_back(files.frame);
    }
    fmt::print("{} of {} frames to render{}{}\n", to_render.size(), run.files.size(),
               to_render.empty() ? "" : ": ", format_frames(to_render));
    if (to_render.empty()) return;
    PrepareStats prepared;
    const Scene frame =
        prepare_frame(scene, to_render.front(), needs_of(scene), run.cache, prepared);
    require_memory(run.options.memory_limit, scene, prepared);
    fmt::print("memory at frame {}: about {}, {} of them volumes, {} the image; {} particles\n",
               to_render.front(),
               format_bytes(static_cast<double>(peak_memory() + frame_buffer_memory(scene))),
               format_bytes(static_cast<double>(prepared.brick_bytes)),
               format_bytes(static_cast<double>(frame_buffer_memory(scene))), prepared.particles);
}

}  // namespace

void run_render(const RenderOptions& options)
{
    std::vector<FrameFiles> files;
    // Set when `files` is complete: the second signal may come at any time.
    std::atomic<const std::vector<FrameFiles>*> written_files{nullptr};
    // Before anything starts a thread, see StopSignals.
    const StopSignals signals([&written_files] {
        if (const auto* written = written_files.load()) remove_own_temporaries(*written);
    });
    limit_allocations(options.memory_limit);

    const SceneDescription scene = load_render_scene(options);
    const std::vector<int> frames = chosen_frames(options.frames, scene);
    files = frame_files(frames, scene.output.path, scene.output.preview);
    written_files = &files;
    Run run{options, scene, files, chosen_threads(options.threads), {}, {}, {}, false};
    run_with_threads(run.threads, [&] {
        if (options.dry_run) {
            dry_run(run);
            return;
        }
        require_writable_folder(files.front().image);
        if (!files.front().preview.empty()) require_writable_folder(files.front().preview);
        if (!options.stats.empty()) require_writable_folder(options.stats);
        Progress progress(progress_style(options.progress, options.log.quiet),
                          static_cast<int>(frames.size()), stderr_terminal());
        render_all(run, progress);
        progress.finish(false);
    });
}

}  // namespace mote
