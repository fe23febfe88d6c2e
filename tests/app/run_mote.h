#pragma once

#include <functional>
#include <string>
#include <vector>

#include <sys/types.h>

namespace mote {

/// What a finished run of the executable left.
struct Finished {
    int exit_code = -1;  ///< minus the signal's number if one ended it
    std::string out;
    std::string err;
};

/// The built executable, running in a working folder of its own. Output goes to files there, so
/// that no pipe can fill up. Killed after a minute (ten under a
/// sanitizer).
class RunningMote {
  public:
    /// `before_exec` runs in the child, for limits.
    RunningMote(const std::string& folder, const std::vector<std::string>& arguments,
                const std::function<void()>& before_exec = {});

    void send(int signal) const;
    /// Waits until stderr holds `text`; false if the program ended or hangs.
    [[nodiscard]] bool wait_for(const std::string& text);
    [[nodiscard]] Finished wait();

  private:
    [[nodiscard]] bool has_ended();

    std::string folder_;
    pid_t child_ = -1;
    int status_ = -1;
    bool ended_ = false;
};

/// Runs to the end.
[[nodiscard]] Finished run_mote(const std::string& folder,
                                const std::vector<std::string>& arguments,
                                const std::function<void()>& before_exec = {});

/// Names of all files below a folder, hidden ones included, sorted.
[[nodiscard]] std::vector<std::string> files_below(const std::string& folder);

}  // namespace mote
