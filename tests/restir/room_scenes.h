#pragma once

#include "restir/scenes.h"
#include "support/surface_scene.h"

namespace mote::test {

inline Material glossy(Spectrum color, float metallic, float roughness)
{
    Material material = diffuse(color);
    material.kind = MaterialKind::MetallicRoughness;
    material.metallic = metallic;
    material.roughness = roughness;
    return material;
}

inline Trs placed(Vec3 translate, double angle = 0.0)
{
    Trs trs;
    trs.translate = Vec3d(translate);
    trs.rotate = glm::angleAxis(angle, glm::normalize(Vec3d(0.2, 1.0, 0.1)));
    return trs;
}

/// How a room differs from the one at rest.
struct RoomState {
    Vec3 camera{0.5f, 0.4f, 3.2f};
    float smoke_density = 2.0f;
    Vec3 block{-0.5f, -0.7f, 0.2f};
    double block_angle = 0.5;
    float panel = 6.0f;  ///< radiance of the panel under the ceiling
    Vec3 lamp{1.0f, 0.3f, 0.8f};
    float lamp_radiance = 5.0f;
};

/// A closed room with smoke in it, lit by a panel of 18 triangles, by glowing balls of differing
/// strength (a thousand triangles), by a sphere and by a quad; a metal block, a glossy ball.
inline Scene room(const RoomState& state = {})
{
    Scene scene = lit_clumps(state.smoke_density);
    scene.camera = small_camera(state.camera);
    scene.lights = {SphereLight{state.lamp, 0.2f, Spectrum(state.lamp_radiance)},
                    QuadLight{{-1.5f, -0.5f, -0.5f},
                              {0.0f, 0.6f, 0.0f},
                              {0.0f, 0.0f, 0.7f},
                              {1.0f, 1.5f, 3.0f},
                              true}};
    Material panel = diffuse(Spectrum(0.3f), Spectrum(state.panel, 0.8f * state.panel, 1.0f));
    panel.two_sided = false;
    std::vector<Thing> things{
        {box_mesh(Vec3(-1.8f, -1.4f, -1.8f), Vec3(1.8f, 1.6f, 3.6f), true),
         diffuse({0.7f, 0.6f, 0.5f})},
        {quad_mesh({-0.5f, 1.55f, -0.3f}, {1.0f, 0.0f, 0.0f}, {0.0f, 0.0f, 0.8f}), panel},
        {box_mesh(Vec3(-0.4f), Vec3(0.4f)), glossy({0.9f, 0.7f, 0.4f}, 1.0f, 0.4f),
         placed(state.block, state.block_angle)},
        {sphere_mesh(0.35f, 10), glossy({0.1f, 0.3f, 0.6f}, 0.0f, 0.3f),
         placed({0.7f, -0.9f, 0.6f})}};
    for (int i = 0; i < 6; ++i) {
        const float strength = std::exp2(static_cast<float>(i) - 2.0f);
        const Vec3 p(-1.3f + 0.5f * static_cast<float>(i), i % 2 == 0 ? 0.8f : -0.2f, -1.4f);
        things.push_back({sphere_mesh(0.1f, 7),
                          diffuse(Spectrum(0.2f), Spectrum(strength, 1.0f, 0.5f * strength)),
                          placed(p)});
    }
    add_surfaces(scene, std::move(things));
    return scene;
}

/// A floor and a wall under sun and sky, smoke above: surfaces shade the smoke and the smoke them.
inline Scene courtyard(bool sky_image)
{
    Scene scene = lit_clumps(4.0f);
    scene.lights = {sun()};
    scene.environment = sky_image ? image_sky() : even_sky();
    Material glass = diffuse(Spectrum(0.95f));
    glass.kind = MaterialKind::Dielectric;
    glass.roughness = 0.3f;
    add_surfaces(scene, {{quad_mesh({-4.0f, -0.8f, -4.0f}, {0.0f, 0.0f, 8.0f}, {8.0f, 0.0f, 0.0f}),
                          diffuse({0.6f, 0.5f, 0.4f})},
                         {quad_mesh({0.9f, -1.0f, -2.0f}, {0.0f, 2.5f, 0.0f}, {-0.3f, 0.0f, 3.0f}),
                          diffuse({0.3f, 0.5f, 0.7f})},
                         {sphere_mesh(0.4f, 8), glass, placed({-0.8f, -0.3f, 0.9f})}});
    return scene;
}

/// A floor with pictures of colour and roughness, a leaf cut out of a quad before a lamp, a glowing
/// panel with a picture and holes, mirrored, a spot, and smoke.
inline Scene pictures()
{
    Scene scene = lit_clumps(2.0f);
    scene.lights = {SpotLight{{1.2f, 1.3f, 0.4f},
                              glm::normalize(Vec3(-1.3f, -1.6f, -0.4f)),
                              {4.0f, 5.0f, 6.0f},
                              0.97f,
                              0.9f},
                    SphereLight{{0.2f, 1.1f, 0.6f}, 0.15f, Spectrum(6.0f)}};
    const auto picture = [](int size, auto&& texel) {
        std::vector<float> values;
        for (int i = 0; i < size * size; ++i) {
            const Rgba rgba = texel(i % size, i / size);
            for (int c = 0; c < 4; ++c) values.push_back(rgba[c]);
        }
        return std::make_shared<const Texture>(size, size, values);
    };
    const auto checks = picture(4, [](int x, int y) {
        return (x + y) % 2 == 0 ? Rgba(0.9f, 0.5f, 0.2f, 1.0f) : Rgba(0.1f, 0.9f, 0.8f, 0.0f);
    });
    const auto sparks = picture(6, [](int x, int y) {
        return Rgba(Vec3((x * 5 + y * 3) % 7 == 0 ? 20.0f : 0.5f), (x + 2 * y) % 5 < 3);
    });
    Thing floor{quad_mesh({-4.0f, -0.9f, -4.0f}, {0.0f, 0.0f, 8.0f}, {8.0f, 0.0f, 0.0f}),
                glossy(Spectrum(0.8f), 0.3f, 0.8f)};
    floor.textures.color = floor.textures.roughness = floor.textures.metallic = checks;
    Thing leaf{quad_mesh({-0.3f, 0.6f, 0.1f}, {1.2f, 0.0f, 0.2f}, {0.0f, 0.1f, 1.0f}),
               diffuse({0.4f, 0.7f, 0.3f})};
    leaf.textures.color = checks;
    leaf.textures.alpha_cutoff = 0.5f;
    Thing panel{quad_mesh({0.2f, -0.5f, -1.2f}, {1.1f, 0.0f, 0.3f}, {0.0f, 1.4f, 0.0f}),
                diffuse(Spectrum(0.2f), {1.0f, 0.7f, 0.4f})};
    panel.textures.emission = panel.textures.color = sparks;
    panel.textures.alpha_cutoff = 0.4f;
    panel.trs.scale.x = -1.0;
    add_surfaces(scene, {floor, leaf, panel});
    return scene;
}

inline std::vector<TestScene> room_scenes()
{
    TestScene deep{"smoke in a room, three events", room(), 3};
    return {{"smoke in a room", room()},
            {"courtyard under an even sky", courtyard(false)},
            {"courtyard under a sky image", courtyard(true)},
            {"pictures and cut-outs", pictures()},
            deep};
}

}  // namespace mote::test
