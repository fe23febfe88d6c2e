#include "image/oiio_plugin.h"

#include <algorithm>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "image/exr_check.h"

namespace mote {
namespace {

/// Positions of R, G, B and A among the channels (A: -1 if there is none); a grey image gives its
/// first one thrice.
bool find_rgba(const OIIO::ImageSpec& spec, int (&rgba)[4], std::string& error)
{
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) rgba[c] = spec.channelindex(names[c]);
    rgba[3] = spec.channelindex("A");
    if (rgba[0] >= 0 && rgba[1] >= 0 && rgba[2] >= 0) return true;
    if (spec.nchannels <= 2) {
        rgba[0] = rgba[1] = rgba[2] = 0;
        return true;
    }
    error = "it has several channels but no R, G and B";
    return false;
}

/// Reads the channels and puts them in order; `opaque` is the alpha of images without one.
template <class T>
bool read_pixels(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, const int (&rgba)[4],
                 int channels, OIIO::TypeDesc type, T opaque, std::vector<T>& out)
{
    const auto used = [&](auto&& pick) {
        int value = rgba[0];
        for (int c = 1; c < channels; ++c) {
            if (rgba[c] >= 0) value = pick(value, rgba[c]);
        }
        return value;
    };
    const int first = used([](int a, int b) { return std::min(a, b); });
    const int end = used([](int a, int b) { return std::max(a, b); }) + 1;
    const size_t stride = static_cast<size_t>(end - first);
    const size_t count = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    std::vector<T> pixels(stride * count);
    if (!input.read_image(0, 0, first, end, type, pixels.data())) return false;
    out.reserve(static_cast<size_t>(channels) * count);
    for (const T* pixel = pixels.data(); pixel != pixels.data() + pixels.size(); pixel += stride) {
        for (int c = 0; c < channels; ++c) {
            out.push_back(rgba[c] < 0 ? opaque : pixel[rgba[c] - first]);
        }
    }
    return true;
}

bool read(const ImageSource& source, const char* format, int channels, StoredImage& out,
          std::string& error)
{
    OIIO::attribute("threads", 1);  // loading is rare; no thread pools beside ours
    OIIO::attribute("exr_threads", -1);
    OIIO::Filesystem::IOMemReader memory(source.bytes.data(), source.bytes.size());
    const auto input = OIIO::ImageInput::create(format);  // goes before the memory it reads
    if (!input) {
        error = OIIO::geterror();
        return false;
    }
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // colour as stored, not multiplied by alpha
    if (!source.bytes.empty() && !input->set_ioproxy(&memory)) {
        error = "this format is not read from memory";
        return false;
    }
    OIIO::ImageSpec spec;
    if (!input->open(source.path, spec, config)) {
        error = input->geterror();
        return false;
    }
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
        int64_t{spec.width} > max_image_pixels / spec.height) {
        error = "its size is not supported (limit: 2^28 pixels)";
        return false;
    }
    int rgba[4];
    if (!find_rgba(spec, rgba, error)) return false;
    out = {spec.width, spec.height, channels, {}, {}};
    const bool is_read = spec.format == OIIO::TypeDesc::UINT8
                             ? read_pixels<uint8_t>(*input, spec, rgba, channels,
                                                    OIIO::TypeDesc::UINT8, 255, out.bytes)
                             : read_pixels<float>(*input, spec, rgba, channels,
                                                  OIIO::TypeDesc::FLOAT, 1.0f, out.floats);
    if (!is_read) error = input->geterror();
    input->close();
    return is_read;
}

}  // namespace
}  // namespace mote

extern "C" __attribute__((visibility("default"))) bool mote_read_with_oiio(
    const mote::ImageSource& source, const char* format, int channels, mote::StoredImage& out,
    std::string& error)
{
    try {
        return mote::read(source, format, channels, out, error);
    } catch (const std::exception& e) {
        error = e.what();
        return false;
    }
}
