#include "app/signals.h"

#include <atomic>
#include <csignal>
#include <thread>
#include <utility>

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include "core/error.h"

namespace mote {

namespace {

std::atomic<bool> stop_flag{false};

}  // namespace

bool stop_requested()
{
    return stop_flag.load(std::memory_order_relaxed);
}

struct StopSignals::Impl {
    std::function<void()> before_exit;
    sigset_t signals{};
    sigset_t old_mask{};
    int signal_fd = -1;
    int end_fd = -1;
    std::thread waiter;

    void wait()
    {
        for (;;) {
            pollfd sources[] = {{signal_fd, POLLIN, 0}, {end_fd, POLLIN, 0}};
            if (poll(sources, 2, -1) < 0) continue;
            if ((sources[1].revents & POLLIN) != 0) return;
            signalfd_siginfo info{};
            if (read(signal_fd, &info, sizeof info) != static_cast<ssize_t>(sizeof info)) continue;
            if (stop_flag.exchange(true)) {
                if (before_exit) before_exit();
                _exit(128 + static_cast<int>(info.ssi_signo));
            }
        }
    }
};

StopSignals::StopSignals(std::function<void()> before_exit) : impl_(std::make_unique<Impl>())
{
    stop_flag = false;
    impl_->before_exit = std::move(before_exit);
    sigemptyset(&impl_->signals);
    sigaddset(&impl_->signals, SIGINT);
    sigaddset(&impl_->signals, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &impl_->signals, &impl_->old_mask);
    impl_->signal_fd = signalfd(-1, &impl_->signals, SFD_CLOEXEC);
    impl_->end_fd = eventfd(0, EFD_CLOEXEC);
    if (impl_->signal_fd < 0 || impl_->end_fd < 0) {
        throw Error(ExitCode::RenderFailed, "cannot watch for signals: out of file descriptors");
    }
    impl_->waiter = std::thread([this] { impl_->wait(); });
}

StopSignals::~StopSignals()
{
    const uint64_t one = 1;
    if (write(impl_->end_fd, &one, sizeof one) == static_cast<ssize_t>(sizeof one)) {
        impl_->waiter.join();
    } else {
        impl_->waiter.detach();
    }
    close(impl_->signal_fd);
    close(impl_->end_fd);
    pthread_sigmask(SIG_SETMASK, &impl_->old_mask, nullptr);
}

}  // namespace mote
