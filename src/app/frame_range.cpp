#include "app/frame_range.h"

#include <charconv>
#include <cmath>
#include <unordered_set>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

constexpr int64_t frame_limit = 100'000'000;

[[noreturn]] void refuse(std::string_view part, const std::string& why)
{
    throw Error(ExitCode::Usage,
                fmt::format("frames \"{}\": {}; write for example 1-48, 1-100x2 or 1,5,10-20",
                            printable(part, 60), why));
}

/// Reads an integer off the front of `rest`.
int64_t take_integer(std::string_view part, std::string_view& rest)
{
    int64_t value = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (error == std::errc::invalid_argument) {
        refuse(part, rest.empty()
                         ? "a frame number is missing"
                         : fmt::format("\"{}\" is not a whole frame number", printable(rest, 40)));
    }
    if (error == std::errc::result_out_of_range || value > frame_limit || value < -frame_limit) {
        refuse(part, fmt::format("frame numbers go up to {} in size", frame_limit));
    }
    rest.remove_prefix(static_cast<size_t>(end - rest.data()));
    return value;
}

struct Range {
    int64_t first, last, step;
};

Range parse_part(std::string_view part)
{
    if (part.find(':') != std::string_view::npos || part.find('y') != std::string_view::npos) {
        refuse(part,
               "the fill (y) and stagger (:) forms are not supported, they would render frames "
               "out of order");
    }
    std::string_view rest = part;
    Range range{take_integer(part, rest), 0, 1};
    range.last = range.first;
    if (rest.empty()) return range;
    if (rest.front() != '-') {
        refuse(part, fmt::format("unexpected \"{}\"", printable(rest, 40)));
    }
    rest.remove_prefix(1);
    range.last = take_integer(part, rest);
    if (rest.empty()) return range;
    if (rest.front() != 'x') {
        refuse(part, fmt::format("unexpected \"{}\"", printable(rest, 40)));
    }
    rest.remove_prefix(1);
    range.step = take_integer(part, rest);
    if (!rest.empty()) refuse(part, fmt::format("unexpected \"{}\"", printable(rest, 40)));
    if (range.step < 1) refuse(part, "the step after x must be 1 or more");
    return range;
}

}  // namespace

std::vector<int> parse_frames(std::string_view text)
{
    std::vector<int> frames;
    std::unordered_set<int> seen;
    constexpr std::string_view separators = ", \t\n";
    size_t begin = text.find_first_not_of(separators);
    while (begin != std::string_view::npos) {
        const size_t end = std::min(text.find_first_of(separators, begin), text.size());
        const std::string_view part = text.substr(begin, end - begin);
        const Range range = parse_part(part);
        const int64_t count = std::abs(range.last - range.first) / range.step + 1;
        if (count + static_cast<int64_t>(frames.size()) > max_frames) {
            refuse(part, fmt::format("more than {} frames", max_frames));
        }
        const int64_t step = range.last < range.first ? -range.step : range.step;
        for (int64_t i = 0; i < count; ++i) {
            const int frame = static_cast<int>(range.first + i * step);
            if (seen.insert(frame).second) frames.push_back(frame);
        }
        begin = text.find_first_not_of(separators, end);
    }
    if (frames.empty()) refuse(text, "the list is empty");
    return frames;
}

std::string format_frames(const std::vector<int>& frames)
{
    std::string text;
    for (size_t i = 0; i < frames.size();) {
        size_t end = i + 1;
        while (end < frames.size() && frames[end] == frames[end - 1] + 1) ++end;
        if (!text.empty()) text += ',';
        text += std::to_string(frames[i]);
        if (end - i > 1) text += fmt::format("{}{}", end - i > 2 ? '-' : ',', frames[end - 1]);
        i = end;
    }
    return text;
}

}  // namespace mote
