#include <gtest/gtest.h>

#include "core/parallel.h"
#include "render/frame.h"
#include "support/media.h"
#include "support/surface_scene.h"

namespace mote {
namespace {

/// A tilted floor below a cube of smoke, seen from above and aside; a lamp; half the view is sky.
Scene make_scene()
{
    Scene scene;
    scene.camera.width = 24;
    scene.camera.height = 16;
    scene.camera.world_from_camera.keys[0].translate = Vec3d(0.0, 0.0, 5.0);
    Volume smoke = test::constant_cube(10, 1.0f);
    smoke.density_scale = 0.7f;
    finalize(smoke);
    scene.media.volumes.push_back(smoke);
    scene.environment = EnvironmentLight{Spectrum(0.2f), nullptr, glm::mat3(1.0f)};
    scene.lights = {PointLight{Vec3(1.0f, 2.0f, 2.0f), Spectrum(5.0f)}};
    Trs turned;
    turned.rotate = glm::angleAxis(0.4, Vec3d(1.0, 0.0, 0.0));
    turned.translate = Vec3d(0.0, -0.2, -1.0);
    test::add_surfaces(
        scene,
        {{test::quad_mesh(Vec3(-2.0f, -1.0f, 0.0f), Vec3(4.0f, 0.0f, 0.0f), Vec3(0.0f, 1.6f, 0.0f)),
          test::diffuse(Spectrum(0.8f, 0.4f, 0.2f), Spectrum(0.1f)), turned}});
    return scene;
}

LayeredImage render(const Scene& scene, std::vector<std::string> aovs, EstimatorKind estimator,
                    int samples = 16)
{
    RenderDescription description;
    description.width = scene.camera.width;
    description.height = scene.camera.height;
    description.samples = samples;
    description.estimator = estimator;
    description.path.max_bounces = 3;
    OutputDescription output;
    output.aovs = std::move(aovs);
    output.color_type = PixelType::Float;
    FrameHistory history;
    FrameStats stats;
    return render_frame(scene, description, output, history, nullptr, stats);
}

const Buffer2D<float>& channel(const LayeredImage& image, const std::string& name)
{
    for (const auto& c : image.channels) {
        if (c.name == name) return c.data;
    }
    throw std::runtime_error(name);
}

class SurfaceLayers : public testing::TestWithParam<EstimatorKind> {};

TEST_P(SurfaceLayers, PartsSumToTheImage)
{
    const LayeredImage image = render(make_scene(),
                                      {"direct", "indirect", "emission", "volume_direct",
                                       "volume_indirect", "volume_emission", "background"},
                                      GetParam());
    double total[7] = {};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            double sum = 0.0;
            int part = 0;
            for (const char* name : {"direct.R", "indirect.R", "emission.R", "volume_direct.R",
                                     "volume_indirect.R", "volume_emission.R", "background.R"}) {
                const double value = static_cast<double>(channel(image, name).at(x, y));
                total[part++] += value;
                sum += value;
            }
            EXPECT_NEAR(sum, channel(image, "R").at(x, y), 1e-5);
        }
    }
    for (const int part : {0, 1, 2, 3, 4, 6}) EXPECT_GT(total[part], 0.0) << part;
    EXPECT_EQ(total[5], 0.0);
}

TEST_P(SurfaceLayers, NormalsPlacesAndDepths)
{
    const Scene scene = make_scene();
    const LayeredImage image =
        render(scene, {"N", "P", "Z", "albedo", "volume_Z", "transmittance"}, GetParam());
    const Vec3 normal(0.0f, -std::sin(0.4f), std::cos(0.4f));
    int on_surface = 0;
    int beside = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto at = [&](const char* name) { return channel(image, name).at(x, y); };
            const Vec3 n(at("N.X"), at("N.Y"), at("N.Z"));
            const Vec3 p(at("P.X"), at("P.Y"), at("P.Z"));
            if (n == Vec3(0.0f)) {
                ++beside;
                EXPECT_EQ(p, Vec3(0.0f));
                continue;
            }
            ++on_surface;
            EXPECT_LT(glm::length(n - normal), 1e-4f);
            // The mean of places of a plane is on it.
            EXPECT_NEAR(glm::dot(p - Vec3(0.0f, -0.2f, -1.0f), normal), 0.0f, 1e-4f);
            const bool is_clear = at("transmittance.R") > 0.999f;
            if (!is_clear || at("A") < 1.0f) continue;
            EXPECT_NEAR(at("Z"), 5.0f - p.z, 0.2f);
            EXPECT_EQ(at("volume_Z.Z"), 1e10f);
            EXPECT_NEAR(at("albedo.R"), 0.8f, 1e-4f);
        }
    }
    EXPECT_GT(on_surface, 20);
    EXPECT_GT(beside, 20);
}

