#pragma once

#include <string>

#include "app/options.h"

namespace mote {

/// Sends the log of all layers to stderr (warnings and up; more with verbosity) and to a file if
/// asked. Colour is never used. Throws Error(Output) if the file cannot be opened.
void start_logging(const LogOptions& options);

/// The one message a failed command prints, in the form that start_logging set.
void report_error(const std::string& message);

}  // namespace mote
