#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "scene/environment.h"
#include "scene/scene.h"
#include "support/media.h"

namespace mote::test {

/// A small scene that some way of sampling finds hard. All media lie within 1.5 m of the origin.
struct TestScene {
    std::string name;
    Scene scene;
    int max_bounces = 1;
};

/// For the names of tests.
inline void PrintTo(const TestScene& test, std::ostream* out)
{
    *out << test.name;
}

/// Looks from `position` at the origin, or along -z if it is there. 8 x 6 pixels.
inline Camera small_camera(Vec3 position)
{
    Camera camera;
    camera.width = 8;
    camera.height = 6;
    camera.tan_half_fov_y = 0.4f;
    Trs pose;
    pose.translate = Vec3d(position);
    if (glm::length(position) > 0.0f) {
        pose.rotate = glm::quatLookAt(-glm::normalize(Vec3d(position)), Vec3d(0.0, 1.0, 0.0));
    }
    camera.world_from_camera.keys = {pose};
    return camera;
}

inline MovingTransform turned(Vec3 translate, double angle, Vec3 scale = Vec3(1.0f))
{
    Trs trs;
    trs.translate = Vec3d(translate);
    trs.rotate = glm::angleAxis(angle, glm::normalize(Vec3d(1.0, 2.0, -0.5)));
    trs.scale = Vec3d(scale);
    return {{trs}};
}

/// Clumps with holes, forward scattering, slightly yellow.
inline Volume clumps(float density_scale)
{
    Volume volume = clumpy_cube();
    volume.density_scale = density_scale;
    volume.albedo = {0.9f, 0.8f, 0.6f};
    volume.phase.g = 0.5f;
    finalize(volume);
    return volume;
}

/// A red-hot core that also absorbs, and a cold glow around it.
inline Volume flame()
{
    Volume volume =
        cube_volume(14, 1.0f, [](Vec3 p) { return std::max(0.0f, 1.0f - 4.0f * glm::dot(p, p)); });
    volume.density_scale = 2.0f;
    volume.albedo = Spectrum(0.3f);
    volume.temperature = volume.density;
    volume.emission = volume.density;
    volume.emission_params.blackbody_scale = 0.5f;
    volume.emission_params.temperature_scale = 2000.0f;
    volume.emission_params.temperature_offset = 800.0f;
    volume.emission_params.emission_scale = 0.3f;
    volume.emission_params.emission_color = {0.2f, 0.4f, 1.0f};
    volume.world_from_object = turned({0.2f, -0.6f, 0.1f}, 0.7);
    finalize(volume);
    return volume;
}

inline DistantLight sun()
{
    return {glm::normalize(Vec3(0.7f, 0.6f, 0.2f)), {2.0f, 1.8f, 1.5f}};
}

inline EnvironmentLight even_sky()
{
    return {{0.15f, 0.25f, 0.4f}, nullptr, Mat3(1.0f)};
}

/// Blue above, brown below, one pixel of 22 x 22 degrees a hundred times as bright.
inline EnvironmentLight image_sky()
{
    Buffer2D<Spectrum> pixels(16, 8, Spectrum(0.0f));
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 16; ++x) {
            pixels.at(x, y) = y < 4 ? Spectrum(0.1f, 0.2f, 0.4f) : Spectrum(0.1f, 0.05f, 0.02f);
        }
    }
    pixels.at(11, 2) = Spectrum(20.0f, 18.0f, 15.0f);
    EnvironmentLight light;
    light.map = make_environment_map(pixels, "sky with a sun");
    light.map_from_world = Mat3(glm::mat3_cast(glm::angleAxis(0.6f, Vec3(0.0f, 1.0f, 0.0f))));
    return light;
}

