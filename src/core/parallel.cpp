#include "core/parallel.h"

#include <algorithm>
#include <cstdlib>

#include <sched.h>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/sanitizers.h"

namespace mote {

namespace {

/// Orders the chunks of a loop after what came before it, and what follows it after the chunks;
/// chunks stay unordered among themselves, so that a race between them is still seen.
struct LoopBorders {
    HandOver begin;
    HandOver end;
};

struct InsideChunk {
    explicit InsideChunk(LoopBorders& loop) : borders(loop) { borders.begin.take(); }
    ~InsideChunk() { borders.end.give(); }
    InsideChunk(const InsideChunk&) = delete;
    InsideChunk& operator=(const InsideChunk&) = delete;

    LoopBorders& borders;
};

struct AroundLoop {
    explicit AroundLoop(LoopBorders& loop) : borders(loop) { borders.begin.give(); }
    ~AroundLoop() { borders.end.take(); }
    AroundLoop(const AroundLoop&) = delete;
    AroundLoop& operator=(const AroundLoop&) = delete;

    LoopBorders& borders;
};

}  // namespace

void parallel_for(size_t count, size_t grain, const std::function<void(size_t, size_t)>& f)
{
    grain = std::max<size_t>(grain, 1);
    const size_t chunks = (count + grain - 1) / grain;
    LoopBorders borders;
    const AroundLoop around(borders);
    tbb::parallel_for(tbb::blocked_range<size_t>(0, chunks, 1),
                      [&](const tbb::blocked_range<size_t>& range) {
                          const InsideChunk inside(borders);
                          for (size_t c = range.begin(); c != range.end(); ++c) {
                              f(c * grain, std::min(count, (c + 1) * grain));
                          }
                      });
}

void for_each_tile(int width, int height, const std::function<void(const Tile&)>& f)
{
    constexpr int size = image_tile_size;
    const int columns = (width + size - 1) / size;
    const int rows = (height + size - 1) / size;
    if (columns <= 0 || rows <= 0) return;
    const size_t tiles = static_cast<size_t>(columns) * static_cast<size_t>(rows);
    parallel_for(tiles, 1, [&](size_t begin, size_t end) {
        for (size_t i = begin; i != end; ++i) {
            const int x = static_cast<int>(i % static_cast<size_t>(columns)) * size;
            const int y = static_cast<int>(i / static_cast<size_t>(columns)) * size;
            f({x, y, std::min(x + size, width), std::min(y + size, height)});
        }
    });
}

int available_threads()
{
    cpu_set_t set;
    CPU_ZERO(&set);
    int count = 1;
    if (sched_getaffinity(0, sizeof set, &set) == 0) count = std::max(1, CPU_COUNT(&set));
    if (const char* slurm = std::getenv("SLURM_CPUS_PER_TASK")) {
        const int granted = std::atoi(slurm);
        if (granted > 0) count = std::min(count, granted);
    }
    return count;
}

void run_with_threads(int count, const std::function<void()>& f)
{
    count = std::max(1, count);
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                                    static_cast<size_t>(count));
    // The implicit arena has one slot per core, so a larger count needs an arena of its own.
    tbb::task_arena arena(count);
    arena.execute([&] { f(); });
}

int thread_limit()
{
    const size_t active =
        tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
    return std::min(available_threads(), static_cast<int>(std::min<size_t>(active, 1024)));
}

}  // namespace mote