/// A ball before the floor, of another material: whole numbers, those of what is nearest.
TEST_P(SurfaceLayers, MaterialsByNumber)
{
    Scene scene = make_scene();
    scene.lights.resize(1);
    const auto floor =
        test::quad_mesh(Vec3(-2.0f, -1.0f, 0.0f), Vec3(4.0f, 0.0f, 0.0f), Vec3(0.0f, 1.6f, 0.0f));
    test::add_surfaces(scene, {{floor, test::diffuse(Spectrum(0.8f))},
                               {test::sphere_mesh(0.6f, 12), test::diffuse(Spectrum(0.1f))}});
    const LayeredImage image = render(scene, {"material_id", "P", "N"}, GetParam(), 64);
    int seen[3] = {};
    int shared = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto at = [&](const char* name) { return channel(image, name).at(x, y); };
            const float id = at("material_id.Y");
            ASSERT_TRUE(id == 0.0f || id == 1.0f || id == 2.0f) << id;
            ++seen[static_cast<int>(id)];
            EXPECT_EQ(id == 0.0f, Vec3(at("N.X"), at("N.Y"), at("N.Z")) == Vec3(0.0f));
            // The floor is the plane z = 0; a pixel that has any of the ball is the ball's.
            if (id == 1.0f) {
                EXPECT_NEAR(at("P.Z"), 0.0f, 1e-5f);
            } else if (id == 2.0f) {
                EXPECT_GT(at("P.Z"), 0.0f);
            }
            shared += id == 2.0f && at("P.Z") < 0.1f ? 1 : 0;
        }
    }
    for (const int count : seen) EXPECT_GT(count, 10);
    EXPECT_GT(shared, 0);
}

TEST_P(SurfaceLayers, MotionOfSurfaces)
{
    // The floor moves by 0.3 m to the right until the next frame, the camera stands.
    Scene scene = make_scene();
    scene.media.volumes.clear();
    NextFrame next;
    next.camera = scene.camera;
    MovingTransform moved = scene.surfaces->bvh->instances()[0].world_from_object;
    moved.keys[0].translate.x += 0.3;
    next.world_from_surface = {moved};
    scene.next = next;
    const LayeredImage image = render(scene, {"motion", "P"}, GetParam());
    int seen = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const auto at = [&](const char* name) { return channel(image, name).at(x, y); };
            if (at("A") < 1.0f) continue;
            const Vec3 p(at("P.X"), at("P.Y"), at("P.Z"));
            const auto now = project(scene.camera, p, 0.0f);
            const auto then = project(scene.camera, p + Vec3(0.3f, 0.0f, 0.0f), 0.0f);
            ASSERT_TRUE(now && then);
            EXPECT_NEAR(at("motion.u"), then->x - now->x, 0.02f);
            EXPECT_NEAR(at("motion.v"), 0.0f, 1e-3f);
            ++seen;
        }
    }
    EXPECT_GT(seen, 20);
}

TEST_P(SurfaceLayers, ImagesDoNotDependOnThreads)
{
    const auto render_all = [] {
        return render(make_scene(), {"N", "direct", "indirect"}, GetParam(), 8);
    };
    LayeredImage one;
    LayeredImage four;
    run_with_threads(1, [&] { one = render_all(); });
    run_with_threads(4, [&] { four = render_all(); });
    ASSERT_EQ(one.channels.size(), four.channels.size());
    for (size_t c = 0; c < one.channels.size(); ++c) {
        for (int y = 0; y < one.height; ++y) {
            for (int x = 0; x < one.width; ++x) {
                EXPECT_EQ(one.channels[c].data.at(x, y), four.channels[c].data.at(x, y));
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Estimators, SurfaceLayers,
                         testing::Values(EstimatorKind::Path, EstimatorKind::Restir),
                         [](const testing::TestParamInfo<EstimatorKind>& each) {
                             return each.param == EstimatorKind::Path ? "path" : "restir";
                         });

}  // namespace
}  // namespace mote
