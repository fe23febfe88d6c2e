#include "app/exit_codes.h"

#include <fmt/format.h>

namespace mote {

const char* meaning(ExitCode code)
{
    // No default: the compiler names the code that was added to the enumeration but not here.
    switch (code) {
        case ExitCode::Ok:
            return "done";
        case ExitCode::RenderFailed:
            return "internal failure";
        case ExitCode::Usage:
            return "wrong command line";
        case ExitCode::Input:
            return "scene, volume, particle or image input is wrong or missing";
        case ExitCode::Output:
            return "an output could not be written; old files are untouched";
        case ExitCode::Memory:
            return "a memory limit would be exceeded";
        case ExitCode::BiasFound:
            return "verify: bias found; compare: over the threshold";
        case ExitCode::NotEnoughRuns:
            return "verify: not enough runs to decide";
        case ExitCode::Interrupted:
            return "stopped cleanly by SIGINT or SIGTERM: run me again";
    }
    return "";
}

std::string exit_code_table()
{
    constexpr ExitCode codes[] = {
        ExitCode::Ok,        ExitCode::RenderFailed,  ExitCode::Usage,
        ExitCode::Input,     ExitCode::Output,        ExitCode::Memory,
        ExitCode::BiasFound, ExitCode::NotEnoughRuns, ExitCode::Interrupted,
    };
    std::string table = "Exit codes:\n";
    for (const ExitCode code : codes) {
        table += fmt::format("  {:<8} {}\n", static_cast<int>(code), meaning(code));
    }
    table += "  130, 143 stopped at once by a second SIGINT or SIGTERM\n";
    return table;
}

}  // namespace mote
