#pragma once

#include <string>
#include <vector>

#include "app/options.h"

namespace CLI {
class App;
}

namespace mote {

/// Options that several commands have, bound to their place. See command_line.cpp.

void bind_log(CLI::App& app, LogOptions& log);

/// --set KEY=VALUE.
void bind_overrides(CLI::App& app, std::vector<std::string>& overrides);

/// --resolution WxH, as two overrides.
void bind_resolution(CLI::App& app, std::vector<std::string>& overrides);

}  // namespace mote
