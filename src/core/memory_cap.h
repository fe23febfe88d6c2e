#pragma once

#include <cstdint>
#include <mutex>

namespace mote {

/// Address space that this process has mapped [bytes]; 0: unknown.
[[nodiscard]] int64_t mapped_bytes();

/// While one is alive, the process may map no more than so many bytes on top of what it has, and
/// allocations beyond throw std::bad_alloc. For reading untrusted files again that a child has
/// found good: OpenVDB acts upon uninitialised memory where a damaged file ends early, so that it
/// may do in the parent what it did not do in the child (3 GB for a file of 9 kB were seen). All
/// threads share the cap, and caps take turns; do not nest. Without effect in sanitizer builds.
class MemoryCap {
  public:
    explicit MemoryCap(int64_t bytes);
    ~MemoryCap();
    MemoryCap(const MemoryCap&) = delete;
    MemoryCap& operator=(const MemoryCap&) = delete;

  private:
    std::unique_lock<std::mutex> turn_;
    uint64_t limit_before_ = 0;
    bool is_set_ = false;
};

}  // namespace mote