/// A sky with two suns of a few pixels, one of them low on the image's seam.
inline EnvironmentLight sunny_sky()
{
    Buffer2D<Spectrum> pixels(180, 90, Spectrum(0.0f));
    const auto disk = [](float x, float y, float cx, float cy) {
        return std::hypot(x - cx, y - cy) < 1.6f;
    };
    for (int y = 0; y < 90; ++y) {
        for (int x = 0; x < 180; ++x) {
            const auto fx = static_cast<float>(x);
            const auto fy = static_cast<float>(y);
            Spectrum& pixel = pixels.at(x, y);
            pixel = {0.1f, 0.15f + 0.001f * fy, 0.4f - 0.003f * fy};
            if (disk(fx, fy, 60.0f, 25.0f)) pixel = Spectrum(900.0f, 800.0f, 700.0f);
            if (disk(fx, fy, x < 90 ? 0.0f : 180.0f, 40.0f)) pixel = Spectrum(90.0f, 30.0f, 10.0f);
        }
    }
    EnvironmentLight light;
    light.radiance = {1.0f, 0.9f, 0.8f};
    light.map = make_environment_map(pixels, "sky with two suns");
    light.map_from_world = Mat3(glm::mat3_cast(glm::angleAxis(0.4f, Vec3(0.0f, 1.0f, 0.0f))));
    return light;
}

inline Scene lit_clumps(float density_scale)
{
    Scene scene;
    scene.camera = small_camera({0.5f, 0.4f, 3.2f});
    scene.media.volumes = {clumps(density_scale)};
    return scene;
}

inline TestScene sun_and_sky(float density_scale = 6.0f)
{
    TestScene out{"sun and sky, density " + std::to_string(density_scale),
                  lit_clumps(density_scale)};
    out.scene.lights = {sun()};
    out.scene.environment = even_sky();
    return out;
}

inline TestScene suns_in_the_image()
{
    TestScene out{"suns in the environment image", lit_clumps(6.0f)};
    out.scene.environment = sunny_sky();
    return out;
}

inline TestScene two_suns()
{
    TestScene out{"two suns of different colour", lit_clumps(6.0f)};
    out.scene.lights = {DistantLight{glm::normalize(Vec3(0.7f, 0.6f, 0.2f)), {2.0f, 0.5f, 0.1f}},
                        DistantLight{glm::normalize(Vec3(-0.7f, 0.1f, -0.5f)), {0.0f, 0.2f, 1.0f}}};
    return out;
}

inline TestScene sky_with_a_sun()
{
    TestScene out{"environment image with a small sun", lit_clumps(6.0f)};
    out.scene.environment = image_sky();
    return out;
}

inline TestScene camera_inside()
{
    TestScene out{"camera inside", lit_clumps(4.0f)};
    out.scene.camera = small_camera(Vec3(0.0f));
    out.scene.camera.tan_half_fov_y = 1.0f;
    out.scene.lights = {sun(), SphereLight{{0.3f, 0.2f, -0.4f}, 0.1f, Spectrum(3.0f)}};
    out.scene.environment = even_sky();
    return out;
}

/// Two bodies of different kind that overlap, neither along the axes.
inline Media overlapping_media()
{
    Volume a = clumps(5.0f);
    a.world_from_object = turned({-0.3f, 0.1f, 0.0f}, 0.4);
    a.albedo = {0.9f, 0.3f, 0.2f};
    a.phase = {0.7f, -0.4f, 0.3f};
    finalize(a);
    Volume b = unit_sphere(16);
    b.density_scale = 1.5f;
    b.albedo = {0.2f, 0.5f, 0.95f};
    b.phase.g = -0.3f;
    b.world_from_object = turned({0.3f, -0.1f, 0.2f}, -0.8, {0.9f, 0.6f, 0.7f});
    finalize(b);
    return {{a, b}};
}

inline TestScene overlapping()
{
    TestScene out{"overlapping turned volumes", lit_clumps(1.0f)};
    out.scene.media = overlapping_media();
    out.scene.lights = {sun(), PointLight{{1.2f, 0.9f, 0.8f}, {0.5f, 1.0f, 0.5f}}};
    out.scene.environment = image_sky();
    return out;
}

