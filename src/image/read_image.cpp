#include "image/read_image.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>
#include <vector>

#include <dlfcn.h>

#include <fmt/core.h>

#include "core/error.h"
#include "core/file_name.h"
#include "core/text.h"
#include "image/bare_jpeg.h"
#include "image/color.h"
#include "image/exr_check.h"
#include "image/oiio_plugin.h"

namespace mote {
namespace {

namespace fs = std::filesystem;

/// An image format that may be read. To add one, think of who feeds its parser.
struct Format {
    std::string_view extension;
    std::string_view magic;  ///< first bytes of every such file
    const char* reader;      ///< OpenImageIO's name
    const char* shown_name;
};

constexpr Format exr{".exr", "\x76\x2f\x31\x01", "openexr", "OpenEXR"};
constexpr Format hdr{".hdr", "#?", "hdr", "Radiance HDR"};
constexpr Format png{".png", "\x89PNG\r\n\x1a\n", "png", "PNG"};
constexpr Format jpeg{".jpg", "\xff\xd8\xff", "jpeg", "JPEG"};
constexpr Format jpeg_by_long_name{".jpeg", jpeg.magic, jpeg.reader, jpeg.shown_name};
constexpr std::array formats{&exr, &hdr, &png, &jpeg, &jpeg_by_long_name};

/// JPEG files larger than this are none of pictures that could be read.
constexpr std::streamoff most_jpeg_bytes = std::streamoff{1} << 30;

[[noreturn]] void fail(const std::string& path, const std::string& reason)
{
    throw Error(ExitCode::Input,
                fmt::format("cannot read \"{}\": {}", printable(path, 1000), reason));
}

const Format& format_of(const ImageSource& source)
{
    const std::string& path = source.path;
    if (!source.bytes.empty()) {
        const std::string_view bytes(reinterpret_cast<const char*>(source.bytes.data()),
                                     source.bytes.size());
        for (const Format* format : {&png, &jpeg}) {
            if (bytes.starts_with(format->magic)) return *format;
        }
        fail(path, "only PNG and JPEG images may be inside of other files; convert it to PNG");
    }
    const std::string extension = lower_extension(path);
    for (const Format* format : formats) {
        if (format->extension == extension) return *format;
    }
    fail(path, "only .exr, .hdr, .png and .jpg images are read; convert it to one of them");
}

/// First bytes of a file.
std::string start_of(const std::string& path)
{
    std::error_code error;
    if (fs::is_directory(path, error)) fail(path, "it is a folder, not an image");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, std::generic_category().message(errno));
    std::array<char, 8> start{};
    file.read(start.data(), start.size());
    return {start.data(), static_cast<size_t>(file.gcount())};
}

void check_content(const ImageSource& source, const Format& format)
{
    const std::string& path = source.path;
    if (!source.bytes.empty()) return;  // chosen by their first bytes
    if (!start_of(path).starts_with(format.magic)) {
        fail(path, fmt::format("it is no {} file, in spite of its name; check how it was made",
                               format.shown_name));
    }
    if (&format == &exr) check_exr(path);
}

[[nodiscard]] bool is_jpeg(const Format& format)
{
    return &format == &jpeg || &format == &jpeg_by_long_name;
}

std::vector<uint8_t> whole_file(const std::string& path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = file.tellg();
    if (!file || size > most_jpeg_bytes) fail(path, "it is too large for a picture");
    std::vector<uint8_t> bytes(static_cast<size_t>(size));
    file.seekg(0);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), size)) {
        fail(path, std::generic_category().message(errno));
    }
    return bytes;
}

/// What of a JPEG goes to the libraries: nothing that only their parsers of metadata read.
std::vector<uint8_t> bare_bytes(const ImageSource& source)
{
    std::vector<uint8_t> file;
    if (source.bytes.empty()) file = whole_file(source.path);
    std::string error;
    std::vector<uint8_t> bare = bare_jpeg(source.bytes.empty() ? file : source.bytes, error);
    if (bare.empty()) fail(source.path, fmt::format("the JPEG file cannot be used: {}", error));
    return bare;
}

/// Folders that may hold the module: the executable's, and the build tree's.
std::array<fs::path, 2> plugin_folders()
{
    std::error_code error;
    return {fs::read_symlink("/proc/self/exe", error).parent_path(),
            fs::path(MOTE_PLUGIN_BUILD_FOLDER)};
}

ReadWithOiio load_plugin()
{
    std::string reason;
    for (const fs::path& folder : plugin_folders()) {
        const fs::path file = folder / oiio_plugin_file;
        std::error_code error;
        if (!fs::exists(file, error)) continue;
        void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        void* symbol = module ? ::dlsym(module, oiio_plugin_symbol) : nullptr;
        if (symbol) return reinterpret_cast<ReadWithOiio>(symbol);
        const char* message = ::dlerror();
        reason = printable(message ? message : "unknown reason");
        break;
    }
    if (reason.empty()) reason = fmt::format("{} is not beside the executable", oiio_plugin_file);
    throw Error(ExitCode::Input, fmt::format("images cannot be read: {}; install mote with its "
                                             "image reader module and libopenimageio2.4",
                                             reason));
}

void sanitize(Buffer2D<Spectrum>& image, ImageReadReport& report)
{
    for (Spectrum& s : image) {
        for (int c = 0; c < 3; ++c) {
            if (s[c] >= 0.0f && std::isfinite(s[c])) continue;
            ++(std::isfinite(s[c]) ? report.negative : report.non_finite);
            s[c] = 0.0f;
        }
    }
}

StoredImage read_stored(const ImageSource& source, int channels)
{
    const Format& format = format_of(source);
    check_content(source, format);
    std::vector<uint8_t> bare;
    ImageSource shown = source;
    if (is_jpeg(format)) {
        bare = bare_bytes(source);
        shown.bytes = bare;
    }
    static const ReadWithOiio read_with_oiio = load_plugin();
    StoredImage image;
    std::string error;
    if (!read_with_oiio(shown, format.reader, channels, image, error)) {
        fail(source.path, fmt::format("the {} file is damaged or not supported ({})",
                                      format.shown_name, printable(error)));
    }
    return image;
}

/// RGB of an image of three channels, as stored; 8-bit values in [0,1].
Buffer2D<Spectrum> to_spectra(const StoredImage& image)
{
    Buffer2D<Spectrum> out(image.width, image.height);
    size_t i = 0;
    for (Spectrum& s : out) {
        for (int c = 0; c < 3; ++c, ++i) {
            s[c] =
                image.bytes.empty() ? image.floats[i] : static_cast<float>(image.bytes[i]) / 255.0f;
        }
    }
    return out;
}

}  // namespace

Buffer2D<Spectrum> read_image(const std::string& path, ImageReadReport* report)
{
    const ImageSource source{path, {}};
    Buffer2D<Spectrum> image = to_spectra(read_stored(source, 3));
    if (stores_srgb(source)) {
        for (Spectrum& s : image) s = {decode_srgb(s.x), decode_srgb(s.y), decode_srgb(s.z)};
    }
    ImageReadReport counts;
    sanitize(image, counts);
    if (report) *report = counts;
    return image;
}

StoredImage read_stored_image(const ImageSource& source)
{
    return read_stored(source, 4);
}

bool stores_srgb(const ImageSource& source)
{
    const Format& format = format_of(source);
    return &format == &png || is_jpeg(format);
}

}  // namespace mote
