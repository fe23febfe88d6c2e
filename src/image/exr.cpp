#include "image/exr.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFloatVectorAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfRationalAttribute.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVecAttribute.h>
#include <fmt/core.h>

#include "core/error.h"
#include "core/parallel.h"
#include "core/text.h"
#include "image/atomic_file.h"
#include "image/exr_check.h"
#include "image/output_file.h"

namespace mote {
namespace {

/// OpenEXR's destructors swallow write errors; OutputFile keeps them.
class OutputStream : public Imf::OStream {
  public:
    OutputStream(const std::string& shown_path, OutputFile& file)
        : OStream(shown_path.c_str()), file_(file)
    {
    }
    void write(const char bytes[], int count) override
    {
        file_.write(bytes, static_cast<size_t>(count));
        // No use in compressing the rest of the frame for a full disk.
        if (file_.failed()) throw std::runtime_error("write failed");
    }
    uint64_t tellp() override { return file_.position(); }
    void seekp(uint64_t position) override { file_.seek(position); }

  private:
    OutputFile& file_;
};

Imf::Compression imf_compression(ExrCompression compression)
{
    switch (compression) {
        case ExrCompression::None:
            return Imf::NO_COMPRESSION;
        case ExrCompression::Zip:
            return Imf::ZIP_COMPRESSION;
        case ExrCompression::Zips:
            return Imf::ZIPS_COMPRESSION;
        case ExrCompression::Piz:
            return Imf::PIZ_COMPRESSION;
    }
    return Imf::ZIP_COMPRESSION;
}

Imf::Chromaticities chromaticities(const std::vector<float>& v)
{
    return {Imath::V2f(v[0], v[1]), Imath::V2f(v[2], v[3]), Imath::V2f(v[4], v[5]),
            Imath::V2f(v[6], v[7])};
}

void insert_vector(Imf::Header& header, const std::string& name, const std::vector<float>& v)
{
    if (name == "chromaticities" && v.size() == 8) {
        header.insert(name, Imf::ChromaticitiesAttribute(chromaticities(v)));
    } else if (v.size() == 2) {
        header.insert(name, Imf::V2fAttribute(Imath::V2f(v[0], v[1])));
    } else if (v.size() == 3) {
        header.insert(name, Imf::V3fAttribute(Imath::V3f(v[0], v[1], v[2])));
    } else if (v.size() == 16) {
        Imath::M44f m;
        std::copy(v.begin(), v.end(), m.getValue());
        header.insert(name, Imf::M44fAttribute(m));
    } else {
        header.insert(name, Imf::FloatVectorAttribute(v));
    }
}

void insert_attribute(Imf::Header& header, const Attribute& attribute)
{
    const std::string& name = attribute.name;
    if (const auto* text = std::get_if<std::string>(&attribute.value)) {
        header.insert(name, Imf::StringAttribute(*text));
    } else if (const auto* number = std::get_if<int>(&attribute.value)) {
        header.insert(name, Imf::IntAttribute(*number));
    } else if (const auto* real = std::get_if<float>(&attribute.value)) {
        header.insert(name, Imf::FloatAttribute(*real));
    } else if (const auto* rational = std::get_if<Attribute::Rational>(&attribute.value)) {
        header.insert(name, Imf::RationalAttribute(Imf::Rational(
                                rational->numerator, static_cast<int>(rational->denominator))));
    } else {
        insert_vector(header, name, std::get<std::vector<float>>(attribute.value));
    }
}

/// The attribute in our terms; false for types that we do not keep.
bool convert_attribute(const Imf::Attribute& in, Attribute& out)
{
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&in)) {
        out.value = text->value();
    } else if (const auto* number = dynamic_cast<const Imf::IntAttribute*>(&in)) {
        out.value = number->value();
    } else if (const auto* real = dynamic_cast<const Imf::FloatAttribute*>(&in)) {
        out.value = real->value();
    } else if (const auto* rational = dynamic_cast<const Imf::RationalAttribute*>(&in)) {
        out.value = Attribute::Rational{rational->value().n, rational->value().d};
    } else if (const auto* floats = dynamic_cast<const Imf::FloatVectorAttribute*>(&in)) {
        out.value = std::vector<float>(floats->value());
    } else if (const auto* v2 = dynamic_cast<const Imf::V2fAttribute*>(&in)) {
        out.value = std::vector<float>{v2->value().x, v2->value().y};
    } else if (const auto* v3 = dynamic_cast<const Imf::V3fAttribute*>(&in)) {
        out.value = std::vector<float>{v3->value().x, v3->value().y, v3->value().z};
    } else if (const auto* m = dynamic_cast<const Imf::M44fAttribute*>(&in)) {
        const float* values = m->value().getValue();
        out.value = std::vector<float>(values, values + 16);
    } else if (const auto* c = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&in)) {
        const Imf::Chromaticities& v = c->value();
        out.value = std::vector<float>{v.red.x,  v.red.y,  v.green.x, v.green.y,
                                       v.blue.x, v.blue.y, v.white.x, v.white.y};
    } else {
        return false;
    }
    return true;
}

