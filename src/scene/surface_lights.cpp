#include "scene/surface_lights.h"

#include "core/error.h"
#include "scene/triangle_emission.h"

namespace mote {
namespace {

/// Look-ups that the means of an object's triangles may take together.
constexpr double max_look_ups = 1 << 24;

/// What each triangle of a textured object gives off, in the order of world_triangle's edges.
std::shared_ptr<std::vector<TriangleEmission>> make_emissions(
    const std::shared_ptr<const Surfaces>& surfaces, int object)
{
    const Mesh& mesh = surfaces->mesh(object);
    const MaterialTextures* textures = surfaces->textures_of(object);
    auto out = std::make_shared<std::vector<TriangleEmission>>();
    out->reserve(mesh.triangles.size());
    for (const glm::uvec3& t : mesh.triangles) {
        TriangleEmission emission{
            surfaces->material(object).emission, surfaces, textures, {}, {}, {}};
        if (!mesh.uvs.empty()) {
            emission.uv = mesh.uvs[t.x];
            emission.uv_along_u = mesh.uvs[t.y] - emission.uv;
            emission.uv_along_v = mesh.uvs[t.z] - emission.uv;
        }
        out->push_back(emission);
    }
    return out;
}

/// Mean of the whole picture: what lights whose own mean is too costly get a share of.
Spectrum picture_mean(const TriangleEmission& any)
{
    TriangleEmission whole = any;
    whole.uv = Vec2(0.0f);
    whole.uv_along_u = Vec2(2.0f, 0.0f);
    whole.uv_along_v = Vec2(0.0f, 2.0f);
    return mean_emission(whole, 1024, Spectrum(0.0f));
}

void add_textured_lights(Scene& scene, int object)
{
    const Surfaces& surfaces = *scene.surfaces;
    const Mesh& mesh = surfaces.mesh(object);
    const auto emissions = make_emissions(scene.surfaces, object);
    const Spectrum floor = picture_mean(emissions->front());
    const double count = static_cast<double>(mesh.triangles.size());
    const int steps = static_cast<int>(std::clamp(std::sqrt(max_look_ups / count), 1.0, 512.0));
    const InstanceFrame frame = surfaces.bvh->frame_at(static_cast<size_t>(object), 0.0f);
    for (size_t k = 0; k < mesh.triangles.size(); ++k) {
        const WorldTriangle t = world_triangle(frame, mesh, k);
        TriangleEmission& emission = (*emissions)[k];
        if (t.is_mirrored) std::swap(emission.uv_along_u, emission.uv_along_v);
        TriangleLight light{t.corner,
                            t.edge_u,
                            t.edge_v,
                            mean_emission(emission, steps, floor),
                            surfaces.material(object).two_sided,
                            t.offset,
                            nullptr};
        light.texture = std::shared_ptr<const TriangleEmission>(emissions, &emission);
        scene.lights.emplace_back(std::move(light));
    }
}

void add_even_lights(Scene& scene, int object)
{
    const Surfaces& surfaces = *scene.surfaces;
    const Material& material = surfaces.material(object);
    const Mesh& mesh = surfaces.mesh(object);
    const InstanceFrame frame = surfaces.bvh->frame_at(static_cast<size_t>(object), 0.0f);
    for (size_t k = 0; k < mesh.triangles.size(); ++k) {
        const WorldTriangle t = world_triangle(frame, mesh, k);
        scene.lights.emplace_back(TriangleLight{t.corner, t.edge_u, t.edge_v, material.emission,
                                                material.two_sided, t.offset, nullptr});
    }
}

}  // namespace

void add_surface_lights(Scene& scene)
{
    scene.first_light_of_object.clear();
    if (!scene.surfaces) return;
    const Surfaces& surfaces = *scene.surfaces;
    for (size_t i = 0; i < surfaces.objects.size(); ++i) {
        const int object = static_cast<int>(i);
        if (!surfaces.material(object).is_emissive()) {
            scene.first_light_of_object.push_back(-1);
            continue;
        }
        MOTE_ASSERT(!surfaces.bvh->instances()[i].world_from_object.is_moving());
        scene.first_light_of_object.push_back(static_cast<int>(scene.lights.size()));
        const MaterialTextures* textures = surfaces.textures_of(object);
        if (textures && (textures->emission || textures->is_cut())) {
            add_textured_lights(scene, object);
        } else {
            add_even_lights(scene, object);
        }
    }
}

}  // namespace mote
