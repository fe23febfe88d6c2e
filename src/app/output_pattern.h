#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mote {

/// Whether a file pattern says where the frame number goes.
[[nodiscard]] bool has_frame_token(std::string_view pattern);

/// `pattern` with its frame tokens replaced: "####" and "$F4" and "%04d" and "{frame:04}" give four
/// digits, "$F" and "%d" and "{frame}" and "@" give one or more. The sign of a negative frame
/// counts as a digit, as in printf: "####" of -3 is "-003". One kind of token is in force per
/// pattern, the first of {frame} $F %d # @ that it holds; characters of the other kinds stay.
/// Throws Error(Usage) on a malformed {frame...} or on "%4d", which would put blanks into names.
[[nodiscard]] std::string expand_pattern(std::string_view pattern, int frame);

/// One path per frame. Throws Error(Usage) if several frames would share a file; `option` names
/// the setting in the message.
[[nodiscard]] std::vector<std::string> expand_pattern(std::string_view pattern,
                                                      const std::vector<int>& frames,
                                                      std::string_view option);

}  // namespace mote
