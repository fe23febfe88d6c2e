#pragma once

#include <string>
#include <vector>

#include "scene/prepare.h"
#include "support/scene_files.h"

namespace mote::test {

/// The frames 1..n of a scene, as one run of the renderer would prepare them.
inline std::vector<Scene> frames_of(const std::string& toml, int count)
{
    const SceneDescription description = load_text(toml);
    SceneCache cache;
    std::vector<Scene> frames;
    for (int frame = 1; frame <= count; ++frame) {
        PrepareStats stats;
        frames.push_back(prepare_frame(description, frame, {true, false}, cache, stats));
    }
    return frames;
}

/// Parts of small scenes. All are seen from +z by a film of 8 x 6 pixels unless said otherwise.
namespace scene_text {

inline std::string image(int width = 8, int height = 6)
{
    return "[render]\nwidth = " + std::to_string(width) + "\nheight = " + std::to_string(height) +
           "\n";
}

inline const char* const still_camera = "[camera]\nposition = [0, 0, 2.6]\nfov = 21\n";

/// Turns and moves sideways by about a pixel and a half per frame.
inline const char* const moving_camera = R"([camera]
fov = 21
keys = [ { frame = 1, position = [-0.6, 0, 2.6], look_at = [0.05, 0, 0] },
         { frame = 5, position = [0.6, 0.25, 2.3], look_at = [0, 0.05, 0] } ]
)";

/// Smoke with holes; optical depth about 3 through its middle. `more` adds keys.
inline std::string puff(const std::string& more = "", const std::string& shape = "")
{
    return "[[volumes]]\nprocedural = { type = \"puff\", voxel_size = 0.07, noise = 0.9" + shape +
           " }\ndensity_scale = 9\nalbedo = [0.9, 0.8, 0.6]\nphase = 0.3\n" + more;
}

/// Smoke that is born and dies: its support changes from frame to frame.
inline std::string evolving_puff(const std::string& more = "")
{
    return puff(more, ", evolve = 3");
}

/// Smoke that flies and turns by about a voxel and a half per frame.
inline std::string flying_puff()
{
    return puff(
        "transform = [ { frame = 1, translate = [-0.2, -0.1, 0] }, "
        "{ frame = 5, translate = [0.2, 0.1, 0.1], rotate = [0, 25, 20] } ]\n");
}

/// A sphere beside the smoke and one inside it, larger than a voxel.
inline const char* const two_lamps = R"(
[[lights]]
type = "sphere"
position = [0.9, 0.6, 0.5]
radius = 0.15
color = [1, 0.8, 0.6]
strength = 12
[[lights]]
type = "sphere"
position = [-0.15, -0.1, 0.1]
radius = 0.12
color = [0.4, 0.6, 1]
strength = 0.6
)";

/// Nine spheres in and around the smoke.
inline const char* const nine_lamps = R"(
[[lights]]
type = "sphere"
count = 9
spread = [0.9, 0.9, 0.9]
radius = 0.08
color = [1, 0.8, 0.6]
strength = 3
)";

inline const char* const sun_and_sky = R"(
[[lights]]
type = "distant"
direction = [1, 1, 0.4]
strength = 3
[[lights]]
type = "environment"
color = [0.4, 0.6, 1]
strength = 0.4
)";

}  // namespace scene_text

/// Smoke in the light of two lamps, nothing moves.
inline std::vector<Scene> still_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + still_camera + puff() + two_lamps, count);
}

inline std::vector<Scene> moving_camera_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + puff() + two_lamps, count);
}

inline std::vector<Scene> flying_smoke_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + still_camera + flying_puff() + two_lamps, count);
}

inline std::vector<Scene> evolving_smoke_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + still_camera + evolving_puff() + two_lamps, count);
}

/// Camera, smoke and its shape at once.
inline std::vector<Scene> everything_moves_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera +
                         evolving_puff("transform = [ { frame = 1, translate = [-0.1, 0, 0] }, "
                                       "{ frame = 5, translate = [0.1, 0.1, 0] } ]\n") +
                         two_lamps,
                     count);
}

/// Lamps that fly, appear, vanish and so change their numbers.
inline std::vector<Scene> changing_lights_frames(int count)
{
    std::vector<Scene> frames = still_frames(count);
    for (size_t i = 0; i < frames.size(); ++i) {
        const float step = static_cast<float>(i);
        std::vector<Light>& lights = frames[i].lights;
        std::get<SphereLight>(lights[0]).position += Vec3(-0.3f * step, 0.1f * step, 0.0f);
        const SphereLight visitor{{-0.7f, 0.5f, 0.6f}, 0.2f, Spectrum(3.0f, 6.0f, 3.0f)};
        // Now first in the list, now last, now absent: what others are called changes.
        if (i % 3 == 1) lights.insert(lights.begin(), visitor);
        if (i % 3 == 2) lights.push_back(visitor);
        if (i % 4 == 3) lights.erase(lights.begin() + 1);
    }
    return frames;
}

