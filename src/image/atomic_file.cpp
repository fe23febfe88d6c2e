#include "image/atomic_file.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <filesystem>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason, const std::string& advice)
{
    throw Error(ExitCode::Output, fmt::format("cannot write \"{}\": {}; {}",
                                              printable(path.string(), 1000), reason, advice));
}

const char* remedy(int error_number)
{
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
            return "free some space or choose another folder";
        case EFBIG:
            return "raise the file size limit (ulimit -f) or choose a smaller output";
        case EROFS:
            return "the file system is read-only: choose another folder";
        case EACCES:
        case EPERM:
            return "check the permissions of the folder or choose another one";
        case ENOTDIR:
            return "a part of the path is a file, not a folder: choose another path";
        case ENAMETOOLONG:
            return "choose a shorter name";
        default:
            return "check the path and the disk";
    }
}

/// Name parts of a target's temporary files: prefix + pid + suffix.
struct TemporaryName {
    std::string prefix;
    std::string suffix;

    [[nodiscard]] std::string of(pid_t pid) const
    {
        return fmt::format("{}{}{}", prefix, pid, suffix);
    }
};

TemporaryName temporary_name(const fs::path& path)
{
    return {fmt::format(".{}.", path.stem().string()),
            fmt::format(".tmp{}", path.extension().string())};
}

/// Process id of a temporary file's writer; 0 if the name is no temporary of this target.
pid_t writer_of(const std::string& file, const TemporaryName& name)
{
    if (file.size() <= name.prefix.size() + name.suffix.size()) return 0;
    if (!file.starts_with(name.prefix) || !file.ends_with(name.suffix)) return 0;
    const char* begin = file.data() + name.prefix.size();
    const char* end = file.data() + file.size() - name.suffix.size();
    pid_t pid = 0;
    const auto [stop, error] = std::from_chars(begin, end, pid);
    return error == std::errc() && stop == end && pid > 0 ? pid : 0;
}

void remove_stale_temporaries(const fs::path& folder, const TemporaryName& name)
{
    std::error_code ignored;  // leftovers are a nuisance, never a reason to fail
    for (fs::directory_iterator it(folder, ignored), end; !ignored && it != end;
         it.increment(ignored)) {
        const pid_t pid = writer_of(it->path().filename().string(), name);
        if (pid == 0 || pid == ::getpid()) continue;
        if (::kill(pid, 0) == 0 || errno != ESRCH) continue;
        std::error_code not_removed;
        fs::remove(it->path(), not_removed);
    }
}

/// Flushes a file or folder to the disk; returns errno, or 0. Late write errors surface here.
int sync(const fs::path& path, int flags)
{
    const int file = ::open(path.c_str(), flags | O_CLOEXEC);
    if (file < 0) return errno;
    int error_number = ::fsync(file) == 0 ? 0 : errno;
    if (error_number == EINVAL || error_number == EROFS) error_number = 0;  // cannot be synced
    if (::close(file) != 0 && error_number == 0) error_number = errno;
    return error_number;
}

/// Removes the temporary file unless it was renamed.
struct TemporaryFile {
    explicit TemporaryFile(fs::path temporary_path) : path(std::move(temporary_path)) {}
    ~TemporaryFile()
    {
        std::error_code ignored;
        if (!renamed) fs::remove(path, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    fs::path path;
    bool renamed = false;
};

}  // namespace

void throw_output_error(const std::string& path, int error_number)
{
    fail(path, std::generic_category().message(error_number), remedy(error_number));
}

void write_atomically(const std::string& path,
                      const std::function<void(const std::string& temporary_path)>& write)
{
    const fs::path target(path);
    if (!target.has_filename()) fail(target, "the path names no file", "add a file name");
    const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
    std::error_code error;
    fs::create_directories(folder, error);
    if (error && !fs::is_directory(folder)) throw_output_error(path, error.value());
    const fs::file_status status = fs::status(target, error);
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        fail(target, fs::is_directory(status) ? "it is a folder" : "it is not a regular file",
             "choose another path");
    }

    const TemporaryName name = temporary_name(target);
    remove_stale_temporaries(folder, name);
    TemporaryFile temporary(folder / name.of(::getpid()));
    try {
        write(temporary.path.string());
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {
        fail(target, printable(e.what()), "check the path and the disk");
    }
    if (const int failed = sync(temporary.path, O_RDONLY)) throw_output_error(path, failed);
    if (::rename(temporary.path.c_str(), target.c_str()) != 0) throw_output_error(path, errno);
    temporary.renamed = true;
    if (const int failed = sync(folder, O_RDONLY | O_DIRECTORY)) throw_output_error(path, failed);
}

}  // namespace mote
