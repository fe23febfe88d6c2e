#pragma once

#include "restir/reuse_judge.h"
#include "restir/room_scenes.h"

namespace mote::test {

/// Rooms of `count` frames; `state` tells each one's.
[[nodiscard]] inline std::vector<Scene> rooms(int count, RoomState (*state)(float step))
{
    std::vector<Scene> frames;
    for (int i = 0; i < count; ++i) {
        frames.push_back(room(state(static_cast<float>(i))));
        frames.back().frame = 1 + i;
    }
    return frames;
}

/// The same scene, meshes included, in frames of their own: nothing has changed.
[[nodiscard]] inline std::vector<Scene> still_frames_of(const Scene& scene, int count)
{
    std::vector<Scene> frames(static_cast<size_t>(count), scene);
    for (int i = 0; i < count; ++i) frames[static_cast<size_t>(i)].frame = 1 + i;
    return frames;
}

[[nodiscard]] inline std::vector<Scene> still_rooms(int count)
{
    return still_frames_of(room(), count);
}

[[nodiscard]] inline std::vector<Scene> moving_cameras(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.camera = {0.5f - 0.25f * step, 0.4f + 0.1f * step, 3.2f - 0.1f * step};
        return state;
    });
}

[[nodiscard]] inline std::vector<Scene> moving_objects(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.block = {-0.8f + 0.3f * step, -0.7f + 0.1f * step, 0.4f};
        state.block_angle = 0.3 * static_cast<double>(step);
        return state;
    });
}

/// The sphere flies, the panel is switched off and on again.
[[nodiscard]] inline std::vector<Scene> changing_lights(int count)
{
    return rooms(count, [](float step) {
        RoomState state;
        state.lamp = {1.0f - 0.4f * step, 0.3f, 0.8f};
        state.lamp_radiance = 5.0f + step;
        state.panel = static_cast<int>(step) % 2 == 0 ? 0.5f : 20.0f;
        return state;
    });
}

/// Where the posts' lamps are and whether they shine.
struct PostsState {
    float step = 0.0f;  ///< the red lamp and the camera go on
    Spectrum green{3.0f, 30.0f, 3.0f};
    bool has_blue = true;  ///< else there are two lamps
};

/// Posts between three small lamps, red, green and blue, and a floor with a wall behind: half of
/// what is seen is in the shadow of each. Nothing in the air.
inline Scene posts(const PostsState& state = {})
{
    Scene scene;
    scene.camera = small_camera({0.5f + 0.15f * state.step, 0.4f, 3.2f});
    scene.lights = {
        SphereLight{{-1.3f + 0.25f * state.step, -0.2f, 1.0f}, 0.06f, {40.0f, 6.0f, 4.0f}},
        SphereLight{{1.4f, 0.0f, 0.7f}, 0.06f, state.green},
        SphereLight{{0.2f, 0.7f, 1.2f}, 0.06f, {3.0f, 5.0f, 50.0f}}};
    if (!state.has_blue) scene.lights.pop_back();
    std::vector<Thing> things{
        {quad_mesh({-4.0f, -0.8f, -4.0f}, {0.0f, 0.0f, 8.0f}, {8.0f, 0.0f, 0.0f}),
         diffuse(Spectrum(0.7f))},
        {quad_mesh({-4.0f, -1.0f, -1.0f}, {8.0f, 0.0f, 0.0f}, {0.0f, 5.0f, 0.0f}),
         diffuse({0.6f, 0.7f, 0.6f})}};
    for (int i = 0; i < 6; ++i) {
        const Vec3 p(-1.0f + 0.4f * static_cast<float>(i), -0.8f, i % 2 == 0 ? 0.1f : -0.5f);
        things.push_back({box_mesh(p, p + Vec3(0.15f, 1.1f, 0.15f)), diffuse(Spectrum(0.5f))});
    }
    add_surfaces(scene, std::move(things));
    return scene;
}

[[nodiscard]] inline std::vector<Scene> still_posts(int count)
{
    return still_frames_of(posts(), count);
}

/// The camera and a lamp move, another is dimmed and lit again.
[[nodiscard]] inline std::vector<Scene> moving_posts(int count)
{
    std::vector<Scene> frames;
    for (int i = 0; i < count; ++i) {
        const Spectrum green(3.0f, i % 2 == 1 ? 30.0f : 3.0f, 3.0f);
        frames.push_back(posts({static_cast<float>(i), green}));
        frames.back().frame = 1 + i;
    }
    return frames;
}

/// Nothing moves, but in turns one lamp is black and another is taken out of the scene: of four
/// frames the last has a lamp that the one before knew as black, and lacks another.
[[nodiscard]] inline std::vector<Scene> switched_posts(int count)
{
    std::vector<Scene> frames;
    for (int i = 0; i < count; ++i) {
        const bool is_odd = i % 2 == 1;
        frames.push_back(
            posts({0.0f, is_odd ? Spectrum(3.0f, 30.0f, 3.0f) : Spectrum(0.0f), !is_odd}));
        frames.back().frame = 1 + i;
    }
    return frames;
}

/// Weights between surfaces' reservoirs and what they know of shadows.
struct SurfaceForm {
    ReuseMis mis;
    SurfaceVisibility visibility;
    ReuseMode reuse = ReuseMode::Both;
    SurfaceShading shading = SurfaceShading::Auto;

    [[nodiscard]] std::string name() const
    {
        constexpr const char* shadings[] = {"", " chosen", " all"};
        constexpr const char* weights[] = {"auto", "pairwise", "balance", "constant",
                                           "contribution"};
        constexpr const char* shadows[] = {"exact", "none", "reused", "weighted"};
        return fmt::format("{} {}{}{}", weights[static_cast<size_t>(mis)],
                           shadows[static_cast<size_t>(visibility)],
                           reuse == ReuseMode::Spatial ? " spatial" : "",
                           shadings[static_cast<size_t>(shading)]);
    }
    [[nodiscard]] RestirParams params() const
    {
        RestirParams p = reuse_params(reuse, ShiftKind::RandomNumbers);
        p.surface.mis = mis;
        p.surface.visibility = visibility;
        p.surface.shading = shading;
        // Few pixels: neighbours that are not alike must be among those that take part.
        p.surface.radius_px = 3.0f;
        return p;
    }
};

/// For the names of tests.
inline void PrintTo(const SurfaceForm& form, std::ostream* out)
{
    *out << form.name();
}

/// Every form; the reuse of each is Both, and Spatial besides where that makes it unbiased. Those
/// by default shade what `auto` says; two more shade otherwise.
[[nodiscard]] inline std::vector<SurfaceForm> all_surface_forms()
{
    std::vector<SurfaceForm> forms;
    for (const ReuseMis mis :
         {ReuseMis::Pairwise, ReuseMis::Balance, ReuseMis::Contribution, ReuseMis::Constant}) {
        for (const SurfaceVisibility visibility :
             {SurfaceVisibility::Exact, SurfaceVisibility::None, SurfaceVisibility::Reused,
              SurfaceVisibility::Weighted}) {
            forms.push_back({mis, visibility});
        }
        if (mis == ReuseMis::Pairwise || mis == ReuseMis::Balance) {
            forms.push_back({mis, SurfaceVisibility::Weighted, ReuseMode::Spatial});
        }
    }
    forms.push_back(
        {ReuseMis::Pairwise, SurfaceVisibility::Exact, ReuseMode::Both, SurfaceShading::Chosen});
    forms.push_back(
        {ReuseMis::Pairwise, SurfaceVisibility::None, ReuseMode::Both, SurfaceShading::All});
    return forms;
}

}  // namespace mote::test
