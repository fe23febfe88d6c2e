#include <chrono>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/parallel.h"

namespace mote {

namespace {

/// Distinct threads that took part in a loop whose chunks sleep, so that all get a share.
size_t threads_seen()
{
    std::mutex mutex;
    std::set<std::thread::id> ids;
    parallel_for(64, 1, [&](size_t, size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        const std::lock_guard lock(mutex);
        ids.insert(std::this_thread::get_id());
    });
    return ids.size();
}

}  // namespace

TEST(Parallel, RunWithThreadsSetsTheCountAlsoAboveTheCores)
{
    run_with_threads(1, [] { EXPECT_EQ(threads_seen(), 1u); });
    run_with_threads(8, [] {
        const size_t seen = threads_seen();
        EXPECT_LE(seen, 8u);
        EXPECT_GT(seen, static_cast<size_t>(available_threads()) >= 8 ? 1u : 2u);
    });
}

TEST(Parallel, ChunksTileTheRangeWhateverTheThreads)
{
    std::vector<int> visits(1003, 0);
    run_with_threads(3, [&] {
        parallel_for(visits.size(), 10, [&](size_t begin, size_t end) {
            for (size_t i = begin; i != end; ++i) ++visits[i];
        });
    });
    for (const int v : visits) ASSERT_EQ(v, 1);
}

TEST(Parallel, ExceptionsReachTheCaller)
{
    EXPECT_THROW(run_with_threads(2,
                                  [] {
                                      parallel_for(100, 1, [](size_t begin, size_t) {
                                          if (begin == 57) throw Error(ExitCode::Input, "x");
                                      });
                                  }),
                 Error);
}

}  // namespace mote
