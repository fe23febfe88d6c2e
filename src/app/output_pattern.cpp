#include "app/output_pattern.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

constexpr int max_width = 20;

/// A frame token at the front of some text.
struct Token {
    size_t length = 0;
    int width = 1;
};

[[noreturn]] void refuse(std::string_view pattern, const std::string& why)
{
    throw Error(ExitCode::Usage, fmt::format("file pattern \"{}\": {}", printable(pattern), why));
}

bool is_digit(char c)
{
    return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

/// Decimal digits from `begin`; `end` is set behind them.
int read_width(std::string_view text, size_t begin, size_t& end)
{
    int width = 0;
    for (end = begin; end < text.size() && is_digit(text[end]); ++end) {
        width = std::min(10 * width + (text[end] - '0'), max_width + 1);
    }
    return width;
}

std::optional<Token> braces_at(std::string_view text, std::string_view pattern)
{
    constexpr std::string_view opening = "{frame";
    if (text.substr(0, opening.size()) != opening) return {};
    size_t end = opening.size();
    int width = 1;
    if (end < text.size() && text[end] == ':') width = read_width(text, end + 1, end);
    if (end >= text.size() || text[end] != '}') {
        refuse(pattern, "write {frame} or {frame:04}");
    }
    return Token{end + 1, width};
}

std::optional<Token> dollar_at(std::string_view text, std::string_view)
{
    if (text.substr(0, 2) != "$F") return {};
    size_t end = 2;
    const int width = read_width(text, 2, end);
    return Token{end, std::max(1, width)};
}

std::optional<Token> percent_at(std::string_view text, std::string_view pattern)
{
    if (text.empty() || text[0] != '%') return {};
    size_t end = 1;
    const int width = read_width(text, 1, end);
    if (end >= text.size() || text[end] != 'd') return {};
    if (width > 0 && text[1] != '0') {
        refuse(pattern, fmt::format("%{0}d would put blanks into names; write %0{0}d", width));
    }
    return Token{end + 1, std::max(1, width)};
}

/// A run of `mark`, one digit each.
std::optional<Token> run_at(std::string_view text, char mark)
{
    const size_t length = std::min(text.find_first_not_of(mark), text.size());
    if (length == 0) return {};
    return Token{length, static_cast<int>(std::min<size_t>(length, max_width + 1))};
}

std::optional<Token> hashes_at(std::string_view text, std::string_view)
{
    return run_at(text, '#');
}

std::optional<Token> at_signs_at(std::string_view text, std::string_view)
{
    return run_at(text, '@');
}

using TokenReader = std::optional<Token> (*)(std::string_view text, std::string_view pattern);
constexpr TokenReader readers[] = {braces_at, dollar_at, percent_at, hashes_at, at_signs_at};

/// The reader of the kind of token in force; null if the pattern has none.
TokenReader reader_of(std::string_view pattern)
{
    for (const TokenReader reader : readers) {
        for (size_t i = 0; i < pattern.size(); ++i) {
            if (reader(pattern.substr(i), pattern)) return reader;
        }
    }
    return nullptr;
}

}  // namespace

bool has_frame_token(std::string_view pattern)
{
    return reader_of(pattern) != nullptr;
}

std::string expand_pattern(std::string_view pattern, int frame)
{
    const TokenReader reader = reader_of(pattern);
    if (reader == nullptr) return std::string(pattern);
    std::string path;
    for (size_t i = 0; i < pattern.size();) {
        if (const auto token = reader(pattern.substr(i), pattern)) {
            if (token->width > max_width) {
                refuse(pattern, fmt::format("more than {} digits for a frame", max_width));
            }
            path += fmt::format("{:0{}}", frame, token->width);
            i += token->length;
        } else {
            path += pattern[i++];
        }
    }
    return path;
}

std::vector<std::string> expand_pattern(std::string_view pattern, const std::vector<int>& frames,
                                        std::string_view option)
{
    if (frames.size() > 1 && !has_frame_token(pattern)) {
        throw Error(ExitCode::Usage,
                    fmt::format("{} \"{}\" has no place for the frame number, so {} frames would "
                                "overwrite each other; put #### into it",
                                option, printable(pattern), frames.size()));
    }
    std::vector<std::string> paths;
    paths.reserve(frames.size());
    for (const int frame : frames) paths.push_back(expand_pattern(pattern, frame));
    return paths;
}

}  // namespace mote
