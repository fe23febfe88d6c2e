#pragma once

#include <stdexcept>
#include <string>

namespace mote {

/// What the process returns; the one table of exit codes, printed by `mote --help`.
enum class ExitCode : int {
    Ok = 0,            ///< done
    RenderFailed = 1,  ///< internal failure
    Usage = 2,         ///< wrong command line
    Input = 3,         ///< scene, volume or particle input is wrong or missing
    Output = 4,        ///< an output could not be written; old files are untouched
    Memory = 5,        ///< a memory limit would be exceeded
    BiasFound = 10,    ///< verify: bias found; compare: over the threshold
    NotEnoughRuns = 11,
    Interrupted = 75,  ///< stopped by SIGINT or SIGTERM between frames: retry me
};

/// Bad input, files or limits. The message says what, where (file:line:col, or file and grid
/// name) and how to fix it. Only `main` catches it; library code never exits.
class Error : public std::runtime_error {
  public:
    Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
    [[nodiscard]] ExitCode code() const { return code_; }

  private:
    ExitCode code_;
};

/// Prints the failed condition with both operands' text and aborts; called by MOTE_ASSERT.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line);

}  // namespace mote

/// Caller mistakes. On in Debug and in the `ci`, `asan` and `tsan` presets.
#ifdef MOTE_ENABLE_ASSERTS
#define MOTE_ASSERT(condition) \
    ((condition) ? void(0) : ::mote::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define MOTE_ASSERT(condition) void(0)
#endif
