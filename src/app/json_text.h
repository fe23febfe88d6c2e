#pragma once

#include <string>
#include <string_view>

namespace mote {

/// `text` as a JSON string literal, quotes included. Bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_quote(std::string_view text);

}  // namespace mote
