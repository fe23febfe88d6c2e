#include <gtest/gtest.h>

#include "runs/methods.h"
#include "runs/modes.h"
#include "runs/pilot.h"
#include "support/expect_error.h"
#include "support/scene_files.h"

namespace mote {

namespace {

using Names = std::vector<std::string>;

Names names_of(const std::vector<Method>& methods)
{
    Names names;
    for (const Method& method : methods) names.push_back(method.name);
    return names;
}

Names paths_of(const std::vector<Method>& methods)
{
    Names names;
    for (const Method& method : methods) {
        if (method.is_reference) names.push_back(method.name);
    }
    return names;
}

Method method_of(bool is_reference, int samples)
{
    Method method = all_methods().front();
    method.is_reference = is_reference;
    method.samples_per_frame = samples;
    return method;
}

}  // namespace

TEST(Methods, TheLightsOfTheSceneDecideWhatIsMeasured)
{
    // Several lights, local lights, lights at infinity.
    EXPECT_EQ(paths_of(choose_methods("", {false, false, true})), (Names{"path", "path-exact"}));
    const Names one_lamp = paths_of(choose_methods("", {false, true, false}));
    EXPECT_EQ(one_lamp, (Names{"path", "path-exact", "path-equi", "path-equi-exact"}));
    const Names many = paths_of(choose_methods("", {true, true, false}));
    EXPECT_EQ(many.size(), 12u);
    EXPECT_EQ(many.front(), "path-power");
    // The preview is the closed form of lights at infinity alone.
    const auto is_measured = [](const char* name, const SceneTraits& traits) {
        const Names names = names_of(choose_methods("", traits));
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    EXPECT_TRUE(is_measured("restir-preview", {false, false, true}));
    EXPECT_FALSE(is_measured("restir-preview", {false, true, true}));
    EXPECT_TRUE(is_measured("restir-constant-mis", {false, true, true}));
    EXPECT_TRUE(is_measured("restir-both", {false, true, true}));
    EXPECT_FALSE(is_measured("restir-both", {false, false, true}));
    EXPECT_TRUE(is_measured("restir-both", {false, false, true, true}));
    EXPECT_FALSE(is_measured("restir-constant-mis", {false, false, true}));
    EXPECT_TRUE(is_measured("restir-reused-visibility", {false, false, true, true}));
    EXPECT_TRUE(is_measured("restir-weighted-visibility", {false, false, true, true}));
    EXPECT_FALSE(is_measured("restir-reused-visibility", {true, true, true, false}));
    EXPECT_TRUE(is_measured("march", {false, true, true, false, false, 2}));
    EXPECT_FALSE(is_measured("march", {false, true, true, false, false, 1000}));
    EXPECT_FALSE(is_measured("march", {false, true, true, true, false, 2}));
}

TEST(Methods, AreChosenByNameAndBeginning)
{
    EXPECT_EQ(names_of(choose_methods("path-tree,path,path-tree", {})),
              (Names{"path-tree", "path"}));
    EXPECT_EQ(choose_methods("path-tree*", {}).size(), 4u);
    EXPECT_EQ(choose_methods("*", {}).size(), all_methods().size());
    expect_error([] { (void)choose_methods("path-tee", {}); }, ExitCode::Usage,
                 {"path-tee", "did you mean \"path-tree\""});
    expect_error([] { (void)find_method("path*"); }, ExitCode::Usage, {"no method"});
}

TEST(Methods, EditTheSettingsTheyAreNamedFor)
{
    RenderDescription render;
    find_method("path-tree-equi-exact").edit(render);
    EXPECT_EQ(render.path.light_sampler, LightSamplerKind::Tree);
    EXPECT_TRUE(render.path.equiangular);
    EXPECT_EQ(render.path.transmittance, TransmittanceKind::Exact);
    find_method("path-power").edit(render);
    EXPECT_EQ(render.path.light_sampler, LightSamplerKind::Power);
    EXPECT_FALSE(render.path.equiangular);
    EXPECT_EQ(render.path.transmittance, TransmittanceKind::ResidualRatio);
    find_method("restir-spatial").edit(render);
    EXPECT_EQ(render.estimator, EstimatorKind::Restir);
    EXPECT_EQ(render.restir.reuse, ReuseMode::Spatial);
    find_method("path").edit(render);
    EXPECT_EQ(render.estimator, EstimatorKind::Path);
}

TEST(Methods, AreCalledBiasedWhereTheSettingsAre)
{
    for (const Method& method : all_methods()) {
        RenderDescription render;
        method.edit(render);
        const bool is_right =
            render.estimator == EstimatorKind::Path ||
            (render.estimator == EstimatorKind::Restir && is_unbiased(render.restir));
        EXPECT_EQ(method.is_biased, !is_right) << method.name;
    }
}

TEST(Methods, RowsTakeEqualTimes)
{
    const std::vector<Pilot> pilots{{1.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {0.5, 0.0, 1.0}};
    const Method open = method_of(true, 0);
    // Nobody sets the time: four samples of the slowest row.
    EXPECT_EQ(equal_time_samples({open, open, open}, pilots, 0), (std::vector<int>{8, 4, 16}));
    EXPECT_EQ(equal_time_samples({open, open, open}, pilots, 5), (std::vector<int>{5, 5, 5}));
    // The second row takes 3 x 2 seconds.
    const Method fixed = method_of(false, 3);
    EXPECT_EQ(equal_time_samples({open, fixed, open}, pilots, 0), (std::vector<int>{6, 3, 12}));
    EXPECT_EQ(equal_time_samples({open, fixed, open}, pilots, 5), (std::vector<int>{5, 3, 5}));
    EXPECT_EQ(equal_time_samples({open}, {{1e-300, 0.0, 1.0}}, 0).size(), 1u);
}

TEST(Methods, TheReferenceIsTheBestPathTracer)
{
    const std::vector<Pilot> pilots{{1.0, 0.0, 4.0}, {2.0, 0.0, 1.0}, {0.1, 0.0, 0.1}};
    const Method path = method_of(true, 0);
    EXPECT_EQ(best_reference_row({path, path, method_of(false, 0)}, pilots), 1);
    EXPECT_EQ(best_reference_row({method_of(false, 0)}, {{1.0, 0.0, 1.0}}), -1);
}

TEST(Methods, OnlyHopelessPathTracersAreLeftOut)
{
    // Variance times time: 1, 2.9, 3.1, and 100 of a row that is no reference.
    const std::vector<Pilot> pilots{
        {1.0, 0.0, 1.0}, {1.0, 0.0, 2.9}, {3.1, 0.0, 1.0}, {10.0, 0.0, 10.0}};
    const Method path = method_of(true, 0);
    const Method other = method_of(false, 1);
    EXPECT_EQ(worth_measuring({path, path, path, other}, pilots),
              (std::vector<bool>{true, true, false, true}));
    EXPECT_EQ(worth_measuring({other}, {{10.0, 0.0, 10.0}}), std::vector<bool>{true});
}

TEST(Modes, FollowWhatMoves)
{
    using Modes = std::vector<BenchMode>;
    SceneDescription scene;
    EXPECT_EQ(choose_modes("", scene), (Modes{BenchMode::Still, BenchMode::Static}));
    EXPECT_EQ(choose_modes("moving,still", scene), (Modes{BenchMode::Moving, BenchMode::Still}));
    expect_error([&] { (void)choose_modes("stil", scene); }, ExitCode::Usage,
                 {"did you mean \"still\""});
    scene.volumes.emplace_back().procedural = ProceduralParams{};
    EXPECT_FALSE(is_animated(scene));
    scene.volumes.front().procedural->evolve = 1.0f;
    EXPECT_TRUE(is_animated(scene));
    EXPECT_EQ(choose_modes("", scene), Modes{BenchMode::Moving});
}

/// What can move in a scene of surfaces: keyframes, files of several frames, keyframes in files.
TEST(Modes, FollowWhatMovesOfObjects)
{
    const TemporaryFolder folder;
    const std::string asset = R"({"asset": {"version": "2.0"})";
    folder.write("still.gltf", asset + R"(, "animations": []})");
    folder.write("moving.gltf", asset + R"(, "animations": [{"channels": [], "samplers": []}]})");
    const auto moves = [&](const std::string& text) {
        return is_animated(load_scene(folder.write("scene.toml", text)));
    };
    const auto object = [](const std::string& keys) { return "[[objects]]\n" + keys + "\n"; };
    EXPECT_FALSE(moves(object("file = \"a.obj\"\ntransform = { translate = [1, 0, 0] }")));
    EXPECT_TRUE(
        moves(object("file = \"a.obj\"\ntransform = [{ frame = 1 }, { frame = 2, "
                     "translate = [1, 0, 0] }]")));
    EXPECT_TRUE(moves(object("file = \"a.####.obj\"")));
    EXPECT_FALSE(moves(object("file = \"still.gltf\"")));
    EXPECT_TRUE(moves(object("file = \"moving.gltf\"")));
    EXPECT_FALSE(moves("[camera]\nfile = \"still.gltf\"\n"));
    EXPECT_TRUE(moves("[camera]\nfile = \"moving.gltf\"\n"));
    const std::string lamp = "[[lights]]\ntype = \"point\"\n";
    EXPECT_FALSE(moves(lamp + "keys = [{ frame = 1, strength = 0 }]\n"));
    EXPECT_TRUE(moves(lamp + "keys = [{ frame = 1, strength = 0 }, { frame = 2 }]\n"));
}

TEST(Modes, AllShowTheSameFrameLast)
{
    SceneDescription scene;
    ProceduralParams puff;
    puff.voxel_size = 0.2f;
    puff.evolve = 1.0f;
    scene.volumes.emplace_back().procedural = puff;
    SceneCache cache;
    const FrameCounts counts{3, 2};
    const FramePlan still = plan_frames(scene, BenchMode::Still, 10, counts, cache);
    const FramePlan rest = plan_frames(scene, BenchMode::Static, 10, counts, cache);
    const FramePlan moving = plan_frames(scene, BenchMode::Moving, 10, counts, cache);
    EXPECT_EQ(still.frames.size(), 1u);
    EXPECT_EQ(still.sample_factor, 2);
    EXPECT_EQ(rest.frames.size(), 4u);
    EXPECT_EQ(moving.frames.size(), 4u);
    EXPECT_EQ(moving.sample_factor, 1);
    const auto grid = [](const Scene& s) { return s.media.volumes.front().density.get(); };
    EXPECT_EQ(grid(rest.frames.front()), grid(rest.frames.back()));
    EXPECT_NE(grid(moving.frames.front()), grid(moving.frames.back()));
    const FramePlan mean = plan_frames(scene, BenchMode::Accumulated, 10, counts, cache);
    EXPECT_EQ(mean.frames.size(), 5u);  // two compared after three
    EXPECT_EQ(mean.compared, 2);
    EXPECT_EQ(grid(mean.frames.front()), grid(mean.frames.back()));
    EXPECT_EQ(frames_rendered(mean, true), 5);
    EXPECT_EQ(frames_rendered(mean, false), 2);
    EXPECT_EQ(frames_rendered(rest, false), 1);
    for (const FramePlan* plan : {&still, &rest, &moving}) {
        EXPECT_EQ(plan->frames.back().frame, 10);
        EXPECT_EQ(plan->frames.front().frame, 11 - static_cast<int>(plan->frames.size()));
    }
}

TEST(Modes, CameraTravelsAroundItsFocusToTheFrameCompared)
{
    SceneDescription scene;
    scene.camera.position = Vec3d(1.0, 2.0, 5.0);
    scene.camera.look_at = Vec3d(0.0, 1.0, 0.0);
    ProceduralParams puff;
    puff.voxel_size = 0.2f;
    puff.evolve = 1.0f;
    scene.volumes.emplace_back().procedural = puff;
    SceneCache cache;
    const FramePlan plan = plan_frames(scene, BenchMode::Camera, 10, {3, 2}, cache);
    ASSERT_EQ(plan.frames.size(), 4u);
    const auto place = [&](size_t i) {
        return plan.frames[i].camera.world_from_camera.keys.front().translate;
    };
    EXPECT_EQ(place(3), scene.camera.position);
    const double radius = glm::length(scene.camera.position - scene.camera.look_at);
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_NEAR(glm::length(place(i) - scene.camera.look_at), radius, 1e-5);  // float focus
        const std::optional<Vec2> film =
            project(plan.frames[i].camera, Vec3(scene.camera.look_at), 0.0f);
        ASSERT_TRUE(film);
        EXPECT_NEAR(film->x, 0.5f * static_cast<float>(plan.frames[i].camera.width), 1e-2f);
        EXPECT_EQ(plan.frames[i].media.volumes.front().density,
                  plan.frames[3].media.volumes.front().density);
    }
    // Three steps of one degree at the circle's radius, which here is the distance.
    EXPECT_NEAR(glm::length(place(0) - place(3)),
                2.0 * radius * std::sin(0.5 * glm::radians(3.0 * camera_step)), 1e-4);
}

}  // namespace mote
