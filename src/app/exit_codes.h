#pragma once

#include <string>

#include "core/error.h"

namespace mote {

/// One line on when the process returns `code`.
[[nodiscard]] const char* meaning(ExitCode code);

/// The table of exit codes that `mote --help` and the documents show, one code per line.
[[nodiscard]] std::string exit_code_table();

}  // namespace mote
