#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <new>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include "core/error.h"
#include "core/guarded_child.h"

namespace mote {
namespace {

/// A counter that the child processes share with this one.
class SharedCounter {
  public:
    SharedCounter()
        : memory_(mmap(nullptr, sizeof(std::atomic<int>), PROT_READ | PROT_WRITE,
                       MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
          value_(new (memory_) std::atomic<int>(0))
    {
    }
    ~SharedCounter() { munmap(memory_, sizeof(std::atomic<int>)); }
    SharedCounter(const SharedCounter&) = delete;
    SharedCounter& operator=(const SharedCounter&) = delete;
    [[nodiscard]] std::atomic<int>& value() { return *value_; }

  private:
    void* memory_;
    std::atomic<int>* value_;
};

std::string message_of(const ChildLimits& limits, const std::function<void()>& task)
{
    try {
        run_in_child("file.vdb", limits, task);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(GuardedChild, AChildThatSleepsOnALockIsTriedAgain)
{
    SharedCounter tries;
    run_in_child("file.vdb", {}, [&] {
        if (tries.value()++ == 0) pause();  // as on a lock whose owner was not forked
    });
    EXPECT_EQ(tries.value(), 2);
}

TEST(GuardedChild, EndlessWorkEndsAtItsCpuLimit)
{
    ChildLimits limits;
    limits.cpu_seconds = 1;
    const std::string message = message_of(limits, [] {
        volatile bool forever = true;
        while (forever) {
        }
    });
    EXPECT_EQ(message, "file.vdb: reading it took more than 1 s of CPU time; the file is damaged");
}

TEST(GuardedChild, CrashesAndErrorsBecomeMessages)
{
    EXPECT_EQ(message_of({}, [] { _exit(3); }),
              "file.vdb: reading it crashed the checking process; the file is damaged");
    EXPECT_EQ(message_of({}, [] { throw Error(ExitCode::Input, "file.vdb: no grid"); }),
              "file.vdb: no grid");
    EXPECT_EQ(message_of({}, [] {}), "");
}

}  // namespace
}  // namespace mote
