#include "image/oiio_plugin.h"

#include <algorithm>
#include <vector>

#include <OpenImageIO/imageio.h>

#include "image/exr_check.h"

namespace mote {
namespace {

/// Positions of R, G and B among the channels; a grey image gives its first one thrice.
bool find_rgb(const OIIO::ImageSpec& spec, int (&rgb)[3], std::string& error)
{
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) rgb[c] = spec.channelindex(names[c]);
    if (rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0) return true;
    if (spec.nchannels <= 2) {
        rgb[0] = rgb[1] = rgb[2] = 0;
        return true;
    }
    error = "it has several channels but no R, G and B";
    return false;
}

bool read(const char* path, const char* format, Buffer2D<Spectrum>& out, std::string& error)
{
    OIIO::attribute("threads", 1);  // loading is rare; no thread pools beside ours
    OIIO::attribute("exr_threads", -1);
    const auto input = OIIO::ImageInput::create(format);
    if (!input) {
        error = OIIO::geterror();
        return false;
    }
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;  // colour as stored, not multiplied by alpha
    OIIO::ImageSpec spec;
    if (!input->open(path, spec, config)) {
        error = input->geterror();
        return false;
    }
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1 ||
        int64_t{spec.width} > max_image_pixels / spec.height) {
        error = "its size is not supported (limit: 2^28 pixels)";
        return false;
    }
    int rgb[3];
    if (!find_rgb(spec, rgb, error)) return false;
    const int first = std::min({rgb[0], rgb[1], rgb[2]});
    const int end = std::max({rgb[0], rgb[1], rgb[2]}) + 1;
    const size_t stride = static_cast<size_t>(end - first);
    std::vector<float> pixels(stride * static_cast<size_t>(spec.width) *
                              static_cast<size_t>(spec.height));
    if (!input->read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, pixels.data())) {
        error = input->geterror();
        return false;
    }
    input->close();
    out = Buffer2D<Spectrum>(spec.width, spec.height);
    const float* pixel = pixels.data();
    for (Spectrum& s : out) {
        s = {pixel[rgb[0] - first], pixel[rgb[1] - first], pixel[rgb[2] - first]};
        pixel += stride;
    }
    return true;
}

}  // namespace
}  // namespace mote

extern "C" __attribute__((visibility("default"))) bool mote_read_with_oiio(
    const char* path, const char* format, mote::Buffer2D<mote::Spectrum>& out, std::string& error)
{
    try {
        return mote::read(path, format, out, error);
    } catch (const std::exception& e) {
        error = e.what();
        return false;
    }
}
