#include <gtest/gtest.h>

#include <csignal>

#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "core/rng.h"
#include "image/atomic_file.h"
#include "image/exr.h"
#include "image/output_file.h"
#include "image/png.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace mote {
namespace {

void write_text(const std::string& path, const std::string& text)
{
    write_atomically(path, [&](const std::string& temporary) {
        OutputFile file(temporary, path);
        file.write(text.data(), text.size());
        file.finish();
    });
}

/// Exit status of f() in a child process: 0 if it returns true. f must not use thread pools.
template <class F>
int in_child(F&& f)
{
    const pid_t child = ::fork();
    if (child == 0) {
        bool good = false;
        try {
            good = f();
        } catch (...) {
        }
        ::_exit(good ? 0 : 1);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// No file of this process grows beyond the limit while it lives.
struct FileSizeLimit {
    explicit FileSizeLimit(rlim_t bytes)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before);
        const rlimit limit{bytes, before.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit()
    {
        ::setrlimit(RLIMIT_FSIZE, &before);
        std::signal(SIGXFSZ, SIG_DFL);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

    rlimit before{};
};

LayeredImage noise_image(int size)
{
    LayeredImage image{size, size, {}, {}};
    Channel channel{"Y", PixelType::Float, Buffer2D<float>(size, size)};
    Rng rng(1, 0, Stream::Test, 0, 0);
    for (float& v : channel.data) v = rng.uniform();
    image.channels.push_back(channel);
    return image;
}

TEST(AtomicFile, ReplacesTheFileAndLeavesNothingBehind)
{
    const TemporaryFolder folder;
    const std::string path = folder.file("sub/folder/a.txt");
    write_text(path, "old");
    write_text(path, "new");
    EXPECT_EQ(read_bytes(path), "new");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("sub/folder")), {}), 1);
}

TEST(AtomicFile, TemporaryIsInTheSameFolderAndKeepsTheExtension)
{
    const TemporaryFolder folder;
    write_atomically(folder.file("frame.0001.exr"), [&](const std::string& temporary) {
        const std::filesystem::path name(temporary);
        EXPECT_EQ(name.parent_path().string(), folder.path());
        EXPECT_EQ(name.filename().string(),
                  ".frame.0001." + std::to_string(::getpid()) + ".tmp.exr");
        write_bytes(temporary, "x");
    });
}

TEST(AtomicFile, FailureInTheMiddleKeepsTheOldFile)
{
    const TemporaryFolder folder;
    const std::string path = folder.file("a.exr");
    write_text(path, "old");
    expect_error(
        [&] {
            write_atomically(path, [](const std::string& temporary) {
                write_bytes(temporary, "half of the new");
                throw std::runtime_error("codec gave up");
            });
        },
        ExitCode::Output, {"a.exr", "codec gave up"});
    EXPECT_EQ(read_bytes(path), "old");
    EXPECT_EQ(folder.entries().size(), 1u);
}

TEST(AtomicFile, RefusesFoldersAndSpecialFiles)
{
    const TemporaryFolder folder;
    const std::string inner = folder.file("frames.exr");
    std::filesystem::create_directory(inner);
    expect_error([&] { write_text(inner, "x"); }, ExitCode::Output, {"frames.exr", "is a folder"});
    expect_error([&] { write_text("/dev/null", "x"); }, ExitCode::Output, {"not a regular file"});
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    expect_error([&] { write_text(folder.file(""), "x"); }, ExitCode::Output, {"add a file name"});
}

TEST(AtomicFile, PathUnderAFileNamesTheReason)
{
    const TemporaryFolder folder;
    write_bytes(folder.file("plain"), "x");
    expect_error([&] { write_text(folder.file("plain/a.exr"), "x"); }, ExitCode::Output,
                 {"plain/a.exr", "Not a directory", "choose another path"});
}

TEST(AtomicFile, FolderWithoutPermissionNamesTheReason)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.file("locked"));
    write_bytes(folder.file("locked/a.txt"), "old");
    std::filesystem::permissions(folder.file("locked"), std::filesystem::perms(0555));
    // The superuser may write anywhere, so the child drops to an ordinary user.
    const int status = in_child([&] {
        std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
        if (::getuid() == 0 && ::setuid(65534) != 0) return false;
        try {
            write_text(folder.file("locked/a.txt"), "new");
        } catch (const Error& error) {
            const std::string message = error.what();
            return error.code() == ExitCode::Output &&
                   message.find("Permission denied") != std::string::npos;
        }
        return false;
    });
    EXPECT_EQ(status, 0);
    EXPECT_EQ(read_bytes(folder.file("locked/a.txt")), "old");
    std::filesystem::permissions(folder.file("locked"), std::filesystem::perms(0755));
}