inline TestScene colour_grid()
{
    TestScene out{"albedo from a colour grid", lit_clumps(6.0f)};
    const auto channel = [](float f) {
        return *cube_volume(12, 2.0f, [f](Vec3 p) {
                    return 0.5f + 0.4f * std::sin(f * (p.x + 0.5f * p.y));
                }).density;
    };
    auto color = std::make_shared<ColorGrid>();
    for (int c = 0; c < 3; ++c) color->channel[c] = channel(2.0f + 2.0f * static_cast<float>(c));
    Volume& volume = out.scene.media.volumes[0];
    volume.color = color;
    volume.albedo = {1.0f, 0.9f, 0.8f};
    finalize(volume);
    out.scene.lights = {sun(), SphereLight{{-0.9f, 0.8f, 0.9f}, 0.2f, Spectrum(6.0f)}};
    out.scene.environment = even_sky();
    return out;
}

inline TestScene anisotropic(float g)
{
    TestScene out{"g = " + std::to_string(g), lit_clumps(4.0f)};
    Volume& volume = out.scene.media.volumes[0];
    volume.phase.g = g;
    finalize(volume);
    // The sun is 25 degrees off the line of sight, on the far side for g > 0.
    const float side = g > 0.0f ? -1.0f : 1.0f;
    out.scene.lights = {DistantLight{glm::normalize(Vec3(0.3f, 0.35f, side)), Spectrum(1.0f)},
                        SphereLight{{-0.4f, 0.3f, -1.3f}, 0.2f, Spectrum(3.0f)}};
    out.scene.environment = image_sky();
    return out;
}

inline TestScene spheres_in_smoke()
{
    TestScene out{"sphere lights in smoke", lit_clumps(4.0f)};
    out.scene.lights = {SphereLight{{0.3f, 0.2f, 0.1f}, 0.15f, {4.0f, 1.0f, 1.0f}},
                        SphereLight{{-0.4f, -0.1f, 0.3f}, 0.05f, {5.0f, 20.0f, 5.0f}},
                        SphereLight{{0.1f, -0.5f, -0.2f}, 0.3f, {0.2f, 0.2f, 2.0f}},
                        PointLight{{-0.9f, 0.9f, 0.6f}, Spectrum(0.5f)}};
    return out;
}

/// A narrow spot with a soft edge, a wide one with a sharp edge and one that misses, and a point.
inline TestScene spots_in_smoke()
{
    TestScene out{"spots in smoke", lit_clumps(4.0f)};
    const auto spot = [](Vec3 position, Vec3 at, Spectrum intensity, float inner, float outer) {
        return SpotLight{position, glm::normalize(at - position), intensity, inner, outer};
    };
    out.scene.lights = {
        spot({-0.9f, 1.0f, 0.8f}, {0.1f, -0.1f, 0.0f}, {4.0f, 2.0f, 1.0f}, 0.99f, 0.94f),
        spot({0.3f, 0.2f, 0.1f}, {0.3f, -1.0f, 0.4f}, {0.1f, 0.3f, 0.6f}, 0.1f, 0.1f),
        spot({0.9f, 0.9f, 0.9f}, {4.0f, 2.0f, 3.0f}, Spectrum(9.0f), 0.9f, 0.8f),
        PointLight{{-0.9f, -0.9f, 0.6f}, Spectrum(0.2f)}};
    return out;
}

/// One quad cuts through the smoke, one lies beside it and shines away from part of it.
inline TestScene quads()
{
    TestScene out{"quads in and near smoke", lit_clumps(4.0f)};
    out.scene.lights = {QuadLight{{-0.5f, -0.2f, -0.4f},
                                  {1.0f, 0.1f, 0.0f},
                                  {0.0f, 0.2f, 0.9f},
                                  {1.0f, 0.6f, 0.3f},
                                  false},
                        QuadLight{{0.6f, -0.8f, -0.8f},
                                  {0.1f, 1.5f, 0.2f},
                                  {-0.2f, 0.0f, 1.4f},
                                  {0.3f, 0.5f, 1.0f},
                                  true}};
    return out;
}