/// Two media in one place that fly through each other, of different colour and phase function.
inline std::vector<Scene> overlapping_frames(int count)
{
    using namespace scene_text;
    const std::string red =
        "[[volumes]]\nprocedural = { type = \"sphere\", size = 0.8, voxel_size = 0.08 }\n"
        "density_scale = 3\nalbedo = [0.9, 0.2, 0.1]\nphase = -0.4\n"
        "transform = [ { frame = 1, translate = [0.3, 0, 0.1] }, "
        "{ frame = 5, translate = [-0.2, 0.2, 0] } ]\n";
    return frames_of(image() + still_camera + puff() + red + two_lamps, count);
}

/// Many small lamps inside smoke that flies by.
inline std::vector<Scene> lamps_in_smoke_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + flying_puff() + nine_lamps, count);
}

/// Glowing smoke lights itself and smoke beside it.
inline std::vector<Scene> flame_frames(int count)
{
    using namespace scene_text;
    const std::string flame =
        "[[volumes]]\nprocedural = { type = \"puff\", size = 0.6, voxel_size = 0.06, "
        "noise = 0.8, evolve = 2 }\ndensity_scale = 4\nalbedo = 0.3\n"
        "emission = { scale = 3, color = [1, 0.5, 0.2] }\n"
        "transform = [ { frame = 1, translate = [-0.1, -0.3, 0.2] }, "
        "{ frame = 5, translate = [0.1, -0.2, 0.2] } ]\n";
    return frames_of(image() + still_camera + puff() + flame, count);
}

/// Sun and sky, while smoke changes and the camera moves.
inline std::vector<Scene> sun_and_sky_frames(int count)
{
    using namespace scene_text;
    return frames_of(image() + moving_camera + evolving_puff() + sun_and_sky, count);
}

/// Drawn particles, with velocities, that fly apart.
inline std::vector<Scene> burst_frames(int count)
{
    using namespace scene_text;
    const std::string burst =
        "[[particles]]\nname = \"burst\"\nemitter = \"burst\"\ncount = 3000\nsize = 0.2\n"
        "speed = 2\ndrag = 2\nturbulence = 0.5\nlifetime = 3\nradius = 0.12\nmass = 1\n"
        "voxel_size = 0.08\nstart_time = -0.1\n"
        "[[volumes]]\nparticles = \"burst\"\ndensity_scale = 2\nalbedo = 0.8\nphase = 0.2\n";
    return frames_of(image() + still_camera + burst + two_lamps, count);
}

/// A flame that goes out and is lit again beside lamps and sky: kinds of lights change numbers.
inline std::vector<Scene> flickering_flame_frames(int count)
{
    using namespace scene_text;
    std::vector<Scene> frames = frames_of(
        image() + still_camera + puff("emission = { scale = 1 }\n") + two_lamps + sun_and_sky,
        count);
    for (size_t i = 0; i < frames.size(); ++i) {
        if (i % 2 == 0) continue;
        Volume& volume = frames[i].media.volumes[0];
        volume.emission = nullptr;
        volume.emission_params = {};
        finalize(volume);
        frames[i].lights.erase(frames[i].lights.begin());
    }
    return frames;
}

/// A one-sided lamp in the smoke: most candidates bring nothing.
inline std::vector<Scene> dark_side_frames(int count)
{
    std::vector<Scene> frames = still_frames(count);
    for (Scene& scene : frames) {
        scene.lights = {QuadLight{
            {-0.3f, -0.3f, 0.1f}, {0.0f, 0.6f, 0.0f}, {0.6f, 0.0f, 0.0f}, Spectrum(3.0f), false}};
    }
    return frames;
}

/// Far more parallax than between frames of a film.
inline std::vector<Scene> flight_around_frames(int count)
{
    using namespace scene_text;
    return frames_of(
        image() +
            "[camera]\nfov = 24\nkeys = [ { frame = 1, position = [-1.6, 0, 2.4], look_at = [0, 0, "
            "0] }, { frame = 5, position = [1.6, 0, 2.4], look_at = [0, 0, 0] } ]\n" +
            puff() + two_lamps,
        count);
}

}  // namespace mote::test
