#pragma once

#include <string>
#include <vector>

#include "render/frame.h"
#include "scene/description.h"
#include "scene/prepare.h"

namespace mote {

/// What became of one frame.
struct FrameRecord {
    int frame = 0;
    std::string file;
    bool skipped = false;
    std::string reason;            ///< why it was skipped or not
    double prepare_seconds = 0.0;  ///< wall
    double prepare_cpu_seconds = 0.0;
    double write_seconds = 0.0;
    double total_seconds = 0.0;
    double total_cpu_seconds = 0.0;
    size_t peak_memory = 0;  ///< of the process so far [bytes]
    PrepareStats prepare;
    FrameStats render;
};

/// Writes the records of a run as JSON, atomically. Called after every frame: a run that is killed
/// leaves the statistics of what it finished. Throws Error(Output).
void write_run_stats(const std::string& path, const SceneDescription& scene, int threads,
                     const std::vector<FrameRecord>& records, bool finished);

/// Seconds of a steady clock, and of CPU over all threads of this process.
[[nodiscard]] double wall_seconds();
[[nodiscard]] double cpu_seconds();

}  // namespace mote