inline TestScene flame_in_smoke()
{
    TestScene out{"flame in smoke", lit_clumps(3.0f)};
    out.scene.media.volumes.push_back(flame());
    out.scene.lights = {PointLight{{-0.9f, 0.9f, 0.6f}, Spectrum(0.05f)}};
    return out;
}

/// Everything moves: the camera, the smoke and what glows in it, through a wide lens.
inline TestScene moving_through_a_lens()
{
    TestScene out{"lens and motion blur", lit_clumps(5.0f)};
    const auto set_moving = [](MovingTransform& transform, Vec3d by, double angle) {
        Trs end = transform.keys.front();
        end.translate += by;
        end.rotate = glm::normalize(end.rotate * glm::angleAxis(angle, Vec3d(0.0, 1.0, 0.0)));
        transform.keys = {transform.keys.front(), end};
    };
    set_moving(out.scene.camera.world_from_camera, {0.3, 0.0, -0.2}, 0.03);
    out.scene.camera.lens_radius = 0.2f;
    out.scene.camera.focus_distance = 3.0f;
    set_moving(out.scene.media.volumes[0].world_from_object, {0.4, -0.3, 0.1}, 0.5);
    Volume fire = flame();
    set_moving(fire.world_from_object, {0.0, 0.4, 0.0}, 1.0);
    finalize(fire);
    finalize(out.scene.media.volumes[0]);
    out.scene.media.volumes.push_back(fire);
    out.scene.lights = {sun()};
    out.scene.environment = image_sky();
    return out;
}

/// Thousands of small lamps of equal power, red to the left and blue to the right.
inline TestScene many_lamps(int count = 4000)
{
    TestScene out{"thousands of lamps", lit_clumps(4.0f)};
    for (int i = 0; i < count; ++i) {
        Rng rng(3, 0, Stream::Test, static_cast<uint32_t>(i), 0);
        const Vec3 p = Vec3(3.0f) * (rng.uniform3() - 0.5f);
        const Spectrum color = p.x < 0.0f ? Spectrum(3.0f, 0.2f, 0.0f) : Spectrum(0.1f, 0.8f, 3.0f);
        out.scene.lights.push_back(PointLight{p, color / static_cast<float>(count)});
    }
    return out;
}

/// Something of everything, and light of three events.
inline TestScene everything_at_once()
{
    TestScene out{"everything at once, three events", lit_clumps(1.0f), 3};
    out.scene.media = overlapping_media();
    out.scene.media.volumes.push_back(flame());
    out.scene.lights = {sun(), SphereLight{{0.3f, 0.2f, 0.1f}, 0.15f, {2.0f, 1.0f, 1.0f}},
                        QuadLight{{0.6f, -0.8f, -0.8f},
                                  {0.1f, 1.5f, 0.2f},
                                  {-0.2f, 0.0f, 1.4f},
                                  {0.1f, 0.2f, 0.3f},
                                  true}};
    out.scene.environment = image_sky();
    return out;
}

inline std::vector<TestScene> all_scenes()
{
    return {sun_and_sky(0.1f),
            sun_and_sky(6.0f),
            sun_and_sky(100.0f),
            two_suns(),
            sky_with_a_sun(),
            camera_inside(),
            overlapping(),
            colour_grid(),
            anisotropic(-0.9f),
            anisotropic(0.0f),
            anisotropic(0.95f),
            spheres_in_smoke(),
            quads(),
            spots_in_smoke(),
            flame_in_smoke(),
            moving_through_a_lens(),
            many_lamps(),
            everything_at_once(),
            suns_in_the_image()};
}

}  // namespace mote::test
