#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include <sys/resource.h>

#include <gtest/gtest.h>

#include "image/exr.h"
#include "run_mote.h"
#include "support/temporary_folder.h"
#include "test_scene.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

/// Ends of a run that are not success: exit code, message, and what is left on disk.
class Failures : public testing::Test {
  protected:
    Failures() { folder.write("scene.toml", puff_scene); }

    [[nodiscard]] Finished mote(const Names& arguments) const
    {
        return run_mote(folder.path(), arguments);
    }

    TemporaryFolder folder;
};

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

/// A frame that takes far longer than any test, in tiles of well under a second.
const Names endless{"render",    "scene.toml", "--frames", "1-2",        "--resolution",
                    "2000x2000", "--samples",  "500",      "--progress", "json"};

}  // namespace

TEST_F(Failures, UsageIs2WithAHint)
{
    const Finished run = mote({"render", "scene.toml", "--frmaes", "1"});
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_TRUE(contains(run.err, "mote: unknown option --frmaes (did you mean")) << run.err;
    EXPECT_EQ(mote({"render", "scene.toml", "--frames", "1y2"}).exit_code, 2);
    const Finished pattern = mote({"render", "scene.toml", "--output", "one.exr"});
    EXPECT_EQ(pattern.exit_code, 2);
    EXPECT_TRUE(contains(pattern.err, "put #### into it")) << pattern.err;
    EXPECT_EQ(mote({"render", "scene.toml", "--output", "####.jpg"}).exit_code, 2);
    EXPECT_EQ(mote({"--help"}).exit_code, 0);
}

TEST_F(Failures, WrongOrMissingScenesAre3WithThePlace)
{
    folder.write("bad.toml", puff_scene + "\n[camra]\nfov = 3\n");
    const Finished bad = mote({"render", "bad.toml"});
    EXPECT_EQ(bad.exit_code, 3);
    EXPECT_TRUE(contains(bad.err, "bad.toml:")) << bad.err;
    EXPECT_TRUE(contains(bad.err, "did you mean")) << bad.err;

    const Finished missing = mote({"render", "none.toml"});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_TRUE(contains(missing.err, "none.toml")) << missing.err;

    const Finished override = mote({"render", "scene.toml", "--set", "render.samples=-1"});
    EXPECT_EQ(override.exit_code, 3);
    EXPECT_TRUE(contains(override.err, "render.samples")) << override.err;
}

TEST_F(Failures, AnUnwritableFolderIs4BeforeAnythingIsRendered)
{
    folder.write("file", "not a folder");
    const Finished run =
        mote({"render", "scene.toml", "--samples", "1000000", "--output", "file/####.exr"});
    EXPECT_EQ(run.exit_code, 4);
    EXPECT_TRUE(contains(run.err, "file/0001.exr")) << run.err;
}

TEST_F(Failures, AFullDiskIs4AndLeavesTheOldFileWhole)
{
    ASSERT_EQ(mote({"render", "scene.toml", "--frames", "1"}).exit_code, 0);
    const std::string old = read_bytes(folder.file("out/0001.exr"));
    const Names files = files_below(folder.path());
    const Finished run = run_mote(
        folder.path(), {"render", "scene.toml", "--frames", "1", "--resolution", "256x256"}, [] {
            // Files of more than 8 kB fail to be written, as on a disk with so much left.
            const rlimit limit{8192, 8192};
            setrlimit(RLIMIT_FSIZE, &limit);
        });
    EXPECT_EQ(run.exit_code, 4) << run.err;
    EXPECT_TRUE(contains(run.err, "out/0001.exr")) << run.err;
    EXPECT_EQ(read_bytes(folder.file("out/0001.exr")), old);
    EXPECT_EQ(files_below(folder.path()), files);
}

TEST_F(Failures, AMemoryLimitIs5)
{
    const Finished run =
        mote({"render", "scene.toml", "--memory-limit", "60MB", "--resolution", "4000x4000"});
    EXPECT_EQ(run.exit_code, 5) << run.err;
}

TEST_F(Failures, TheFirstSignalEndsCleanlyWith75)
{
    for (const int signal : {SIGTERM, SIGINT}) {
        RunningMote running(folder.path(), endless);
        ASSERT_TRUE(running.wait_for("\"begin\""));
        running.send(signal);
        const Finished run = running.wait();
        EXPECT_EQ(run.exit_code, 75) << run.err;
        EXPECT_TRUE(contains(run.err, "--existing skip")) << run.err;
        EXPECT_EQ(files_below(folder.path()), (Names{"scene.toml"}));
    }
}

TEST_F(Failures, ASignalBetweenFramesKeepsTheFinishedOnes)
{
    RunningMote running(folder.path(), {"render", "scene.toml", "--frames", "1-100000",
                                        "--progress", "json", "--aovs", "none"});
    ASSERT_TRUE(running.wait_for("\"frame\":3,"));
    running.send(SIGTERM);
    EXPECT_EQ(running.wait().exit_code, 75);
    const Names files = files_below(folder.path());
    ASSERT_GE(files.size(), 3u);
    for (const std::string& name : files) {
        if (name != "scene.toml") {
            EXPECT_TRUE(is_complete_exr(folder.file(name))) << name;
        }
    }
}

TEST_F(Failures, TheSecondSignalEndsAtOnce)
{
    // Preparing millions of particles takes seconds without asking for a stop, so the second
    // signal finds the run still busy.
    folder.write("scene.toml", R"(
[[particles]]
name = "dust"
emitter = "burst"
count = 20000000
[[volumes]]
particles = "dust"
)");
    Names arguments = endless;
    arguments.insert(arguments.end(), {"-vv", "--threads", "1"});
    RunningMote running(folder.path(), arguments);
    ASSERT_TRUE(running.wait_for("preparing frame 1"));
    running.send(SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    running.send(SIGTERM);
    EXPECT_EQ(running.wait().exit_code, 143);
    EXPECT_EQ(files_below(folder.path()), (Names{"scene.toml"}));
}

TEST_F(Failures, AKilledRunLeavesNoPartialFileAndTheNextOneCleansUp)
{
    // Kills at moments spread over a run; whatever is there must be whole.
    for (int i = 0; i < 8; ++i) {
        RunningMote running(folder.path(), {"render", "scene.toml", "--frames", "1-100000",
                                            "--progress", "json", "--existing", "skip"});
        ASSERT_TRUE(running.wait_for("\"begin\""));
        std::this_thread::sleep_for(std::chrono::milliseconds(7 * i));
        running.send(SIGKILL);
        EXPECT_EQ(running.wait().exit_code, -SIGKILL);
        for (const std::string& name : files_below(folder.path())) {
            if (name.substr(0, 5) == "out/0") {
                EXPECT_TRUE(is_complete_exr(folder.file(name))) << name;
            }
        }
    }
}

}  // namespace mote
