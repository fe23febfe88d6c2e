#include "particles/sequence.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

namespace fs = std::filesystem;

/// A file name cut at its frame token.
struct FrameName {
    std::string prefix;
    std::string suffix;
    int width = 0;  ///< digits, zero padded

    [[nodiscard]] std::string at(int frame) const
    {
        return fmt::format("{}{:0{}d}{}", prefix, frame, width, suffix);
    }
};

bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/// Reads up to two digits of padding at `pos` and moves past them.
int read_width(std::string_view text, size_t& pos)
{
    int width = 0;
    for (int digits = 0; digits < 2 && pos < text.size() && is_digit(text[pos]); ++digits) {
        width = 10 * width + (text[pos++] - '0');
    }
    return width;
}

/// The token's [begin, end) and padding, or empty when the character at `begin` starts none.
std::optional<FrameName> token_at(std::string_view name, size_t begin)
{
    size_t end = begin + 1;
    int width = 0;
    if (name[begin] == '#') {
        while (end < name.size() && name[end] == '#') ++end;
        width = static_cast<int>(std::min<size_t>(end - begin, 99));
    } else if (name[begin] == '%') {
        width = read_width(name, end);
        if (end >= name.size() || name[end] != 'd') return std::nullopt;
        ++end;
    } else if (name.substr(begin, 2) == "$F") {
        end = begin + 2;
        width = read_width(name, end);
    } else {
        return std::nullopt;
    }
    return FrameName{std::string(name.substr(0, begin)), std::string(name.substr(end)), width};
}

std::optional<FrameName> find_token(std::string_view name)
{
    for (size_t i = 0; i < name.size(); ++i) {
        if (auto found = token_at(name, i)) return found;
    }
    return std::nullopt;
}

fs::path full_path(const SequenceParams& sequence, const std::string& base_dir)
{
    const fs::path pattern(sequence.pattern);
    if (pattern.filename().empty()) {
        throw Error(ExitCode::Input, fmt::format("\"{}\" is not a file name or sequence pattern",
                                                 printable(sequence.pattern)));
    }
    return pattern.is_absolute() || base_dir.empty() ? pattern : fs::path(base_dir) / pattern;
}

FrameName require_one_token(const fs::path& path, const FrameName& name)
{
    if (find_token(path.parent_path().string()) || find_token(name.suffix)) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: one frame token only, and in the file name, not the folder",
                                printable(path.string())));
    }
    return name;
}

/// Frame number of a file of the sequence; empty for other files.
std::optional<int> frame_of(const std::string& file, const FrameName& name)
{
    if (file.size() <= name.prefix.size() + name.suffix.size()) return std::nullopt;
    if (!file.starts_with(name.prefix) || !file.ends_with(name.suffix)) return std::nullopt;
    const char* begin = file.data() + name.prefix.size();
    const char* end = file.data() + file.size() - name.suffix.size();
    int frame = 0;
    const auto [stop, error] = std::from_chars(begin, end, frame);
    if (error != std::errc() || stop != end || name.at(frame) != file) return std::nullopt;
    return frame;
}

FrameRange scan_folder(const fs::path& path, const FrameName& name, int first)
{
    std::optional<FrameRange> range;
    std::error_code error;
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        const auto frame = frame_of(entry.path().filename().string(), name);
        if (!frame || *frame < first) continue;
        if (!range) range = FrameRange{*frame, *frame};
        range->first = std::min(range->first, *frame);
        range->last = std::max(range->last, *frame);
    }
    if (error) {
        throw Error(ExitCode::Input, fmt::format("{}: cannot read the folder: {}",
                                                 printable(folder.string()), error.message()));
    }
    if (!range) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: no file of this sequence from frame {} on; check the path, "
                                "the padding and `first`",
                                printable(path.string()), first));
    }
    return *range;
}

FrameRange range_of(const SequenceParams& sequence, const fs::path& path, const FrameName& name)
{
    if (sequence.last >= sequence.first) return {sequence.first, sequence.last};
    return scan_folder(path, name, sequence.first);
}

/// File frame for a scene frame, or empty where hidden.
std::optional<int> file_frame(int64_t frame, FrameRange range, OutsideRange outside)
{
    if (frame >= range.first && frame <= range.last) return static_cast<int>(frame);
    if (outside == OutsideRange::Hide) return std::nullopt;
    if (outside == OutsideRange::Hold) return frame < range.first ? range.first : range.last;
    const int64_t length = int64_t{range.last} - range.first + 1;
    const int64_t phase = (frame - range.first) % length;
    return static_cast<int>(range.first + (phase < 0 ? phase + length : phase));
}

}  // namespace

std::optional<FrameRange> sequence_range(const SequenceParams& sequence,
                                         const std::string& base_dir)
{
    const fs::path path = full_path(sequence, base_dir);
    const auto token = find_token(path.filename().string());
    if (!token) return std::nullopt;
    return range_of(sequence, path, require_one_token(path, *token));
}

std::optional<std::string> sequence_path(const SequenceParams& sequence, int scene_frame,
                                         const std::string& base_dir)
{
    const fs::path path = full_path(sequence, base_dir);
    const auto token = find_token(path.filename().string());
    if (!token) return path.string();
    const FrameName name = require_one_token(path, *token);
    const auto frame = file_frame(int64_t{scene_frame} + sequence.offset,
                                  range_of(sequence, path, name), sequence.outside);
    if (!frame) return std::nullopt;
    return (path.parent_path() / name.at(*frame)).string();
}

std::optional<std::string> resolve_sequence(const SequenceParams& sequence, int scene_frame,
                                            const std::string& base_dir)
{
    auto path = sequence_path(sequence, scene_frame, base_dir);
    std::error_code error;
    if (!path || fs::is_regular_file(*path, error)) return path;
    if (fs::exists(*path, error)) {
        throw Error(ExitCode::Input, fmt::format("{}: not a regular file", printable(*path)));
    }
    const auto range = sequence_range(sequence, base_dir);
    if (!range) {
        throw Error(ExitCode::Input, fmt::format("{}: no such file; relative paths start at the "
                                                 "scene file's folder",
                                                 printable(*path)));
    }
    throw Error(ExitCode::Input,
                fmt::format("{}: missing from the sequence of frames {} to {} (scene frame {}); "
                            "write the file or set `first` and `last`",
                            printable(*path), range->first, range->last, scene_frame));
}

}  // namespace mote
