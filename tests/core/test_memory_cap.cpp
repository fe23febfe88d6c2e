#include <new>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include "core/memory_cap.h"
#include "core/sanitizers.h"

namespace mote {
namespace {

/// Whether so much can be had; never touched, so it costs no memory.
bool can_allocate(size_t bytes)
{
    void* volatile memory = ::operator new(bytes, std::nothrow);  // or the compiler leaves it out
    const bool given = memory != nullptr;
    ::operator delete(memory);
    return given;
}

TEST(MemoryCap, AllocationsBeyondItFailUntilItEnds)
{
    if (!can_limit_memory) GTEST_SKIP() << "sanitizers reserve terabytes";
    constexpr size_t gigabyte = size_t{1} << 30;
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
    ASSERT_GT(mapped_bytes(), 0);
    ASSERT_TRUE(can_allocate(2 * gigabyte));
    {
        const MemoryCap cap(int64_t{gigabyte});
        EXPECT_TRUE(can_allocate(gigabyte / 2));
        EXPECT_FALSE(can_allocate(2 * gigabyte));
        EXPECT_THROW(std::vector<char>(2 * gigabyte), std::bad_alloc);
    }
    EXPECT_TRUE(can_allocate(2 * gigabyte));
    rlimit after{};
    ASSERT_EQ(getrlimit(RLIMIT_AS, &after), 0);
    EXPECT_EQ(after.rlim_cur, before.rlim_cur);
}

}  // namespace
}  // namespace mote
