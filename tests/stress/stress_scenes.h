#pragma once

#include "restir/scenes.h"

namespace mote::test {

/// Camera of 16 x 9 pixels at `position`, looking at the origin.
[[nodiscard]] inline Camera stress_camera(Vec3 position)
{
    Camera camera = small_camera(position);
    camera.width = 16;
    camera.height = 9;
    return camera;
}

/// One medium in the light of everything there is: a lamp beside it and one inside it, a point, a
/// quad, a sun and a sky.
[[nodiscard]] inline Scene lit_by_all(const Volume& volume)
{
    Scene scene;
    scene.camera = stress_camera({0.5f, 0.4f, 3.2f});
    scene.media.volumes = {volume};
    scene.lights = {sun(), SphereLight{{-0.9f, 0.8f, 0.9f}, 0.2f, Spectrum(6.0f)},
                    SphereLight{{0.2f, 0.1f, 0.1f}, 0.1f, Spectrum(2.0f)},
                    PointLight{{1.2f, 0.9f, 0.8f}, Spectrum(0.7f)},
                    QuadLight{{0.6f, -0.8f, -0.8f},
                              {0.1f, 1.5f, 0.2f},
                              {-0.2f, 0.0f, 1.4f},
                              {0.3f, 0.5f, 1.0f},
                              true}};
    scene.environment = even_sky();
    return scene;
}

/// White furnace: no absorption, radiance 1 from everywhere. Seen from inside and outside, every
/// pixel is 1.
[[nodiscard]] inline Scene furnace_scene(Volume volume, float density_scale, float g)
{
    volume.density_scale = density_scale;
    volume.albedo = Spectrum(1.0f);
    volume.phase.g = g;
    finalize(volume);
    Scene scene;
    scene.camera = stress_camera({0.0f, 0.3f, 3.0f});
    scene.media.volumes = {volume};
    scene.environment = EnvironmentLight{};
    return scene;
}

}  // namespace mote::test
