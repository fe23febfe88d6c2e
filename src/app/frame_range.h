#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// Most frames one command may name.
inline constexpr int max_frames = 1'000'000;

/// Frames of a list such as "1-48", "1-100x2,120 130-140", "-8--5" or "10-1": `a`, `a-b` and
/// `a-bxN` separated by commas or blanks, any of them negative. In the order written, each frame
/// once. Throws Error(Usage) that quotes the part at fault.
[[nodiscard]] std::vector<int> parse_frames(std::string_view text);

/// The inverse, shortened to ranges: {1,2,3,7} is "1-3,7".
[[nodiscard]] std::string format_frames(const std::vector<int>& frames);

}  // namespace mote
