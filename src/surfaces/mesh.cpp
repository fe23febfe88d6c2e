#include "surfaces/mesh.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/error.h"
#include "surfaces/load_mesh.h"

namespace mote {
namespace {

/// Embree numbers primitives in 32 bits, and so does everything here.
constexpr size_t max_triangles = size_t{1} << 31;

/// Rays that leave a triangle start the farther off, the thinner it is: much thinner than this
/// share of its length, farther off than Embree can trace.
constexpr double min_thickness = 1e-12;

/// In floats, as lights have it, and in double, as points on it are found.
bool has_area(const Mesh& mesh, size_t triangle)
{
    const Vec3 rounded = area_normal(mesh, triangle);
    if (!(glm::dot(rounded, rounded) > 0.0f)) return false;
    const glm::uvec3 t = mesh.triangles[triangle];
    const Vec3d a(mesh.positions[t.x]);
    const Vec3d e1 = Vec3d(mesh.positions[t.y]) - a;
    const Vec3d e2 = Vec3d(mesh.positions[t.z]) - a;
    const Vec3d size = glm::abs(e1) + glm::abs(e2);
    const double extent = std::max({size.x, size.y, size.z});
    return glm::length(glm::cross(e1, e2)) > min_thickness * extent * extent;
}

bool is_usable(const Mesh& mesh, size_t triangle, const std::string& file, MeshRepairs& repairs)
{
    const glm::uvec3 t = mesh.triangles[triangle];
    for (int corner = 0; corner < 3; ++corner) {
        const Vec3 p = mesh.positions[t[corner]];
        if (!is_finite(p)) {
            ++repairs.non_finite;
            return false;
        }
        if (max_component(glm::abs(p)) > max_file_coordinate) {
            throw Error(
                ExitCode::Input,
                fmt::format("{}: vertex ({:g}, {:g}, {:g}) lies beyond {:g} m; scale the mesh "
                            "down or mend it where it was made",
                            file, p.x, p.y, p.z, max_file_coordinate));
        }
    }
    if (has_area(mesh, triangle)) return true;
    ++repairs.degenerate;
    return false;
}

void finish_normals(Mesh& mesh, MeshRepairs& repairs)
{
    for (Vec3& normal : mesh.normals) {
        const float length2 = glm::dot(normal, normal);
        if (length2 > 1e-20f && length2 < 1e20f) {
            normal /= std::sqrt(length2);
        } else {
            if (length2 != 0.0f) ++repairs.bad_normals;
            normal = Vec3(0.0f);
        }
    }
}

}  // namespace

void add_polygon(Mesh& mesh, std::span<const uint32_t> corners)
{
    for (size_t i = 2; i < corners.size(); ++i) {
        mesh.triangles.emplace_back(corners[0], corners[i - 1], corners[i]);
    }
}

MeshRepairs repair_mesh(Mesh& mesh, const std::string& file)
{
    MeshRepairs repairs;
    if (mesh.triangles.size() >= max_triangles) {
        throw Error(ExitCode::Input, fmt::format("{}: {} triangles are more than 2^31", file,
                                                 mesh.triangles.size()));
    }
    size_t kept = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3 t = mesh.triangles[i];
        const uint32_t last = std::max(t.x, std::max(t.y, t.z));
        if (last >= mesh.positions.size()) {
            throw Error(ExitCode::Input,
                        fmt::format("{}: triangle {} uses vertex {}, but there are only {}", file,
                                    i, last, mesh.positions.size()));
        }
        if (is_usable(mesh, i, file, repairs)) mesh.triangles[kept++] = t;
    }
    mesh.triangles.resize(kept);
    if (mesh.normals.size() != mesh.positions.size()) mesh.normals.clear();
    finish_normals(mesh, repairs);
    if (mesh.uvs.size() != mesh.positions.size()) mesh.uvs.clear();
    for (Vec2& uv : mesh.uvs) {
        if (std::isfinite(uv.x) && std::isfinite(uv.y)) continue;
        uv = Vec2(0.0f);
        ++repairs.bad_uvs;
    }
    for (Vec3& p : mesh.positions) {
        if (!is_finite(p)) p = Vec3(0.0f);  // of no triangle any more
    }
    mesh.bounds = {};
    for (const glm::uvec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) mesh.bounds.extend(mesh.positions[t[corner]]);
    }
    return repairs;
}

MeshRepairs finish_mesh(Mesh& mesh, const std::string& file)
{
    const MeshRepairs repairs = repair_mesh(mesh, file);
    if (mesh.triangles.empty()) {
        throw Error(ExitCode::Input,
                    fmt::format("{}: holds no triangle that can be drawn ({} with vertices that "
                                "are not finite, {} without area)",
                                file, repairs.non_finite, repairs.degenerate));
    }
    return repairs;
}

}  // namespace mote
