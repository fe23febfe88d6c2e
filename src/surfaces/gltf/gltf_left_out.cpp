#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"

namespace mote {
namespace {

/// Extensions that are shown. tinygltf and the accessors read quantised meshes as they are.
constexpr std::array shown_extensions = {"KHR_materials_emissive_strength",
                                         "KHR_materials_transmission", "KHR_materials_ior",
                                         "KHR_texture_transform", "KHR_mesh_quantization"};

bool has_colors(const tinygltf::Model& model)
{
    for (const tinygltf::Mesh& mesh : model.meshes) {
        for (const tinygltf::Primitive& primitive : mesh.primitives) {
            if (primitive.attributes.count("COLOR_0") > 0) return true;
        }
    }
    return false;
}

}  // namespace

std::vector<std::string> left_out(const tinygltf::Model& model)
{
    std::vector<std::string> out;
    if (has_colors(model)) out.emplace_back("vertex colours (COLOR_0)");
    for (const std::string& name : model.extensionsUsed) {
        const bool is_shown = std::find(shown_extensions.begin(), shown_extensions.end(), name) !=
                              shown_extensions.end();
        if (!is_shown && out.size() < 12) out.push_back(printable(name, 60));
    }
    return out;
}

void warn_of_left_out(const GltfSource& source)
{
    const std::vector<std::string> list = left_out(source.model);
    if (list.empty()) return;
    spdlog::warn("{}: shown without {}", printable(source.path), fmt::join(list, ", "));
}

}  // namespace mote
