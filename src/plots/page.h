#pragma once

#include <string>

namespace mote {

/// Beginning of a self-contained HTML page in mote's style; `title` is plain text.
[[nodiscard]] std::string page_begin(const std::string& title);
[[nodiscard]] std::string page_end();

/// Text in a fixed-width font, lines kept.
[[nodiscard]] std::string preformatted(const std::string& text);

/// An <svg> element as a file of its own: with its name space and a white ground.
[[nodiscard]] std::string svg_file(const std::string& element);

}  // namespace mote
