#pragma once

#include <string>

namespace mote {

/// The whole file. Throws Error(Input) naming it if it cannot be read.
[[nodiscard]] std::string read_text_file(const std::string& path);

/// Replaces the file in one step. Throws Error(Output).
void write_text_file(const std::string& path, const std::string& text);

}  // namespace mote
