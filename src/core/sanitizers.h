#pragma once

#if defined(__has_feature)  // clang
#if __has_feature(address_sanitizer)
#define MOTE_ADDRESS_SANITIZER 1
#endif
#if __has_feature(thread_sanitizer)
#define MOTE_THREAD_SANITIZER 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)  // gcc
#define MOTE_ADDRESS_SANITIZER 1
#endif
#if defined(__SANITIZE_THREAD__)
#define MOTE_THREAD_SANITIZER 1
#endif

#if defined(MOTE_THREAD_SANITIZER)
#include <sanitizer/tsan_interface.h>
#endif

namespace mote {

/// Whether this is a sanitizer build: several times slower and larger than others.
#if defined(MOTE_ADDRESS_SANITIZER) || defined(MOTE_THREAD_SANITIZER)
inline constexpr bool is_instrumented = true;
#else
inline constexpr bool is_instrumented = false;
#endif

/// False in sanitizer builds: they reserve terabytes of address space, so that a limit of it would
/// stop the process at once.
inline constexpr bool can_limit_memory = !is_instrumented;

/// Tells the thread sanitizer that everything before give() happens before what follows take().
/// For code that hands work over inside a library that is not instrumented; elsewhere empty.
class HandOver {
  public:
#if defined(MOTE_THREAD_SANITIZER)
    void give()
    {
        __tsan_release(this);
    }
    void take()
    {
        __tsan_acquire(this);
    }
#else
    void give() {}
    void take() {}
#endif
};

}  // namespace mote
