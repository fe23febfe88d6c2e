#pragma once

#include "restir/reuse_scenes.h"
#include "scene/environment.h"

namespace mote::test {

/// Scenes that are hard for reuse by their light or their medium. Unless they say otherwise the
/// camera moves and smoke is born, dies and moves, so that every domain differs from the one
/// before.
namespace scene_text {

/// Inside the smoke, wide open, flying and turning.
inline const char* const camera_inside = R"([camera]
fov = 80
keys = [ { frame = 1, position = [-0.1, 0, 0.15], look_at = [0.1, 0, -1] },
         { frame = 5, position = [0.1, 0.05, 0.05], look_at = [-0.1, 0.1, -1] } ]
)";

/// A thousand spheres of a voxel's size, in and around the smoke.
inline const char* const thousand_lamps = R"(
[[lights]]
type = "sphere"
count = 1000
spread = [3, 3, 3]
radius = 0.07
color = [1, 0.8, 0.6]
strength = 0.05
)";

/// A small, very bright sphere where the smoke is densest.
inline const char* const bright_lamp_inside = R"(
[[lights]]
type = "sphere"
position = [0.05, -0.05, 0.1]
radius = 0.08
strength = 20
)";

/// Sparks that fly, cool, die and are born again, as lamps.
inline const char* const sparks = R"(
[[particles]]
name = "sparks"
emitter = "plume"
count = 60
position = [0, -0.6, 0.3]
size = 0.4
speed = 1.5
lifetime = 0.6
start_time = -2
radius = 0.1
temperature = 2200
cooling = 1.5
color = [1, 0.7, 0.9]
[[lights]]
type = "sphere"
particles = "sparks"
radius_scale = 0.5
use_color = true
use_temperature = true
strength = 0.5
)";

inline std::string moving_puff()
{
    return evolving_puff(
        "transform = [ { frame = 1, translate = [-0.1, 0, 0] }, "
        "{ frame = 5, translate = [0.1, 0.1, 0] } ]\n");
}

}  // namespace scene_text

/// Dim everywhere but for a sun of 3 degrees, four thousand times as bright.
inline EnvironmentLight sky_with_small_sun()
{
    Buffer2D<Spectrum> pixels(128, 64, Spectrum(0.2f, 0.25f, 0.4f));
    pixels.at(84, 18) = Spectrum(900.0f, 800.0f, 700.0f);
    EnvironmentLight light;
    light.map = make_environment_map(pixels, "sky with a small sun");
    return light;
}

inline std::vector<Scene> small_sun_frames(int count)
{
    using namespace scene_text;
    std::vector<Scene> frames = frames_of(image() + moving_camera + moving_puff(), count);
    const EnvironmentLight sky = sky_with_small_sun();
    for (Scene& scene : frames) scene.environment = sky;
    return frames;
}

inline std::vector<Scene> thousand_lamps_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + moving_puff() + thousand_lamps, count);
}

inline std::vector<Scene> sparks_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + moving_puff() + sparks, count);
}

inline std::vector<Scene> camera_inside_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + camera_inside + moving_puff() + two_lamps, count);
}

inline std::vector<Scene> bright_lamp_inside_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + moving_puff() + bright_lamp_inside, count);
}

/// Everything moves, with another medium: mean cosine, and density relative to depth 3.
inline std::vector<Scene> with_medium(std::vector<Scene> frames, float g, float density)
{
    for (Scene& scene : frames) {
        for (Volume& volume : scene.media.volumes) {
            volume.phase.g = g;
            volume.density_scale *= density;
            finalize(volume);
        }
    }
    return frames;
}

/// Sun, sky and a lamp well outside: close to a sphere light a sharp phase function is noise, since
/// no direction drawn from it looks for spheres.
inline std::vector<Scene> sharp_phase_frames(int count, float g)
{
    using namespace scene_text;
    const char* const lamp =
        "[[lights]]\ntype = \"sphere\"\nposition = [1.5, 1.2, 0.8]\n"
        "radius = 0.2\nstrength = 20\n";
    return with_medium(
        frames_of(image() + moving_camera + moving_puff() + sun_and_sky + lamp, count), g, 1.0f);
}

inline std::vector<Scene> backward_frames(int count)
{
    return sharp_phase_frames(count, -0.9f);
}

inline std::vector<Scene> forward_frames(int count)
{
    return sharp_phase_frames(count, 0.95f);
}

/// Optical depth about 0.1 through the middle.
inline std::vector<Scene> thin_frames(int count)
{
    return with_medium(everything_moves_frames(count), 0.3f, 0.033f);
}

/// Optical depth about 100.
inline std::vector<Scene> thick_frames(int count)
{
    return with_medium(everything_moves_frames(count), 0.3f, 33.0f);
}

}  // namespace mote::test
