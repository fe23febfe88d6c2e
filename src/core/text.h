#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// " (did you mean \"x\"?)" for the entry of `known` nearest to `word` by edit distance, or "" when
/// none is near enough to be meant.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known);

/// Third-party or file text made safe for one line of a message: valid UTF-8, with a "?" for each
/// control character and each byte that belongs to no character, and "..." in place of what goes
/// beyond `max_length` bytes.
[[nodiscard]] std::string printable(std::string_view text, size_t max_length = 200);

/// "1.5 GB" from a byte count.
[[nodiscard]] std::string format_bytes(double bytes);

/// The entries of a list by comma, in order; empty entries are dropped.
[[nodiscard]] std::vector<std::string> split_list(std::string_view list);

}  // namespace mote