std::vector<half> to_half(const Buffer2D<float>& data)
{
    std::vector<half> out(data.size());
    static constexpr float limit = 65504.0f;
    std::transform(data.begin(), data.end(), out.begin(), [](float value) {
        return half(std::isfinite(value) ? std::clamp(value, -limit, limit) : value);
    });
    return out;
}

Imf::Slice slice(Imf::PixelType type, const void* data, int width)
{
    const size_t size = type == Imf::HALF ? sizeof(half) : sizeof(float);
    return {type, static_cast<char*>(const_cast<void*>(data)), size,
            size * static_cast<size_t>(width)};
}

Imf::Header make_header(const LayeredImage& image, ExrCompression compression)
{
    Imf::Header header(image.width, image.height);
    header.compression() = imf_compression(compression);
    for (const Channel& channel : image.channels) {
        MOTE_ASSERT(channel.data.width() == image.width && channel.data.height() == image.height);
        header.channels().insert(
            channel.name, Imf::Channel(channel.type == PixelType::Half ? Imf::HALF : Imf::FLOAT));
    }
    for (const Attribute& attribute : image.attributes) insert_attribute(header, attribute);
    return header;
}

void write_scanlines(const std::string& temporary_path, const std::string& path,
                     const LayeredImage& image, const Imf::Header& header)
{
    Imf::FrameBuffer frame_buffer;
    std::vector<std::vector<half>> halves;
    halves.reserve(image.channels.size());
    for (const Channel& channel : image.channels) {
        const bool is_half = channel.type == PixelType::Half;
        if (is_half) halves.push_back(to_half(channel.data));
        const void* data = is_half ? static_cast<const void*>(halves.back().data())
                                   : static_cast<const void*>(channel.data.data());
        frame_buffer.insert(channel.name,
                            slice(is_half ? Imf::HALF : Imf::FLOAT, data, image.width));
    }
    const int threads = thread_limit();
    Imf::setGlobalThreadCount(threads > 1 ? threads : 0);
    OutputFile file(temporary_path, path);
    OutputStream stream(path, file);
    try {
        Imf::OutputFile out(stream, header, threads);
        out.setFrameBuffer(frame_buffer);
        out.writePixels(image.height);
    } catch (const std::exception&) {
        if (!file.failed()) throw;  // otherwise finish() knows the reason better
    }
    file.finish();
}

[[noreturn]] void fail_read(const std::string& path, const std::string& reason)
{
    throw Error(ExitCode::Input,
                fmt::format("cannot read \"{}\": {}", printable(path, 1000), reason));
}

LayeredImage convert_header(const std::string& path, const Imf::Header& header)
{
    LayeredImage image;
    const Imath::Box2i& window = header.dataWindow();
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
        const Imf::Channel& channel = it.channel();
        if (channel.xSampling != 1 || channel.ySampling != 1) {
            fail_read(path, fmt::format("channel \"{}\" is subsampled; save it at full resolution",
                                        printable(it.name())));
        }
        const PixelType type = channel.type == Imf::HALF ? PixelType::Half : PixelType::Float;
        image.channels.push_back({it.name(), type, {}});
    }
    for (auto it = header.begin(); it != header.end(); ++it) {
        Attribute attribute{it.name(), 0};
        if (convert_attribute(it.attribute(), attribute)) {
            image.attributes.push_back(std::move(attribute));
        }
    }
    return image;
}

/// Opens a checked file and calls f(Imf::InputFile&, LayeredImage with the header).
template <class F>
LayeredImage read_with(const std::string& path, F&& f)
{
    check_exr(path);
    try {
        Imf::InputFile file(path.c_str(), 0);
        LayeredImage image = convert_header(path, file.header());
        f(file, image);
        return image;
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::Memory, fmt::format("not enough memory to read \"{}\"", path));
    } catch (const std::exception& e) {
        fail_read(path, fmt::format("the OpenEXR file is damaged ({}); write it again",
                                    printable(e.what())));
    }
}

}  // namespace

void write_exr(const std::string& path, const LayeredImage& image, ExrCompression compression)
{
    MOTE_ASSERT(image.width > 0 && image.height > 0 && !image.channels.empty());
    write_atomically(path, [&](const std::string& temporary_path) {
        write_scanlines(temporary_path, path, image, make_header(image, compression));
    });
}

LayeredImage read_exr(const std::string& path)
{
    return read_with(path, [&](Imf::InputFile& file, LayeredImage& image) {
        if (!file.isComplete()) fail_read(path, "the OpenEXR file is incomplete; write it again");
        const Imath::Box2i& window = file.header().dataWindow();
        Imf::FrameBuffer frame_buffer;
        for (Channel& channel : image.channels) {
            channel.data = Buffer2D<float>(image.width, image.height);
            frame_buffer.insert(channel.name,
                                Imf::Slice::Make(Imf::FLOAT, channel.data.data(), window));
        }
        file.setFrameBuffer(frame_buffer);
        file.readPixels(window.min.y, window.max.y);
    });
}

LayeredImage read_exr_header(const std::string& path)
{
    return read_with(path, [](Imf::InputFile&, LayeredImage&) {});
}

bool is_complete_exr(const std::string& path)
{
    try {
        (void)read_exr(path);
        return true;
    } catch (const Error&) {
        return false;
    }
}

}  // namespace mote
