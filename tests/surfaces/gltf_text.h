#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "surfaces/mesh.h"

namespace mote::test {

inline std::string base64(const std::string& bytes)
{
    static constexpr const char* letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k) {
            const bool is_there = i + k < bytes.size();
            group = group << 8u | (is_there ? static_cast<uint8_t>(bytes[i + k]) : 0u);
        }
        for (size_t k = 0; k < 4; ++k) {
            const bool is_there = i + k <= bytes.size();
            out.push_back(is_there ? letters[group >> (18u - 6u * k) & 63u] : '=');
        }
    }
    return out;
}

/// A glTF file under construction: one buffer, and JSON that tests fill in.
struct GltfText {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::string buffer;

    /// Appends values and an accessor to them; its number.
    template <class T>
    int add(const std::vector<T>& values, int component_type, const char* type, int components)
    {
        while (buffer.size() % 4 != 0) buffer.push_back('\0');
        const size_t offset = buffer.size();
        buffer.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", buffer.size() - offset}});
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component_type},
                                     {"count", values.size() / static_cast<size_t>(components)},
                                     {"type", type}});
        return static_cast<int>(json["accessors"].size()) - 1;
    }
    int add_floats(const std::vector<float>& values, const char* type, int components)
    {
        return add(values, 5126, type, components);
    }

    /// A mesh of one primitive; its number.
    int add_mesh(const Mesh& mesh, int material = -1)
    {
        std::vector<float> p, n, uv;
        for (const Vec3& v : mesh.positions) p.insert(p.end(), {v.x, v.y, v.z});
        for (const Vec3& v : mesh.normals) n.insert(n.end(), {v.x, v.y, v.z});
        for (const Vec2& v : mesh.uvs) uv.insert(uv.end(), {v.x, 1.0f - v.y});
        std::vector<uint16_t> indices;
        for (const glm::uvec3& t : mesh.triangles) {
            for (int c = 0; c < 3; ++c) indices.push_back(static_cast<uint16_t>(t[c]));
        }
        nlohmann::json primitive = {{"attributes", {{"POSITION", add_floats(p, "VEC3", 3)}}},
                                    {"indices", add(indices, 5123, "SCALAR", 1)}};
        if (!n.empty()) primitive["attributes"]["NORMAL"] = add_floats(n, "VEC3", 3);
        if (!uv.empty()) primitive["attributes"]["TEXCOORD_0"] = add_floats(uv, "VEC2", 2);
        if (material >= 0) primitive["material"] = material;
        json["meshes"].push_back({{"primitives", {primitive}}});
        return static_cast<int>(json["meshes"].size()) - 1;
    }

    /// The file with the buffer inside as text.
    [[nodiscard]] std::string gltf() const
    {
        nlohmann::json out = json;
        out["buffers"] = {{{"byteLength", buffer.size()},
                           {"uri", "data:application/octet-stream;base64," + base64(buffer)}}};
        return out.dump(1);
    }

    /// The same as GLB.
    [[nodiscard]] std::string glb() const
    {
        nlohmann::json out = json;
        out["buffers"] = {{{"byteLength", buffer.size()}}};
        std::string text = out.dump();
        while (text.size() % 4 != 0) text.push_back(' ');
        std::string binary = buffer;
        while (binary.size() % 4 != 0) binary.push_back('\0');
        const auto number = [](size_t value) {
            const auto v = static_cast<uint32_t>(value);
            char bytes[4];
            std::memcpy(bytes, &v, 4);
            return std::string(bytes, 4);
        };
        return "glTF" + number(2) + number(28 + text.size() + binary.size()) + number(text.size()) +
               "JSON" + text + number(binary.size()) + std::string("BIN\0", 4) + binary;
    }
};

}  // namespace mote::test
