#pragma once

#include <cstring>
#include <sstream>
#include <string>

#include "surfaces/mesh.h"

namespace mote::test {

/// Box from lo to hi, faces outwards (or inwards), each split into n x n x 2 triangles.
inline Mesh box_mesh(Vec3 lo, Vec3 hi, bool inwards = false, int n = 1)
{
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis) {
        for (int side = 0; side < 2; ++side) {
            const auto base = static_cast<uint32_t>(mesh.positions.size());
            for (int j = 0; j <= n; ++j) {
                for (int i = 0; i <= n; ++i) {
                    Vec3 u(0.0f);
                    u[axis] = static_cast<float>(side);
                    u[(axis + 1) % 3] = static_cast<float>(i) / static_cast<float>(n);
                    u[(axis + 2) % 3] = static_cast<float>(j) / static_cast<float>(n);
                    mesh.positions.push_back(lo + u * (hi - lo));
                }
            }
            const bool flip = (side == 0) != inwards;
            const auto row = static_cast<uint32_t>(n + 1);
            for (uint32_t j = 0; j + 1 < row; ++j) {
                for (uint32_t i = 0; i + 1 < row; ++i) {
                    const uint32_t a = base + j * row + i;
                    const uint32_t forward[] = {a, a + 1, a + row + 1, a + row};
                    const uint32_t backward[] = {a, a + row, a + row + 1, a + 1};
                    add_polygon(mesh, flip ? backward : forward);
                }
            }
        }
    }
    finish_mesh(mesh, "box");
    return mesh;
}

/// Parallelogram corner, corner + u, corner + u + v, corner + v; front along cross(u, v). Texture
/// coordinates run from 0 to 1 along the edges.
inline Mesh quad_mesh(Vec3 corner, Vec3 u, Vec3 v)
{
    Mesh mesh;
    mesh.positions = {corner, corner + u, corner + u + v, corner + v};
    mesh.uvs = {Vec2(0.0f), Vec2(1.0f, 0.0f), Vec2(1.0f), Vec2(0.0f, 1.0f)};
    const uint32_t corners[] = {0, 1, 2, 3};
    add_polygon(mesh, corners);
    finish_mesh(mesh, "quad");
    return mesh;
}

/// Sphere of 2 n x n quads around the origin, with smooth normals.
inline Mesh sphere_mesh(float radius, int n, bool is_smooth = true)
{
    Mesh mesh;
    const auto columns = static_cast<uint32_t>(2 * n);
    for (int j = 0; j <= n; ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const float theta = pi * static_cast<float>(j) / static_cast<float>(n);
            const float phi = pi * static_cast<float>(i) / static_cast<float>(n);
            const Vec3 d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                         std::cos(theta));
            mesh.positions.push_back(radius * d);
            if (is_smooth) mesh.normals.push_back(d);
        }
    }
    for (uint32_t j = 0; j < static_cast<uint32_t>(n); ++j) {
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t next = (i + 1) % columns;
            const uint32_t corners[] = {j * columns + i, (j + 1) * columns + i,
                                        (j + 1) * columns + next, j * columns + next};
            add_polygon(mesh, corners);
        }
    }
    finish_mesh(mesh, "sphere");
    return mesh;
}

/// The mesh as OBJ text.
inline std::string obj_text(const Mesh& mesh)
{
    std::ostringstream out;
    out << "# mesh\no thing\n";
    for (const Vec3& p : mesh.positions) {
        out << "v " << p.x << " " << p.y << " " << p.z << "\n";
    }
    for (const Vec3& n : mesh.normals) {
        out << "vn " << n.x << " " << n.y << " " << n.z << "\n";
    }
    for (const Vec2& uv : mesh.uvs) out << "vt " << uv.x << " " << uv.y << "\n";
    for (const glm::uvec3& t : mesh.triangles) {
        out << "f";
        for (int c = 0; c < 3; ++c) {
            out << " " << t[c] + 1;
            if (!mesh.uvs.empty()) out << "/" << t[c] + 1;
            if (!mesh.normals.empty()) out << (mesh.uvs.empty() ? "//" : "/") << t[c] + 1;
        }
        out << "\n";
    }
    return out.str();
}

/// The mesh as a binary (little endian) or ascii PLY file, without normals.
inline std::string ply_bytes(const Mesh& mesh, bool is_binary)
{
    std::ostringstream out;
    out << "ply\nformat " << (is_binary ? "binary_little_endian" : "ascii")
        << " 1.0\nelement vertex " << mesh.positions.size()
        << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
        << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
    const auto put = [&](const auto& value, const char* separator) {
        if (!is_binary) {
            out << +value << separator;
            return;
        }
        char bytes[sizeof(value)];
        std::memcpy(bytes, &value, sizeof(value));
        out.write(bytes, sizeof(value));
    };
    for (const Vec3& p : mesh.positions) {
        for (int c = 0; c < 3; ++c) put(p[c], c < 2 ? " " : "\n");
    }
    for (const glm::uvec3& t : mesh.triangles) {
        put(uint8_t{3}, " ");
        for (int c = 0; c < 3; ++c) put(t[c], c < 2 ? " " : "\n");
    }
    return out.str();
}

}  // namespace mote::test
