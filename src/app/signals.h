#pragma once

#include <functional>
#include <memory>

namespace mote {

/// True once SIGINT or SIGTERM came while a StopSignals lives. Cheap, callable from any thread.
[[nodiscard]] bool stop_requested();

/// Turns SIGINT and SIGTERM into a clean stop while it lives. The first one only makes
/// stop_requested() true; the second one calls `before_exit` and ends the process at once with 130
/// or 143. A thread of its own waits for them, so no work happens in a signal handler. Create it
/// before any other thread: threads inherit the blocked signals from the one that starts them.
class StopSignals {
  public:
    explicit StopSignals(std::function<void()> before_exit = {});
    ~StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace mote
