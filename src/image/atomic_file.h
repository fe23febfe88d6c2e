#pragma once

#include <functional>
#include <string>

namespace mote {

/// Replaces `path` in one step: calls write(temporary_path) for a file `.name.pid.tmp.ext` in the
/// same folder, syncs it and renames it over `path`; on any failure the temporary file is removed
/// and `path` stays as it was. Creates missing folders. Throws Error(Output) naming the path.
void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary_path)>& write);

}  // namespace mote
