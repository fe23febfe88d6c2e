#pragma once

#include <string>
#include <vector>

#include "render/frame.h"
#include "support/media.h"

namespace mote::test {

/// Camera at (0, 0, 4) looking along -z with a half field of view of 31 degrees.
inline Camera front_camera(int width, int height)
{
    Camera camera;
    camera.width = width;
    camera.height = height;
    camera.tan_half_fov_y = 0.6f;
    Trs pose;
    pose.translate = {0.0, 0.0, 4.0};
    camera.world_from_camera.keys = {pose};
    return camera;
}

/// How a picture is made.
struct Options {
    RenderDescription render;
    OutputDescription output;
};

/// By the path tracer.
inline Options options(int samples, int bounces, std::vector<std::string> aovs)
{
    Options o;
    o.render.estimator = EstimatorKind::Path;
    o.render.samples = samples;
    o.render.path.max_bounces = bounces;
    o.render.seed = 5;
    o.output.aovs = std::move(aovs);
    o.output.color_type = PixelType::Float;
    return o;
}

inline LayeredImage render(const Scene& scene, const Options& o, FrameStats* stats = nullptr)
{
    FrameStats own;
    FrameHistory history;
    return render_frame(scene, o.render, o.output, history, nullptr, stats ? *stats : own);
}

inline double mean_of(const LayeredImage& image, const std::string& channel)
{
    double sum = 0.0;
    for (const float v : image.find(channel)->data) sum += static_cast<double>(v);
    return sum / static_cast<double>(image.find(channel)->data.size());
}

/// A slab of smoke, albedo 0.5, 11 voxels of 0.2 m thick, seen almost along the axis.
inline Scene slab_scene(float sigma_t)
{
    Scene scene;
    scene.camera = front_camera(20, 20);
    scene.camera.tan_half_fov_y = 0.01f;
    Volume slab = test::constant_cube(11, 2.0f);
    slab.density_scale = sigma_t;
    slab.albedo = Spectrum(0.5f);
    finalize(slab);
    scene.media.volumes = {slab};
    scene.lights = {PointLight{{0.0f, 5.0f, 0.0f}, Spectrum(1.0f)}};
    return scene;
}

}  // namespace mote::test
