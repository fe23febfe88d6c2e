#include "image/bare_jpeg.h"

#include <string_view>

#include "image/exr_check.h"

namespace mote {
namespace {

/// Second bytes of markers.
enum Marker : uint8_t {
    Baseline = 0xc0,
    Extended = 0xc1,
    Progressive = 0xc2,
    HuffmanTables = 0xc4,
    Restart0 = 0xd0,
    Restart7 = 0xd7,
    End = 0xd9,
    Scan = 0xda,
    QuantizationTables = 0xdb,
    RestartInterval = 0xdd,
    Jfif = 0xe0,
    Adobe = 0xee,
    Comment = 0xfe,
};

/// Scans of one file; usual are 1, and 10 of progressive ones. Each may visit every pixel, however
/// short it is.
constexpr int most_scans = 64;

bool is_frame(uint8_t marker)
{
    return marker >= 0xc0 && marker <= 0xcf && marker != HuffmanTables && marker != 0xc8 &&
           marker != 0xcc;
}

/// What a segment's content is, to those who may skip it.
bool starts_with(std::span<const uint8_t> segment, std::string_view text)
{
    return std::string_view(reinterpret_cast<const char*>(segment.data()), segment.size())
        .starts_with(text);
}

/// Why a frame's header is not read; null if it is.
const char* refusal(uint8_t marker, std::span<const uint8_t> frame)
{
    if (marker > Progressive) return "only baseline and progressive JPEG are read";
    if (frame.size() < 6) return "its header is damaged";
    const int height = frame[1] << 8 | frame[2];
    const int width = frame[3] << 8 | frame[4];
    const int components = frame[5];
    if (frame[0] != 8) return "only JPEG of 8 bits is read";
    if (width < 1 || height < 1 || int64_t{width} > max_image_pixels / height) {
        return "its size is not supported (limit: 2^28 pixels)";
    }
    if (components != 1 && components != 3) return "it is neither grey nor RGB; convert it to RGB";
    return nullptr;
}

}  // namespace

std::vector<uint8_t> bare_jpeg(std::span<const uint8_t> file, std::string& error)
{
    std::vector<uint8_t> bare = {0xff, 0xd8};
    const auto fail = [&](const char* reason) {
        error = reason;
        return std::vector<uint8_t>{};
    };
    constexpr const char* too_short = "it ends too early";
    int frames = 0;
    int scans = 0;
    size_t at = 2;  // after the start marker, which the caller has checked
    while (true) {
        if (at + 2 > file.size()) return fail(too_short);
        if (file[at] != 0xff) return fail("it is damaged");
        const uint8_t marker = file[at + 1];
        if (marker == 0xff) {  // padding
            ++at;
            continue;
        }
        if (marker == End) break;
        if (at + 4 > file.size()) return fail(too_short);
        const size_t length = static_cast<size_t>(file[at + 2] << 8 | file[at + 3]);
        if (length < 2) return fail("it is damaged");
        if (at + 2 + length > file.size()) return fail(too_short);
        const std::span<const uint8_t> content = file.subspan(at + 4, length - 2);
        size_t end = at + 2 + length;
        if (is_frame(marker)) {
            if (++frames > 1) return fail("it holds more than one picture");
            if (const char* reason = refusal(marker, content)) return fail(reason);
        }
        if (marker == Scan) {
            if (++scans > most_scans) return fail("it has more than 64 scans; save it anew");
            // Coded pixels, up to the next marker but for restarts and stuffed zeros.
            const auto goes_on = [&](uint8_t next) {
                return next == 0 || (next >= Restart0 && next <= Restart7);
            };
            while (end + 2 <= file.size() && (file[end] != 0xff || goes_on(file[end + 1]))) ++end;
        }
        const bool is_needed =
            is_frame(marker) || marker == HuffmanTables || marker == Scan ||
            marker == QuantizationTables || marker == RestartInterval ||
            (marker == Jfif && starts_with(content, std::string_view("JFIF\0", 5))) ||
            (marker == Adobe && starts_with(content, "Adobe"));
        const bool is_known = is_needed || marker == Comment || (marker >= 0xe0 && marker <= 0xef);
        if (!is_known) return fail("only baseline and progressive JPEG are read");
        if (is_needed) {
            bare.insert(bare.end(), file.begin() + static_cast<std::ptrdiff_t>(at),
                        file.begin() + static_cast<std::ptrdiff_t>(end));
        }
        at = end;
    }
    if (frames == 0 || scans == 0) return fail("it holds no picture");
    bare.insert(bare.end(), {0xff, End});
    return bare;
}

}  // namespace mote
