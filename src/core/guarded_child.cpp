#include "core/guarded_child.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/core.h>

#include "core/error.h"
#include "core/memory_cap.h"
#include "core/sanitizers.h"
#include "core/text.h"

namespace mote {
namespace {

void set_limit(decltype(RLIMIT_CPU) resource, int64_t soft, int64_t hard)
{
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_cur = std::min(limit.rlim_max, static_cast<rlim_t>(soft));
    limit.rlim_max = std::min(limit.rlim_max, static_cast<rlim_t>(hard));
    setrlimit(resource, &limit);
}

/// First byte of the child's report.
enum Report : char { Done = 'd', Failed = 'f', OutOfMemory = 'm' };

void send(int pipe_end, char kind, const char* text)
{
    char buffer[2048];
    buffer[0] = kind;
    const size_t length = std::min(std::strlen(text), sizeof buffer - 1);
    std::copy_n(text, length, buffer + 1);
    // Less than PIPE_BUF: written whole or not at all, and a lost report is read as a crash.
    [[maybe_unused]] const ssize_t written = write(pipe_end, buffer, length + 1);
}

[[noreturn]] void be_child(int pipe_end, const ChildLimits& limits, int64_t address_space,
                           const std::function<void()>& task)
{
    for (const int signal : {SIGINT, SIGTERM, SIGXCPU, SIGSEGV, SIGABRT})
        std::signal(signal, SIG_DFL);
    set_limit(RLIMIT_CORE, 0, 0);
    set_limit(RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1);
    if (can_limit_memory) set_limit(RLIMIT_AS, address_space, address_space);
    const int null = open("/dev/null", O_WRONLY);  // readers print warnings: they are reported once
    if (null >= 0) {
        dup2(null, STDOUT_FILENO);
        dup2(null, STDERR_FILENO);
    }
    try {
        task();
        send(pipe_end, Done, "");
    } catch (const Error& e) {
        send(pipe_end, e.code() == ExitCode::Memory ? OutOfMemory : Failed, e.what());
    } catch (const std::bad_alloc&) {
        send(pipe_end, OutOfMemory, "it asks for more memory than a file of its size can need");
    } catch (const std::exception& e) {  // the library's own words say what, but not what to do
        send(pipe_end, Failed,
             fmt::format("damaged or of another format ({}); copy or write it again",
                         printable(e.what()))
                 .c_str());
    } catch (...) {
        send(pipe_end, Failed, "unknown failure");
    }
    _exit(0);
}

struct Outcome {
    std::string report;  ///< empty: the child died without one
    int status = 0;
    bool timed_out = false;
    bool slept = false;  ///< stopped because it waited for a lock that nobody will open

    [[nodiscard]] bool ran_out_of_cpu() const
    {
        return report.empty() && !timed_out && !slept && WIFSIGNALED(status) &&
               (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL);
    }
};

/// A process' state letter ('S' sleeps, 'D' waits for a disk, 'R' runs) and clock ticks used.
struct Activity {
    char state = '?';
    unsigned long ticks = 0;
};

Activity activity_of(pid_t process)
{
    Activity activity;
    std::FILE* file = std::fopen(fmt::format("/proc/{}/stat", process).c_str(), "r");
    if (!file) return activity;
    unsigned long user = 0;
    unsigned long system = 0;
    const int read =
        std::fscanf(file, "%*d %*[^)]) %c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %lu %lu",
                    &activity.state, &user, &system);
    std::fclose(file);
    activity.ticks = read == 3 ? user + system : 0;
    return activity;
}

/// Tells a child that sleeps on a lock from one that is merely slow: interruptible sleep, seen
/// again and again without a tick of CPU time in between.
class SleepWatch {
  public:
    explicit SleepWatch(pid_t child) : child_(child) {}

    /// To be called about every poll_ms; true once the child has slept for two seconds.
    bool is_asleep()
    {
        const Activity now = activity_of(child_);
        const bool idle = now.state == 'S' && now.ticks == last_.ticks;
        naps_ = idle ? naps_ + 1 : 0;
        last_ = now;
        return naps_ * poll_ms >= 2000;
    }

    static constexpr int poll_ms = 100;

  private:
    pid_t child_;
    Activity last_;
    int naps_ = 0;
};

Outcome wait_for(pid_t child, int pipe_end, int wall_seconds)
{
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::seconds(wall_seconds);
    SleepWatch watch(child);
    Outcome out;
    for (;;) {
        pollfd waiting{pipe_end, POLLIN, 0};
        const int ready = poll(&waiting, 1, SleepWatch::poll_ms);
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) {
            out.slept = watch.is_asleep();
            out.timed_out = !out.slept && Clock::now() > deadline;
            if (!out.slept && !out.timed_out) continue;
            kill(child, SIGKILL);
            break;
        }
        char buffer[2048];
        const ssize_t count = read(pipe_end, buffer, sizeof buffer);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;  // end of file: the child is gone
        out.report.append(buffer, static_cast<size_t>(count));
    }
    while (waitpid(child, &out.status, 0) < 0 && errno == EINTR) {
    }
    return out;
}

Outcome run_once(const std::string& what, const ChildLimits& limits,
                 const std::function<void()>& task)
{
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) {
        throw Error(ExitCode::RenderFailed,
                    fmt::format("{}: cannot create a pipe: {}", what, std::strerror(errno)));
    }
    const int64_t address_space = mapped_bytes() + limits.memory_bytes;
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        be_child(ends[1], limits, address_space, task);
    }
    const int fork_error = errno;
    close(ends[1]);
    if (child < 0) {
        close(ends[0]);
        throw Error(ExitCode::Memory, fmt::format("{}: cannot start the process that checks it: {}",
                                                  what, std::strerror(fork_error)));
    }
    Outcome out = wait_for(child, ends[0], limits.wall_seconds);
    close(ends[0]);
    return out;
}

}  // namespace

void run_in_child(const std::string& what, const ChildLimits& limits,
                  const std::function<void()>& task)
{
    Outcome out = run_once(what, limits, task);
    // A lock that some thread held at the fork stays locked in the child; whoever waits for it
    // sleeps, or spins until the CPU time is used up. The next fork hardly meets it again.
    for (int again = 0; again < 8 && out.slept; ++again) out = run_once(what, limits, task);
    if (out.ran_out_of_cpu()) out = run_once(what, limits, task);
    if (!out.report.empty()) {
        if (out.report[0] == Done) return;
        const ExitCode code = out.report[0] == OutOfMemory ? ExitCode::Memory : ExitCode::Input;
        const std::string text = printable(out.report.substr(1), 2000);
        if (text.starts_with(what + ":")) throw Error(code, text);  // it names the file itself
        throw Error(code, fmt::format("{}: {}", what, text));
    }
    std::string reason = "reading it crashed the checking process";
    if (out.timed_out || out.slept) {
        reason = fmt::format("reading it took longer than {} s", limits.wall_seconds);
    } else if (out.ran_out_of_cpu()) {
        reason = fmt::format("reading it took more than {} s of CPU time", limits.cpu_seconds);
    }
    throw Error(ExitCode::Input, fmt::format("{}: {}; the file is damaged", what, reason));
}

}  // namespace mote
