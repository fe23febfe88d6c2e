#include "image/exr_check.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include <fmt/core.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {
namespace {

/// Sequential reader of a little-endian header with a hard end.
class HeaderReader {
  public:
    explicit HeaderReader(const std::string& path) : path_(path)
    {
        std::error_code error;
        if (std::filesystem::is_directory(path, error)) fail("is a folder, not an image");
        file_.open(path, std::ios::binary | std::ios::ate);
        if (!file_) fail(std::generic_category().message(errno));
        size_ = static_cast<int64_t>(file_.tellg());
        file_.seekg(0);
    }

    [[noreturn]] void fail(const std::string& reason) const
    {
        throw Error(ExitCode::Input,
                    fmt::format("cannot read \"{}\": {}", printable(path_, 1000), reason));
    }
    [[noreturn]] void damaged(const std::string& what) const
    {
        fail(fmt::format("the OpenEXR file is damaged ({}); write it again", what));
    }

    [[nodiscard]] int64_t size() const { return size_; }
    [[nodiscard]] int64_t remaining() { return size_ - static_cast<int64_t>(file_.tellg()); }

    void read(void* out, int64_t count)
    {
        if (count > remaining()) damaged("the header ends early");
        if (!file_.read(static_cast<char*>(out), count)) damaged("the header cannot be read");
    }
    template <class T>
    T read()
    {
        T value{};
        read(&value, sizeof value);
        return value;
    }
    /// Null-terminated text of at most 255 bytes.
    std::string read_name()
    {
        std::string name;
        for (char c = read<char>(); c != '\0'; c = read<char>()) {
            if (name.size() == 255) damaged("a name is too long");
            name += c;
        }
        return name;
    }
    void skip(int64_t count)
    {
        if (count > remaining()) damaged("an attribute is larger than the file");
        file_.seekg(count, std::ios::cur);
    }

  private:
    std::string path_;
    std::ifstream file_;
    int64_t size_ = 0;
};

/// Bytes of pixels that one byte of file can hold at most, by compression code. Deflate reaches
/// 1032, run lengths 64, PIZ's Huffman runs some hundreds, B44 11; DWA is practically unbounded.
int64_t largest_ratio(uint8_t compression)
{
    switch (compression) {
        case 0:
            return 1;  // none
        case 1:
            return 128;  // RLE
        case 2:
        case 3:
        case 5:
            return 1100;  // ZIPS, ZIP, PXR24
        case 4:
            return 4096;  // PIZ
        case 6:
        case 7:
            return 16;  // B44, B44A
        default:
            return int64_t{1} << 20;
    }
}

/// Channel list: name, pixel type, four flag bytes, x and y sampling; ends with an empty name.
int64_t count_channels(HeaderReader& reader, int64_t& bytes_per_pixel)
{
    int64_t count = 0;
    while (!reader.read_name().empty()) {
        const auto type = reader.read<uint32_t>();
        if (type > 2) reader.damaged("unknown pixel type");
        bytes_per_pixel += type == 1 ? 2 : 4;
        reader.skip(12);
        if (++count > 4096) reader.fail("it has more than 4096 channels");
    }
    return count;
}

void check_window(HeaderReader& reader, ExrOutline& outline)
{
    int32_t box[4];
    reader.read(box, sizeof box);
    outline.width = int64_t{box[2]} - box[0] + 1;
    outline.height = int64_t{box[3]} - box[1] + 1;
    if (outline.width < 1 || outline.height < 1) reader.damaged("its data window is empty");
    const bool far_out =
        std::abs(int64_t{box[0]}) > (1 << 30) || std::abs(int64_t{box[1]}) > (1 << 30);
    if (far_out) reader.damaged("its data window is out of range");
    if (outline.width > max_image_pixels / outline.height) {
        reader.fail(
            fmt::format("its data window of {} x {} pixels is over the limit of 2^28; the "
                        "file is damaged or must be cropped or scaled down",
                        outline.width, outline.height));
    }
}

}  // namespace

ExrOutline check_exr(const std::string& path)
{
    HeaderReader reader(path);
    constexpr unsigned char magic[4] = {0x76, 0x2f, 0x31, 0x01};
    unsigned char start[4] = {};
    if (reader.size() >= 8) reader.read(start, sizeof start);
    if (std::memcmp(start, magic, sizeof magic) != 0) reader.fail("it is not an OpenEXR file");
    const auto version = reader.read<uint32_t>();
    if ((version & 0xffu) != 2u) reader.damaged("unknown version");
    if ((version & 0x1800u) != 0u) {
        reader.fail(
            "multi-part and deep OpenEXR files are not supported; save a flat, single-part "
            "file");
    }

    ExrOutline outline;
    int64_t bytes_per_pixel = 0;
    uint8_t compression = 0;
    for (int attributes = 0;; ++attributes) {
        if (attributes > 10'000) reader.damaged("too many attributes");
        const std::string name = reader.read_name();
        if (name.empty()) break;
        const std::string type = reader.read_name();
        const auto size = reader.read<int32_t>();
        const int64_t end = reader.size() - reader.remaining() + size;
        if (size < 0 || size > reader.remaining()) {
            reader.damaged("an attribute is larger than the file");
        }
        if (name == "dataWindow" && size == 16) {
            check_window(reader, outline);
        } else if (name == "channels") {
            outline.channel_count = count_channels(reader, bytes_per_pixel);
        } else if (name == "compression" && size == 1) {
            compression = reader.read<uint8_t>();
        } else if (name == "tiles" && size == 9) {
            const auto x = reader.read<uint32_t>();
            const auto y = reader.read<uint32_t>();
            if (x < 1 || y < 1 || x > 16384 || y > 16384) reader.damaged("tile size out of range");
        }
        const int64_t position = reader.size() - reader.remaining();
        if (position > end) reader.damaged("an attribute is too short");
        reader.skip(end - position);
    }
    if (outline.width == 0) reader.damaged("it has no data window");
    if (outline.channel_count == 0) reader.fail("it has no channels");
    const int64_t pixels = outline.width * outline.height;
    if (pixels > max_image_values / outline.channel_count) {
        reader.fail(
            fmt::format("{} x {} pixels in {} channels are over the limit of 2^30 values; "
                        "the file is damaged or must be cropped or scaled down",
                        outline.width, outline.height, outline.channel_count));
    }
    const int64_t largest = largest_ratio(compression) * reader.size();
    if (pixels * bytes_per_pixel > largest) {
        reader.damaged(fmt::format("its {} x {} pixels cannot fit into {}", outline.width,
                                   outline.height,
                                   format_bytes(static_cast<double>(reader.size()))));
    }
    return outline;
}

}  // namespace mote
