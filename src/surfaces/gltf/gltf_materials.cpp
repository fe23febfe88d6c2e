#include <filesystem>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"
#include "surfaces/gltf/gltf_outline.h"

namespace mote {
namespace {

using tinygltf::Value;

/// A member of an extension; null if it is not there.
const Value* member(const tinygltf::ExtensionMap& extensions, const char* extension,
                    const char* key)
{
    const auto found = extensions.find(extension);
    if (found == extensions.end() || !found->second.IsObject()) return nullptr;
    return found->second.Has(key) ? &found->second.Get(key) : nullptr;
}

double number_of(const Value* value, double otherwise)
{
    return value && value->IsNumber() ? value->GetNumberAsDouble() : otherwise;
}

/// A number within a range; what is outside, or no number, becomes its nearer end.
float within(double value, double lo, double hi)
{
    return static_cast<float>(value > lo ? std::min(value, hi) : lo);
}

Spectrum color_of(const std::vector<double>& values, double hi)
{
    Spectrum color(1.0f);
    for (size_t c = 0; c < 3 && c < values.size(); ++c) {
        color[static_cast<int>(c)] = within(values[c], 0.0, hi);
    }
    return color;
}

glm::mat3 texture_transform(const tinygltf::ExtensionMap& extensions)
{
    const char* name = "KHR_texture_transform";
    const auto pair_of = [&](const char* key, double otherwise) {
        const Value* value = member(extensions, name, key);
        glm::dvec2 out(otherwise);
        for (int c = 0; value && value->IsArray() && value->ArrayLen() == 2 && c < 2; ++c) {
            out[c] = number_of(&value->Get(c), otherwise);
        }
        return glm::vec2(out);
    };
    const Vec2 offset = pair_of("offset", 0.0);
    const Vec2 scale = pair_of("scale", 1.0);
    const auto angle = static_cast<float>(number_of(member(extensions, name, "rotation"), 0.0));
    const float c = std::cos(angle);
    const float s = std::sin(angle);
    // Columns. glTF: offset * rotation * scale, the rotation counterclockwise with v downwards.
    return {Vec3(c * scale.x, -s * scale.x, 0.0f), Vec3(s * scale.y, c * scale.y, 0.0f),
            Vec3(offset, 1.0f)};
}

TextureWrap wrap_of(int mode)
{
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return TextureWrap::Clamp;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return TextureWrap::Mirror;
    return TextureWrap::Repeat;
}

/// Of filters that for magnification counts; there are no smaller copies of pictures.
TextureSampler sampler_of(const tinygltf::Sampler& from)
{
    return {wrap_of(from.wrapS), wrap_of(from.wrapT),
            from.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST};
}

/// A file's material under conversion.
struct Converter {
    const GltfSource& source;
    GltfMaterial& out;
    GltfUvChoice& uv;
    bool has_uv = false;

    /// The picture of a slot; notes what coordinates it uses.
    template <class Info>
    GltfPicture picture(const Info& info, const char* slot)
    {
        if (info.index < 0) return {};
        const tinygltf::Texture& texture = source.at(source.model.textures, info.index, "texture");
        GltfUvChoice own{info.texCoord, texture_transform(info.extensions)};
        const Value* other_set = member(info.extensions, "KHR_texture_transform", "texCoord");
        own.set = static_cast<int>(within(number_of(other_set, info.texCoord), 0.0, 1000.0));
        if (!has_uv) uv = own;
        if (has_uv && (own.set != uv.set || own.from_file != uv.from_file)) {
            spdlog::warn(
                "{}: material \"{}\": the {} uses other texture coordinates than its "
                "first picture; it gets the same",
                printable(source.path), printable(out.name), slot);
        }
        has_uv = true;
        if (texture.source < 0) {
            source.fail(fmt::format(
                "texture {} has no picture that mote reads; save it as PNG or JPEG", info.index));
        }
        (void)source.at(source.model.images, texture.source, "image");
        if (texture.sampler < 0) return {texture.source, {}};
        return {texture.source,
                sampler_of(source.at(source.model.samplers, texture.sampler, "sampler"))};
    }

