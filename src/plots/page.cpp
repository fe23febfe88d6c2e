#include "plots/page.h"

#include <algorithm>

#include <fmt/format.h>

#include "plots/svg.h"

namespace mote {

namespace {

constexpr const char* style = R"(
<style>
body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 62em; color: #222 }
h1 { font-size: 1.4em } h2 { font-size: 1.1em; margin-top: 2em }
pre { background: #f4f4f2; padding: 1em; overflow-x: auto; font-size: 12.5px }
figure { display: inline-block; margin: 0 1em 1em 0; vertical-align: top }
figure img { width: 420px; image-rendering: pixelated; border: 1px solid #ccc }
figcaption { max-width: 420px; font-size: 13px; color: #555 }
svg { margin: 0 1em 1em 0 } svg text { font-size: 11px; font-family: sans-serif }
.verdict { padding: .5em 1em; color: #fff }
</style></head><body>
)";

}  // namespace

std::string page_begin(const std::string& title)
{
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" +
           html_text(title) + "</title>" + style;
}

std::string page_end()
{
    return "</body></html>\n";
}

std::string preformatted(const std::string& text)
{
    std::string html = "<pre>";
    for (size_t begin = 0; begin < text.size();) {
        const size_t end = std::min(text.find('\n', begin), text.size());
        html += html_text(text.substr(begin, end - begin)) + "\n";
        begin = end + 1;
    }
    return html + "</pre>\n";
}

std::string svg_file(const std::string& element)
{
    const std::string begin = "<svg ";
    std::string file = element;
    if (file.compare(0, begin.size(), begin) == 0) {
        file.insert(begin.size(),
                    "xmlns=\"http://www.w3.org/2000/svg\" style=\"background:#fff\" "
                    "font-family=\"sans-serif\" font-size=\"11\" ");
    }
    return file + "\n";
}

}  // namespace mote
