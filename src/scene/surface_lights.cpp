#include "scene/surface_lights.h"

#include "core/error.h"

namespace mote {

void add_surface_lights(Scene& scene)
{
    scene.first_light_of_object.clear();
    if (!scene.surfaces) return;
    const Surfaces& surfaces = *scene.surfaces;
    for (size_t i = 0; i < surfaces.objects.size(); ++i) {
        const int object = static_cast<int>(i);
        const Material& material = surfaces.material(object);
        if (!material.is_emissive()) {
            scene.first_light_of_object.push_back(-1);
            continue;
        }
        MOTE_ASSERT(!surfaces.bvh->instances()[i].world_from_object.is_moving());
        scene.first_light_of_object.push_back(static_cast<int>(scene.lights.size()));
        const Mesh& mesh = surfaces.mesh(object);
        const InstanceFrame frame = surfaces.bvh->frame_at(i, 0.0f);
        for (size_t k = 0; k < mesh.triangles.size(); ++k) {
            const WorldTriangle t = world_triangle(frame, mesh, k);
            scene.lights.push_back(TriangleLight{t.corner, t.edge_u, t.edge_v, material.emission,
                                                 material.two_sided, t.offset});
        }
    }
}

}  // namespace mote
