#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace mote {

/// What a child process may use.
struct ChildLimits {
    int64_t memory_bytes = 1'000'000'000;  ///< address space on top of what this process has
    int cpu_seconds = 3;
    int wall_seconds = 120;  ///< sleeping on slow disks included
};

/// Runs `task` in a forked child and throws Error(Input) or Error(Memory), starting with `what`,
/// if it throws, crashes, or goes over its limits. This is how untrusted files meet third-party
/// readers: OpenVDB 10 loops for hours on some damaged files, and only a process can be stopped.
/// The task must not use threads (TBB's workers do not exist in the child); its effects are lost.
///
/// Forking a process with threads is safe here because the child touches nothing but malloc
/// (glibc makes it usable after fork) and the reader. Should a lock (of TBB, which even OpenVDB's
/// destructors use) be held at the instant of the fork, the child would sleep: that is noticed
/// after two seconds, and it is stopped and tried again.
/// Cost: about 1 ms plus the task; page tables of the parent are copied (milliseconds per GB).
void run_in_child(const std::string& what, const ChildLimits& limits,
                  const std::function<void()>& task);

}  // namespace mote
