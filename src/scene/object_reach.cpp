#include "scene/object_reach.h"

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"

namespace mote {
namespace {

bool is_in_reach(Vec3d p)
{
    const Vec3d size = glm::abs(p);
    return std::max({size.x, size.y, size.z}) <= max_world_coordinate;
}

bool is_box_in_reach(const Mat4d& world_from_object, const Bounds3& box)
{
    for (int corner = 0; corner < 8; ++corner) {
        const Vec3d p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                      corner & 4 ? box.hi.z : box.lo.z);
        if (!is_in_reach(Vec3d(world_from_object * glm::dvec4(p, 1.0)))) return false;
    }
    return true;
}

void require_at(const Mat4d& world_from_object, const ObjectPart& part, const std::string& file)
{
    const Mesh& mesh = part.mesh->mesh();
    if (is_box_in_reach(world_from_object, mesh.bounds)) return;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            const Vec3d p(mesh.positions[t[corner]]);
            const Vec3d placed(world_from_object * glm::dvec4(p, 1.0));
            if (is_in_reach(placed)) continue;
            throw Error(ExitCode::Input,
                        fmt::format("{}: vertex ({:g}, {:g}, {:g}) of \"{}\" is placed at ({:g}, "
                                    "{:g}, {:g}), beyond {:g} m; scale it down in the object's "
                                    "\"transform\" or where it was made",
                                    printable(file), p.x, p.y, p.z, printable(part.name), placed.x,
                                    placed.y, placed.z, max_world_coordinate));
        }
    }
}

}  // namespace

void require_in_reach(const ObjectPart& part, const std::string& file)
{
    for (const MovingTransform* motion : {&part.world_from_object, &part.next}) {
        for (const Trs& key : motion->keys) require_at(matrix(key), part, file);
    }
}

}  // namespace mote
