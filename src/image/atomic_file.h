#pragma once

#include <functional>
#include <string>

namespace mote {

/// Replaces `path` in one step: calls write(temporary_path) for a file `.name.pid.tmp.ext` in the
/// same folder, syncs it and renames it over `path`; on any failure the temporary file is removed
/// and `path` stays as it was. `write` must close the file and throw if a write failed. Creates
/// missing folders; removes temporary files that dead processes left for the same `path` (so two
/// machines must not write one file at the same time). Throws Error(Output) naming path, reason
/// and remedy; an Error thrown by `write` passes through.
void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary_path)>& write);

/// Throws Error(Output) for a failed operation on `path`: its reason from errno, and the remedy.
[[noreturn]] void throw_output_error(const std::string& path, int error_number);

}  // namespace mote
