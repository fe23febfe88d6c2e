#include "particles/input_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>

#include "core/error.h"

namespace mote {

InputFile::InputFile(const std::string& path) : path_(path), window_(2 * max_take)
{
    descriptor_ = open(path.c_str(), O_RDONLY | O_CLOEXEC);
    struct stat info {};
    if (descriptor_ < 0 || fstat(descriptor_, &info) != 0) {
        const int reason = errno;
        if (descriptor_ >= 0) close(descriptor_);
        throw Error(ExitCode::Input, fmt::format("{}: {}", path, std::strerror(reason)));
    }
    if (!S_ISREG(info.st_mode)) {
        close(descriptor_);
        throw Error(ExitCode::Input, fmt::format("{}: not a regular file", path));
    }
    size_ = static_cast<uint64_t>(info.st_size);
}

InputFile::~InputFile()
{
    close(descriptor_);
}

void InputFile::fill(size_t count)
{
    if (end_ - begin_ >= count) return;
    std::memmove(window_.data(), window_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    while (end_ < count) {
        const ssize_t got = read(descriptor_, window_.data() + end_, window_.size() - end_);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            throw Error(ExitCode::Input, fmt::format("{}: {}", path_, std::strerror(errno)));
        }
        if (got == 0) return;
        end_ += static_cast<size_t>(got);
    }
}

const unsigned char* InputFile::take(size_t count)
{
    fill(count);
    if (end_ - begin_ < count) {
        throw Error(ExitCode::Input, fmt::format("{}: truncated: it ends at byte {}", path_,
                                                 position_ + (end_ - begin_)));
    }
    const unsigned char* bytes = window_.data() + begin_;
    begin_ += count;
    position_ += count;
    return bytes;
}

void InputFile::skip(uint64_t count)
{
    while (count > 0) {
        const auto step = static_cast<size_t>(std::min<uint64_t>(count, max_take));
        take(step);
        count -= step;
    }
}

bool InputFile::next_line(std::string_view& line)
{
    size_t length = 0;
    for (size_t wanted = 4096;; wanted = 2 * max_take) {
        fill(wanted);
        const auto* text = reinterpret_cast<const char*>(window_.data() + begin_);
        const size_t there = std::min(end_ - begin_, max_take);
        const void* newline = std::memchr(text, '\n', there);
        if (newline) {
            length = static_cast<size_t>(static_cast<const char*>(newline) - text) + 1;
            break;
        }
        if (end_ - begin_ < std::min(wanted, max_take)) {  // the last line has no end
            length = there;
            break;
        }
        if (wanted >= max_take) {
            throw Error(ExitCode::Input, fmt::format("{}:{}:1: a line of more than {} bytes", path_,
                                                     line_number_ + 1, max_take));
        }
    }
    if (length == 0) return false;
    line = {reinterpret_cast<const char*>(window_.data() + begin_), length};
    begin_ += length;
    position_ += length;
    ++line_number_;
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    return true;
}

}  // namespace mote
