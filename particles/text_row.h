#pragma once

#include <charconv>
#include <limits>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {

/// One line of a text format, read number by number. Errors name file, line and column.
class TextRow {
  public:
    /// `separator` ' ' stands for any run of blanks.
    TextRow(const std::string& file, int line, std::string_view text, char separator = ' ')
        : file_(file), line_(line), text_(text), separator_(separator)
    {
    }

    /// False at the end of the line. Blanks around a token are removed.
    bool next(std::string_view& token)
    {
        if (separator_ == ' ') {
            begin_ = text_.find_first_not_of(" \t", end_);
            if (begin_ == std::string_view::npos) {
                begin_ = end_ = text_.size();
                return false;
            }
            end_ = std::min(text_.find_first_of(" \t", begin_), text_.size());
            token = text_.substr(begin_, end_ - begin_);
            return true;
        }
        if (is_done_) return false;
        size_t stop = std::min(text_.find(separator_, end_), text_.size());
        is_done_ = stop == text_.size();
        begin_ = end_;
        end_ = stop + 1;
        while (begin_ < stop && is_blank(text_[begin_])) ++begin_;
        while (stop > begin_ && is_blank(text_[stop - 1])) --stop;
        token = text_.substr(begin_, stop - begin_);
        return true;
    }

    [[nodiscard]] double number(std::string_view token) const
    {
        double value = 0.0;
        if (!parse(token, value)) {
            fail(fmt::format("\"{}\" is not a number", printable(token, 40)));
        }
        return value;
    }

    /// A whole token as a number, "nan" and "inf" included, whatever the locale.
    template <class Number>
    [[nodiscard]] static bool parse(std::string_view token, Number& value)
    {
        if (!token.empty() && token.front() == '+') token.remove_prefix(1);
        const char* end = token.data() + token.size();
        const auto [stop, error] = std::from_chars(token.data(), end, value);
        if (error == std::errc::invalid_argument || stop != end || token.empty()) return false;
        if (error == std::errc()) return true;
        value = std::numeric_limits<Number>::quiet_NaN();  // 1e999: read, and dropped later
        return std::numeric_limits<Number>::has_quiet_NaN;
    }

    [[noreturn]] void fail(const std::string& what) const
    {
        throw Error(ExitCode::Input, fmt::format("{}:{}:{}: {}", file_, line_, begin_ + 1, what));
    }

  private:
    static bool is_blank(char c) { return c == ' ' || c == '\t'; }

    const std::string& file_;
    int line_;
    std::string_view text_;
    char separator_;
    size_t begin_ = 0;
    size_t end_ = 0;
    bool is_done_ = false;
};

}  // namespace mote
