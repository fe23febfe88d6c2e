#include "app/memory.h"

#include <algorithm>
#include <cstdio>

#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>

#include "core/error.h"
#include "core/sanitizers.h"
#include "core/text.h"

namespace mote {

size_t peak_memory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<size_t>(usage.ru_maxrss) * 1024;
}

size_t current_memory()
{
    unsigned long total = 0;
    unsigned long resident = 0;
    if (std::FILE* file = std::fopen("/proc/self/statm", "re")) {
        if (std::fscanf(file, "%lu %lu", &total, &resident) != 2) resident = 0;
        std::fclose(file);
    }
    return resident * static_cast<size_t>(sysconf(_SC_PAGESIZE));
}

size_t frame_buffer_memory(const SceneDescription& scene)
{
    const size_t channels = 4 + 3 * scene.output.aovs.size();
    return static_cast<size_t>(scene.render.width) * static_cast<size_t>(scene.render.height) *
           channels * sizeof(float) * 2;
}

void limit_allocations(double limit)
{
    if (limit <= 0.0 || !can_limit_memory) return;
    rlimit old{};
    getrlimit(RLIMIT_DATA, &old);
    const auto bytes = static_cast<rlim_t>(std::min(limit, 1e18));
    const rlimit data{std::min(bytes, old.rlim_max), old.rlim_max};
    setrlimit(RLIMIT_DATA, &data);
}

void require_memory(double limit, const SceneDescription& scene, const PrepareStats& prepared)
{
    const auto used = static_cast<double>(current_memory());
    const auto frame = static_cast<double>(frame_buffer_memory(scene));
    if (limit <= 0.0 || used + frame <= limit) return;
    throw Error(
        ExitCode::Memory,
        fmt::format("the frame needs {}, more than the limit of {}: {} are in use, {} of "
                    "them volumes ready to render, and the image takes {}; larger voxels, "
                    "a smaller image or fewer layers need less",
                    format_bytes(used + frame), format_bytes(limit), format_bytes(used),
                    format_bytes(static_cast<double>(prepared.brick_bytes)), format_bytes(frame)));
}

}  // namespace mote
