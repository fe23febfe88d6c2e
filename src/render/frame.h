#pragma once

#include <cstdint>
#include <memory>

#include "image/layers.h"
#include "render/truncation.h"
#include "restir/cache_stats.h"
#include "scene/description.h"
#include "scene/scene.h"
#include "volumes/tracking_counts.h"

namespace mote {

/// What a frame holds in memory while it renders, by what it is for [bytes]; the light caches' part
/// is in CacheParts.
struct FrameMemory {
    size_t grids = 0;    ///< density, emission, temperature, colour and velocity of the media
    size_t film = 0;     ///< the image and its layers
    size_t history = 0;  ///< reservoirs, ray tables and passes kept for the next frame
};

/// Counts and times of one rendered frame, written to --stats.
struct FrameStats {
    double render_seconds = 0.0;      ///< wall
    double render_cpu_seconds = 0.0;  ///< process CPU time
    int64_t paths = 0;
    int64_t dropped_non_finite = 0;  ///< samples replaced by 0; must be 0
    Truncation truncation;
    double cache_cpu_seconds = 0.0;  ///< building light caches and the index of lamps that rays
                                     ///< meet, part of render_cpu_seconds
    int64_t camera_rays = 0;         ///< tabulated by the ReSTIR estimator: those that met smoke
    int64_t missed_rays = 0;         ///< camera rays that met no medium's bounds: nothing is walked
    int64_t light_rays = 0;          ///< traced exactly towards lights
    int64_t cells = 0;               ///< walked by both
    int64_t light_ray_cells = 0;     ///< those of them by rays towards lights
    int64_t coarse_rays = 0;         ///< towards lights, through coarse media
    int64_t coarse_ray_cells = 0;    ///< walked by these
    int64_t uniform_bricks = 0;      ///< crossed by both in closed form, without cells
    int64_t candidates = 0;
    int64_t surfaces = 0;            ///< passes of pixels that sampled a surface's light
    int64_t emission_integrals = 0;  ///< along camera rays; 0 if nothing glows
    int64_t histories_used = 0;      ///< pixels and passes that had a history with confidence
    int64_t neighbours_used = 0;     ///< reservoirs of neighbours that took part
    int caches_built = 0;            ///< light caches made for this frame
    int caches_reused = 0;           ///< taken over from the frame before
    CacheParts caches;               ///< what they are of
    TrackingCounts tracking;         ///< work of the path tracer, or of its part in a frame
    FrameMemory memory;
};

/// Asked by several threads, at every pixel and every few samples, so it must be cheap; true
/// abandons the frame. May be null.
using StopRequested = bool (*)();

/// Called by several threads after each 16 x 16 tile. May be null.
using TileDone = void (*)();

/// What the ReSTIR estimator keeps from frame to frame of one run: light caches, and with reuse
/// also reservoirs and the domain they live in. Empty at the start and after a cut.
class FrameHistory {
  public:
    FrameHistory();
    ~FrameHistory();
    FrameHistory(const FrameHistory&) = delete;
    FrameHistory& operator=(const FrameHistory&) = delete;
    /// The frame rendered next is the last one: it keeps nothing that only a following frame would
    /// use (some 300 bytes per pixel).
    void expect_no_more();
    struct Impl;
    [[nodiscard]] Impl& impl() { return *impl_; }

  private:
    std::unique_ptr<Impl> impl_;
};

/// Whether frames rendered before one can change it, apart from the time taken: reuse over time.
[[nodiscard]] bool uses_history(const RenderDescription& render);

/// Renders one frame into a layered image holding RGBA and the layers of output.aovs (see aov.h),
/// nothing else: layers not asked for are not computed. RGB is the mean over the pixel's square,
/// premultiplied by nothing but the volumes themselves; A is 1 minus the mean transmittance.
/// Attributes describe the camera. Empty image if stopped. Bit-identical for any thread count:
/// every sample has its own random stream, keyed by (seed, frame, pixel, sample), and a pixel adds
/// its samples in order. Throws Error(Input) for unknown layers.
[[nodiscard]] LayeredImage render_frame(const Scene& scene, const RenderDescription& render,
                                        const OutputDescription& output, FrameHistory& history,
                                        StopRequested stop, FrameStats& stats,
                                        TileDone tile_done = nullptr);

}  // namespace mote
