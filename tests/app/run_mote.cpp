#include "run_mote.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "core/sanitizers.h"
#include "support/temporary_folder.h"

namespace mote {

namespace {

/// Pauses of 5 ms until a program counts as hanging: a minute, or ten for a slow, instrumented one.
constexpr int max_pauses = is_instrumented ? 120'000 : 12'000;

constexpr const char* out_name = ".stdout";
constexpr const char* err_name = ".stderr";

void redirect(const char* name, int descriptor)
{
    const int file = open(name, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, descriptor);
    close(file);
}

}  // namespace

RunningMote::RunningMote(const std::string& folder, const std::vector<std::string>& arguments,
                         const std::function<void()>& before_exec)
    : folder_(folder)
{
    std::vector<char*> argv{const_cast<char*>(MOTE_EXECUTABLE)};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    std::filesystem::remove(folder_ + "/" + err_name);
    child_ = fork();
    if (child_ == 0) {
        if (chdir(folder_.c_str()) != 0) _exit(127);
        redirect(out_name, STDOUT_FILENO);
        redirect(err_name, STDERR_FILENO);
        if (before_exec) before_exec();
        execv(MOTE_EXECUTABLE, argv.data());
        _exit(127);
    }
    EXPECT_GT(child_, 0);
}

void RunningMote::send(int signal) const
{
    kill(child_, signal);
}

bool RunningMote::has_ended()
{
    if (!ended_ && waitpid(child_, &status_, WNOHANG) == child_) ended_ = true;
    return ended_;
}

bool RunningMote::wait_for(const std::string& text)
{
    for (int i = 0; i < max_pauses; ++i) {
        if (read_bytes(folder_ + "/" + err_name).find(text) != std::string::npos) return true;
        if (has_ended()) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

Finished RunningMote::wait()
{
    for (int i = 0; i < max_pauses && !has_ended(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    if (!ended_) {
        ADD_FAILURE() << "mote does not come to an end";
        kill(child_, SIGKILL);
        waitpid(child_, &status_, 0);
        ended_ = true;
    }
    Finished finished;
    finished.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : -WTERMSIG(status_);
    for (auto [name, text] : {std::pair{out_name, &finished.out}, {err_name, &finished.err}}) {
        *text = read_bytes(folder_ + "/" + name);
        std::filesystem::remove(folder_ + "/" + name);
    }
    return finished;
}

Finished run_mote(const std::string& folder, const std::vector<std::string>& arguments,
                  const std::function<void()>& before_exec)
{
    return RunningMote(folder, arguments, before_exec).wait();
}

std::vector<std::string> files_below(const std::string& folder)
{
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            names.push_back(std::filesystem::relative(entry.path(), folder).string());
        }
    }
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace mote