TEST(AtomicFile, FileSizeLimitLeavesTheOldImages)
{
    const TemporaryFolder folder;
    const std::string exr = folder.file("a.exr");
    const std::string png = folder.file("a.png");
    const Buffer2D<Spectrum> grey(64, 64, Spectrum(0.5f));
    write_exr(exr, noise_image(8), ExrCompression::None);
    write_png(png, grey, {});
    const std::string old_exr = read_bytes(exr);
    const std::string old_png = read_bytes(png);
    {
        const FileSizeLimit limit(60);  // bytes: less than either file
        expect_error([&] { write_exr(exr, noise_image(256), ExrCompression::Zip); },
                     ExitCode::Output, {"a.exr", "File too large"});
        expect_error([&] { write_png(png, grey, {}); }, ExitCode::Output,
                     {"a.png", "File too large"});
    }
    EXPECT_EQ(read_bytes(exr), old_exr);
    EXPECT_EQ(read_bytes(png), old_png);
    EXPECT_EQ(folder.entries().size(), 2u);
}

TEST(AtomicFile, FullDiskLeavesTheOldImage)
{
    const TemporaryFolder folder;
    const std::string disk = folder.file("disk");
    std::filesystem::create_directory(disk);
    if (::mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0) {
        GTEST_SKIP() << "needs the right to mount";
    }
    const std::string path = disk + "/a.exr";
    write_exr(path, noise_image(64), ExrCompression::Zip);
    const std::string old = read_bytes(path);
    for (const ExrCompression compression : {ExrCompression::None, ExrCompression::Zip}) {
        expect_error([&] { write_exr(path, noise_image(1024), compression); }, ExitCode::Output,
                     {"a.exr", "No space left on device", "free some space"});
    }
    EXPECT_EQ(read_bytes(path), old);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(disk), {}), 1);
    ::umount2(disk.c_str(), MNT_DETACH);
}

TEST(AtomicFile, RemovesTemporariesOfDeadProcessesOnly)
{
    const TemporaryFolder folder;
    pid_t dead = 0;
    {
        dead = ::fork();
        if (dead == 0) ::_exit(0);
        ::waitpid(dead, nullptr, 0);
    }
    const std::string stale = folder.file(".a." + std::to_string(dead) + ".tmp.exr");
    const std::string living = folder.file(".a." + std::to_string(::getppid()) + ".tmp.exr");
    const std::string other = folder.file(".ab." + std::to_string(dead) + ".tmp.exr");
    const std::string user = folder.file(".a.notes.tmp.exr");
    for (const std::string& file : {stale, living, other, user}) write_bytes(file, "x");
    write_text(folder.file("a.exr"), "new");
    EXPECT_FALSE(std::filesystem::exists(stale));
    EXPECT_TRUE(std::filesystem::exists(living));
    EXPECT_TRUE(std::filesystem::exists(other));
    EXPECT_TRUE(std::filesystem::exists(user));
}

TEST(OutputFile, KeepsTheFirstErrorForFinish)
{
    // /dev/full takes the open and refuses every byte.
    OutputFile file("/dev/full", "a.exr");
    const std::string bytes(1 << 20, 'x');
    file.write(bytes.data(), bytes.size());
    EXPECT_TRUE(file.failed());
    expect_error([&] { file.finish(); }, ExitCode::Output, {"a.exr", "No space left on device"});
}

}  // namespace
}  // namespace mote
