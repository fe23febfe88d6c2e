#include <gtest/gtest.h>

#include "support/scene_files.h"

namespace mote {
namespace {

using test::problems_of;

struct Case {
    const char* text;
    const char* message;
};

TEST(SceneErrors, NamePlaceKeyAndRemedy)
{
    const Case cases[] = {
        {"[[volumes]]\nprocedural = \"puff\"\ndensty = 4",
         "scene.toml:3:1: error: unknown key \"densty\" in [volumes] (did you mean "
         "\"density_scale\"?)"},
        {"[render]\nspp = 4",
         "scene.toml:2:1: error: unknown key \"spp\" in [render] (did you mean \"samples\"?)"},
        {"samples = 4",
         "scene.toml:1:1: error: unknown key \"samples\" at the top level (it belongs in "
         "[render])"},
        {"[camera]\nfov = \"wide\"",
         "scene.toml:2:7: error: \"fov\" in [camera] must be a number, not text"},
        {"[camera]\nfov = 200",
         "scene.toml:2:7: error: \"fov\" in [camera] is 200, allowed: 0.01 to 179 [degrees]"},
        {"fps = nan", "scene.toml:1:7: error: \"fps\" at the top level must be finite"},
        {"[camera]\nposition = [0, inf, 0]",
         "scene.toml:2:16: error: \"position\" in [camera] must be finite"},
        {"[camera]\nposition = [0, 1]",
         "scene.toml:2:12: error: \"position\" in [camera] must be a list of 3 numbers, not of 2"},
        {"[camera]\nposition = [0, true, 1]",
         "scene.toml:2:16: error: \"position\" in [camera] must be a list of 3 numbers, not true "
         "or false"},
        {"[render]\nsamples = 1.5",
         "scene.toml:2:11: error: \"samples\" in [render] must be a whole number, not 1.5"},
        {"[render]\nsamples = 0",
         "scene.toml:2:11: error: \"samples\" in [render] is 0, allowed: 1 to 1e7"},
        {"[render]\nseed = -1",
         "scene.toml:2:8: error: \"seed\" in [render] is -1, allowed: at least 0"},
        // What an emitter cannot make is refused where it is written, not at the first frame.
        {"[[particles]]\nname = \"p\"\nemitter = \"plume\"\nspread = 90",
         "scene.toml:4:10: error: \"spread\" in [particles] is 90, allowed: 0 to 80 [degrees]"},
        {"[[particles]]\nname = \"p\"\nemitter = \"plume\"\nsize = 0",
         "scene.toml:4:8: error: \"size\" in [particles] is 0, allowed: above 0, at most 1e6 [m]"},
        {"[render]\nseed = 5000000000",
         "scene.toml:2:8: error: \"seed\" in [render] is 5000000000, allowed: 0 to 4294967295"},
        {"[render]\npath = { equiangular = 1 }",
         "scene.toml:2:24: error: \"equiangular\" in [render.path] must be true or false, not a "
         "number"},
        {"[render]\nestimator = \"bath\"",
         "scene.toml:2:13: error: \"estimator\" in [render] is \"bath\" (did you mean \"path\"?); "
         "known: path, restir"},
        {"[output]\naovs = [\"z\"]",
         "scene.toml:2:9: error: unknown \"z\" in \"aovs\" in [output] (did you mean \"Z\"?); "
         "known: Z, albedo, motion, variance, samples, volume_direct, volume_indirect, "
         "volume_emission, background, transmittance, optical_depth, volume_Z, restir, cost, work, "
         "direct, indirect, emission, N, P, material_id"},
        {"[output]\naovs = [\"Z\", \"Z\"]",
         "scene.toml:2:14: error: \"Z\" is twice in \"aovs\" in [output]"},
        {"[output]\npath = \"a\\u0000b\"",
         "scene.toml:2:8: error: \"path\" in [output] has control characters or is longer than "
         "4096 "
         "bytes"},
        {"[[particles]]\nemitter = \"plume\"",
         "scene.toml:1:1: error: missing key \"name\" in [particles]"},
        {"[[lights]]", "scene.toml:1:1: error: missing key \"type\" in [lights]"},
        {"[[particles]]\nname = \"p\"",
         "scene.toml:1:1: error: a particle system needs a source: \"emitter\" or \"file\""},
        {"[[particles]]\nname = \"p\"\nemitter = \"plume\"\nfile = \"a.ply\"",
         "scene.toml:1:1: error: a particle system has one source: \"emitter\" or \"file\""},
        {"[[particles]]\nname = \"p\"\nemitter = \"snow\"\nvelocity_unit = \"per_frame\"",
         "scene.toml:4:1: error: \"velocity_unit\" in [particles] has no meaning with \"emitter\"; "
         "it is for: file"},
        {"[[lights]]\ntype = \"point\"\nradius = 1",
         "scene.toml:3:1: error: \"radius\" in [lights] has no meaning with \"point\"; it is for: "
         "sphere"},
        {"[[volumes]]",
         "scene.toml:1:1: error: a volume needs \"file\", \"particles\" or \"procedural\" for its "
         "density"},
        {"[[volumes]]\nfile = \"a.vdb\"\nprocedural = \"puff\"",
         "scene.toml:1:1: error: a volume has one source: \"file\", \"particles\" or "
         "\"procedural\""},
        {"[[volumes]]\nfile = { offset = 3 }",
         "scene.toml:2:8: error: missing key \"path\" in [volumes.file]\n"
         "scene.toml:2:8: error: \"file\" in [volumes] is empty"},
        {"[[volumes]]\nparticles = \"plum\"\n[[particles]]\nname = \"plume\"\nemitter = \"plume\"",
         "scene.toml:2:13: error: no [[particles]] entry is named \"plum\" (did you mean "
         "\"plume\"?)"},
        {"[[volumes]]\nname = \"a\"\nprocedural = \"puff\"\n[[volumes]]\nname = \"a\"\nprocedural "
         "= \"puff\"",
         "scene.toml:5:8: error: name \"a\" is already that of [[volumes]] number 0"},
        {"[[volumes]]\nname = \"a.b\"\nprocedural = \"puff\"",
         "scene.toml:2:8: error: name \"a.b\" must not start with a digit or hold \".\" or \"=\""},
        {"[[volumes]]\nprocedural = { type = \"box\", voxel_size = 1e-4 }",
         "scene.toml:2:43: error: 10000 x 10000 x 10000 voxels are more than 10^9; choose a larger "
         "\"voxel_size\""},
        {"[[volumes]]\nprocedural = \"puff\"\ntransform = [{ frame = 2 }, { frame = 2 }]",
         "scene.toml:3:39: error: keyframes of \"transform\" in [volumes] must ascend: 2 after 2"},
        {"[[volumes]]\nprocedural = \"puff\"\ntransform = { scale = [1, 0, 1] }",
         "scene.toml:3:23: error: \"scale\" in [volumes.transform] must not be 0"},
        {"[camera]\nkeys = [{ frame = 5 }, { frame = 1 }]",
         "scene.toml:2:34: error: keyframes of the camera must ascend: 1 after 5"},
        {"[[lights]]\ntype = \"point\"\nkeys = [{ frame = 2 }, { frame = 2 }]",
         "scene.toml:3:34: error: keyframes of \"keys\" in [lights] must ascend: 2 after 2"},
        {"[render.restir.surface]\nmis = \"contribution\"\nshading = \"all\"",
         "scene.toml:3:11: error: \"shading\" = \"all\" needs weights for every sample, which "
         "\"mis\" = \"contribution\" has not; choose another \"mis\", or \"chosen\""},
        {"[camera]\nshutter_open = 0.5\nshutter_close = 0",
         "scene.toml:3:17: error: \"shutter_close\" is before \"shutter_open\""},
        {"[camera]\nlook_at = [0, 0, 5]",
         "scene.toml:1:1: error: \"position\" and \"look_at\" of the camera are the same point"},
        {"[camera]\nup = [0, 0, 1]",
         "scene.toml:1:1: error: \"up\" of the camera points along its view; choose another"},
        {"[[objects]]", "scene.toml:1:1: error: missing key \"file\" in [objects]"},
        {"[[objects]]\nfile = \"a.obj\"\nmaterial = \"gld\"\n[[materials]]\nname = \"gold\"",
         "scene.toml:3:12: error: no [[materials]] entry is named \"gld\" (did you mean "
         "\"gold\"?)"},
        {"[[objects]]\nfile = \"a.obj\"\nmaterial = { name = \"gold\", color = 1 }\n"
         "[[materials]]\nname = \"gold\"",
         "scene.toml:3:12: error: \"material\" in [objects] either names a [[materials]] entry or "
         "describes one"},
        {"[[objects]]\nfile = \"a.obj\"\nmaterial = { ior = 1.3 }",
         "scene.toml:3:14: error: \"ior\" in [objects.material] has no meaning with \"diffuse\"; "
         "it is for: dielectric"},
        {"[[materials]]\ncolor = 2",
         "scene.toml:1:1: error: a material needs a \"name\" to be used by\n"
         "scene.toml:2:9: error: \"color\" in [materials] is 2, allowed: 0 to 1"},
        {"[[materials]]\nname = \"a\"\nemission_texture = \"a.png\"\nalpha_cutoff = 0.5",
         "scene.toml:1:1: error: \"emission_texture\" multiplies \"emission\", which is 0; set "
         "it\nscene.toml:1:1: error: \"alpha_cutoff\" is about the alpha of \"color_texture\"; "
         "name one"},
        {"[camera]\nfile = \"a.glb\"\nfov = 30",
         "scene.toml:3:7: error: \"fov\" and \"file\" of the camera exclude each other"},
        {"[[lights]]\ntype = \"spot\"\ncone_angle = 190",
         "scene.toml:3:14: error: \"cone_angle\" in [lights] is 190, allowed: above 0, at most "
         "180 [degrees]"},
        {"first_frame = 5\nlast_frame = 4",
         "scene.toml:2:14: error: \"last_frame\" is 4, before \"first_frame\" 5"},
        {"[render]\nwidth = 65536\nheight = 65536",
         "scene.toml:2:9: error: 65536 x 65536 pixels are more than 2^28"},
        {"[[lights]]\ntype = \"environment\"\n[[lights]]\ntype = \"environment\"",
         "scene.toml:4:8: error: a scene has one environment light"},
        {"[[lights]]\ntype = \"distant\"\ndirection = [0, 0, 0]",
         "scene.toml:3:13: error: \"direction\" in [lights] must not be 0"},
        {"[[lights]]\ntype = \"sphere\"\nparticles = \"spark\"\nradius = 1\n[[particles]]\nname = "
         "\"sparks\"\nemitter = \"burst\"",
         "scene.toml:3:13: error: no [[particles]] entry is named \"spark\" (did you mean "
         "\"sparks\"?)\n"
         "scene.toml:4:10: error: \"radius\" of a light with \"particles\" comes from the "
         "particles; "
         "leave it out"},
        {"[[lights]]\ntype = \"sphere\"\nuse_color = true",
         "scene.toml:3:13: error: \"use_color\" of a light needs \"particles\""},
        {"[[lights]]\ntype = \"point\"\nparticles = \"sparks\"",
         "scene.toml:3:1: error: \"particles\" in [lights] has no meaning with \"point\"; it is "
         "for: sphere"},
        {"[[lights]]\ntype = \"quad\"\nedge_u = [0, 0, 2]",
         "scene.toml:3:10: error: \"edge_u\" and \"edge_v\" span no area"},
        {"volumes = 3",
         "scene.toml:1:11: error: \"volumes\" at the top level must be a list of tables "
         "([[volumes]]), not a number"},
        {"camera = 2020-01-01",
         "scene.toml:1:10: error: \"camera\" at the top level must be a table, not a date"},
        {"fps = = 3",
         "scene.toml:1:7: error: Error while parsing value: could not determine value type"},
    };
    for (const Case& c : cases) EXPECT_EQ(problems_of(c.text), c.message) << c.text;
}

TEST(SceneErrors, AllAreReportedInFileOrder)
{
    EXPECT_EQ(
        problems_of("fsp = 3\n[camera]\nfov = 0\n[render]\nsampels = 4\n"),
        "scene.toml:1:1: error: unknown key \"fsp\" at the top level (did you mean \"fps\"?)\n"
        "scene.toml:3:7: error: \"fov\" in [camera] is 0, allowed: 0.01 to 179 [degrees]\n"
        "scene.toml:5:1: error: unknown key \"sampels\" in [render] (did you mean "
        "\"samples\"?)");
}

TEST(SceneErrors, ManyAreCounted)
{
    std::string text;
    for (int i = 0; i < 30; ++i) text.append("key").append(std::to_string(i)).append(" = 1\n");
    const std::string message = problems_of(text);
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 20);
    EXPECT_NE(message.find("\nscene.toml: 10 more errors"), std::string::npos);
}

TEST(SceneErrors, JsonHasPositionsToo)
{
    const Case cases[] = {
        {"{\n  \"camera\": {\n    \"fov\": \"a\\\"b\", \"up\": [0, 1]\n  }\n}",
         "scene.json:3:12: error: \"fov\" in [camera] must be a number, not text\n"
         "scene.json:3:26: error: \"up\" in [camera] must be a list of 3 numbers, not of 2"},
        {"{\"name\": \"\xc3\xa4\", \"fsp\": -1.5e3 , \"render\" :\t{\"samples\": 0}}",
         "scene.json:1:15: error: unknown key \"fsp\" at the top level (did you mean \"fps\"?)\n"
         "scene.json:1:54: error: \"samples\" in [render] is 0, allowed: 1 to 1e7"},
        {"{\"fps\": 24,\n \"fps\": 25}",
         "scene.json:2:2: error: key \"fps\" at the top level is given twice"},
        {"{\"fps\": null}",
         "scene.json:1:9: error: \"fps\" at the top level must be a number, not null"},
        {"[]", "scene.json:1:1: error: a scene is a table, not a list"},
        {"{\n\"fps\" 24}",
         "scene.json:2:8: error: syntax error while parsing object separator - unexpected number "
         "literal; expected ':'"},
    };
    for (const Case& c : cases)
        EXPECT_EQ(problems_of(c.text, {}, "scene.json"), c.message) << c.text;
}

TEST(SceneErrors, OfOverridesNameTheOverride)
{
    const std::string text = "[[volumes]]\nname = \"smoke\"\nprocedural = \"puff\"\n";
    const Case cases[] = {
        {"camera.fvo=30",
         "--set camera.fvo=30: error: unknown key \"fvo\" in [camera] (did you mean \"fov\"?)"},
        {"volumes.smok.albedo=1",
         "--set volumes.smok.albedo=1: error: no entry of [[volumes]] is named \"smok\" (did you "
         "mean \"smoke\"?)"},
        {"volumes.3.albedo=1",
         "--set volumes.3.albedo=1: error: \"volumes\" has 1 entries, counted from 0"},
        {"volumes.smoke.albedo=2",
         "--set volumes.smoke.albedo=2: error: \"albedo\" in [volumes] is 2, allowed: 0 to 1"},
        {"volumes.smoke.name.x=2",
         "--set volumes.smoke.name.x=2: error: \"volumes.smoke.name\" is text, it has no \"x\""},
        {"render.samples=many",
         "--set render.samples=many: error: \"samples\" in [render] must be a whole number, not "
         "text"},
        {"camera", "--set camera: error: must look like key.key=value"},
        {"camera..fov=3", "--set camera..fov=3: error: must look like key.key=value"},
    };
    for (const Case& c : cases) EXPECT_EQ(problems_of(text, {c.text}), c.message) << c.text;
    EXPECT_NE(
        problems_of(text, {"camera.up=[1, 2"}).find("--set camera.up=[1, 2: error: value is not"),
        std::string::npos);
}

TEST(SceneErrors, FilesThatCannotBeRead)
{
    try {
        (void)load_scene("/nonexistent/scene.toml");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Input);
        EXPECT_STREQ(error.what(),
                     "/nonexistent/scene.toml: cannot read the scene file; does it exist?");
    }
    try {
        (void)load_scene("/tmp");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "/tmp: is a folder, not a scene file");
    }
    try {
        (void)load_scene("smoke.0001.vdb");
        FAIL();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(),
                     "smoke.0001.vdb: not a scene; scenes are .toml or .json files that name such "
                     "files, see scenes/README.md");
    }
    EXPECT_EQ(problems_of(std::string(4'000'001, '#')),
              "scene.toml: larger than 4.0 MB, so not a scene file");
}

}  // namespace
}  // namespace mote
