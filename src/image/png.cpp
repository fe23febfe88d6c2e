#include "image/png.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include <fmt/core.h>
#include <png.h>

#include "core/error.h"
#include "core/text.h"
#include "image/atomic_file.h"
#include "image/color.h"
#include "image/exr_check.h"
#include "image/output_file.h"

namespace mote {
namespace {

/// libpng's simplified interface: errors come back as text, no longjmp through our frames.
struct PngImage {
    PngImage() { image.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;

    png_image image{};
};

[[noreturn]] void fail_read(const std::string& path, const std::string& reason)
{
    throw Error(ExitCode::Input,
                fmt::format("cannot read \"{}\": {}", printable(path, 1000), reason));
}

uint8_t to_byte(float linear)
{
    return static_cast<uint8_t>(std::lround(encode_srgb(linear) * 255.0f));
}

std::vector<uint8_t> to_bytes(const Buffer2D<Spectrum>& image, const PreviewParams& params)
{
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * image.size());
    for (const Spectrum& radiance : image) {
        const Spectrum display = apply_view(radiance, params);
        for (int c = 0; c < 3; ++c) bytes.push_back(to_byte(display[c]));
    }
    return bytes;
}

void check_size(const std::string& path, const png_image& image)
{
    const int64_t pixels = int64_t{image.width} * int64_t{image.height};
    std::error_code error;
    const auto file_size = static_cast<int64_t>(std::filesystem::file_size(path, error));
    if (pixels > max_image_pixels) {
        fail_read(path, fmt::format("{} x {} pixels are over the limit of 2^28", image.width,
                                    image.height));
    }
    // A PNG byte holds at most 8 pixels, a deflated byte at most 1032 bytes.
    if (pixels / 8 > 1032 * file_size) {
        fail_read(path, fmt::format("the PNG file is damaged ({} x {} pixels cannot fit into {}); "
                                    "write it again",
                                    image.width, image.height,
                                    format_bytes(static_cast<double>(file_size))));
    }
}

}  // namespace

Spectrum apply_view(Spectrum radiance, const PreviewParams& params)
{
    const Spectrum exposed = radiance * std::exp2(params.exposure);
    if (params.view == ViewTransform::Srgb) {
        return glm::clamp(exposed, Spectrum(0.0f), Spectrum(1.0f));
    }
    return {filmic_curve(exposed.x), filmic_curve(exposed.y), filmic_curve(exposed.z)};
}

std::vector<char> encode_png(const Buffer2D<Spectrum>& image, const PreviewParams& params)
{
    MOTE_ASSERT(image.size() > 0);
    PngImage png;
    png.image.width = static_cast<png_uint_32>(image.width());
    png.image.height = static_cast<png_uint_32>(image.height());
    png.image.format = PNG_FORMAT_RGB;
    const std::vector<uint8_t> bytes = to_bytes(image, params);
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png.image);
    std::vector<char> file(size);
    if (!png_image_write_to_memory(&png.image, file.data(), &size, 0, bytes.data(), 0, nullptr)) {
        throw Error(ExitCode::Output,
                    fmt::format("cannot encode a PNG: {}",
                                printable(static_cast<const char*>(png.image.message))));
    }
    file.resize(size);
    return file;
}

void write_png(const std::string& path, const Buffer2D<Spectrum>& image,
               const PreviewParams& params)
{
    // In memory first, so that writing the file can report every error.
    const std::vector<char> bytes = encode_png(image, params);
    write_atomically(path, [&](const std::string& temporary_path) {
        OutputFile file(temporary_path, path);
        file.write(bytes.data(), bytes.size());
        file.finish();
    });
}

Buffer2D<Spectrum> read_png(const std::string& path)
{
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"),
                                                               &std::fclose);
    if (!file) fail_read(path, std::generic_category().message(errno));
    PngImage png;
    if (!png_image_begin_read_from_stdio(&png.image, file.get())) {
        fail_read(path, fmt::format("it is not a PNG file ({})",
                                    printable(static_cast<const char*>(png.image.message))));
    }
    check_size(path, png.image);
    png.image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
    png.image.format = PNG_FORMAT_RGBA;
    std::vector<uint8_t> pixels(size_t{4} * png.image.width * png.image.height);
    if (!png_image_finish_read(&png.image, nullptr, pixels.data(), 0, nullptr)) {
        fail_read(path, fmt::format("the PNG file is damaged ({}); write it again",
                                    printable(static_cast<const char*>(png.image.message))));
    }
    std::array<float, 256> linear{};
    for (size_t i = 0; i < 256; ++i) linear[i] = decode_srgb(static_cast<float>(i) / 255.0f);
    Buffer2D<Spectrum> out(static_cast<int>(png.image.width), static_cast<int>(png.image.height));
    const uint8_t* pixel = pixels.data();
    for (Spectrum& s : out) {
        s = {linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]};
        pixel += 4;
    }
    return out;
}

}  // namespace mote
