#pragma once

#include <string>
#include <vector>

#include "app/options.h"

namespace mote {

/// Reads the arguments behind the program name. Help is a result (PrintText), not an error.
/// Throws Error(Usage) with a message that names the argument, the nearest known one, and the help
/// that lists them. `--isa` takes effect here: it belongs to the process, not to a command.
[[nodiscard]] CommandLine parse_command_line(const std::vector<std::string>& arguments);

}  // namespace mote
