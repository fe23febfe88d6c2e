#include <chrono>
#include <csignal>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include "app/signals.h"

namespace mote {

namespace {

/// Waits until a sent signal has been seen by the watching thread.
bool stops_within_a_while()
{
    for (int i = 0; i < 1000 && !stop_requested(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return stop_requested();
}

}  // namespace

TEST(Signals, TheFirstSignalOnlySetsTheFlag)
{
    for (const int signal : {SIGINT, SIGTERM}) {
        const StopSignals signals;
        EXPECT_FALSE(stop_requested());
        kill(getpid(), signal);
        EXPECT_TRUE(stops_within_a_while());
    }
}

TEST(SignalsDeathTest, TheSecondSignalCleansUpAndExitsAtOnce)
{
    testing::GTEST_FLAG(death_test_style) = "threadsafe";
    const auto interrupt_twice = [](int second) {
        const StopSignals signals([] { static_cast<void>(write(STDERR_FILENO, "cleaned", 7)); });
        kill(getpid(), SIGTERM);
        stops_within_a_while();
        kill(getpid(), second);
        std::this_thread::sleep_for(std::chrono::seconds(30));
    };
    EXPECT_EXIT(interrupt_twice(SIGTERM), testing::ExitedWithCode(143), "cleaned");
    EXPECT_EXIT(interrupt_twice(SIGINT), testing::ExitedWithCode(130), "cleaned");
}

}  // namespace mote