    void convert(const tinygltf::Material& from);
    void convert_transmission(const tinygltf::Material& from);
    void convert_alpha(const tinygltf::Material& from);
};

void Converter::convert(const tinygltf::Material& from)
{
    out.name = from.name;
    const tinygltf::PbrMetallicRoughness& pbr = from.pbrMetallicRoughness;
    out.look.kind = MaterialKind::MetallicRoughness;
    out.look.base_color = color_of(pbr.baseColorFactor, 1.0);
    out.look.metallic = within(pbr.metallicFactor, 0.0, 1.0);
    out.look.roughness = within(pbr.roughnessFactor, 0.0, 1.0);
    out.look.two_sided = from.doubleSided;
    out.color = picture(pbr.baseColorTexture, "base colour");
    out.metallic_roughness = picture(pbr.metallicRoughnessTexture, "metallic-roughness picture");
    out.normal = picture(from.normalTexture, "normal map");
    out.normal_strength = within(from.normalTexture.scale, 0.0, 1000.0);
    out.emission = picture(from.emissiveTexture, "emissive picture");
    const double strength = number_of(
        member(from.extensions, "KHR_materials_emissive_strength", "emissiveStrength"), 1.0);
    out.look.emission = from.emissiveFactor.empty()
                            ? Spectrum(0.0f)
                            : within(strength, 0.0, 1e20) * color_of(from.emissiveFactor, 1.0);
    convert_transmission(from);
    convert_alpha(from);
}

/// Glass is all or nothing here.
void Converter::convert_transmission(const tinygltf::Material& from)
{
    out.look.ior =
        within(number_of(member(from.extensions, "KHR_materials_ior", "ior"), 1.5), 1.0, 4.0);
    const double transmission =
        number_of(member(from.extensions, "KHR_materials_transmission", "transmissionFactor"), 0.0);
    if (transmission >= 0.5) {
        out.look.kind = MaterialKind::Dielectric;
    } else if (transmission > 0.0) {
        spdlog::warn("{}: material \"{}\" lets {} of the light through; shown opaque",
                     printable(source.path), printable(out.name), transmission);
    }
}

void Converter::convert_alpha(const tinygltf::Material& from)
{
    const std::vector<double>& factor = from.pbrMetallicRoughness.baseColorFactor;
    if (from.alphaMode == "MASK") {
        out.alpha_cutoff = within(from.alphaCutoff, 0.0, 1.0);
    } else if (from.alphaMode == "BLEND") {
        out.alpha_cutoff = 0.5f;
        spdlog::warn("{}: material \"{}\" is to be blended; cut out where its alpha is below 0.5",
                     printable(source.path), printable(out.name));
    }
    out.opacity = factor.size() > 3 ? within(factor[3], 0.0, 1.0) : 1.0f;
}

void convert_images(const GltfSource& source, GltfScene& out)
{
    const auto folder = std::filesystem::path(source.path).parent_path();
    for (size_t i = 0; i < source.model.images.size(); ++i) {
        const tinygltf::Image& from = source.model.images[i];
        GltfImage image;
        if (from.uri.empty()) {
            image.path = fmt::format("{}: image {}", source.path, i);
            image.bytes = from.image;  // as it was: see the image loader in gltf_reader.cpp
        } else {
            image.path = (folder / decode_uri(from.uri)).string();
        }
        out.images.push_back(std::move(image));
    }
}

}  // namespace

void convert_materials(const GltfSource& source, GltfScene& out, std::vector<GltfUvChoice>& uvs)
{
    convert_images(source, out);
    const size_t count = source.model.materials.size();
    out.materials.resize(count + 1);
    uvs.resize(count + 1);
    for (size_t i = 0; i < count; ++i) {
        Converter{source, out.materials[i], uvs[i]}.convert(source.model.materials[i]);
    }
    Converter{source, out.materials[count], uvs[count]}.convert(tinygltf::Material{});
}

}  // namespace mote
