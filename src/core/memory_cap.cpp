#include "core/memory_cap.h"

#include <algorithm>
#include <cstdio>

#include <sys/resource.h>
#include <unistd.h>

#include "core/sanitizers.h"

namespace mote {
namespace {

std::mutex& turns()
{
    static std::mutex mutex;
    return mutex;
}

}  // namespace

int64_t mapped_bytes()
{
    std::FILE* file = std::fopen("/proc/self/statm", "r");
    if (!file) return 0;
    long long pages = 0;
    const bool read = std::fscanf(file, "%lld", &pages) == 1;
    std::fclose(file);
    return read ? pages * sysconf(_SC_PAGESIZE) : 0;
}

MemoryCap::MemoryCap(int64_t bytes) : turn_(turns())
{
    const int64_t mapped = mapped_bytes();
    rlimit limit{};
    if (!can_limit_memory || mapped == 0 || getrlimit(RLIMIT_AS, &limit) != 0) return;
    limit_before_ = limit.rlim_cur;
    limit.rlim_cur = std::min(limit.rlim_cur, static_cast<rlim_t>(mapped + bytes));
    is_set_ = setrlimit(RLIMIT_AS, &limit) == 0;
}

MemoryCap::~MemoryCap()
{
    rlimit limit{};
    if (!is_set_ || getrlimit(RLIMIT_AS, &limit) != 0) return;
    limit.rlim_cur = static_cast<rlim_t>(limit_before_);
    setrlimit(RLIMIT_AS, &limit);
}

}  // namespace mote
