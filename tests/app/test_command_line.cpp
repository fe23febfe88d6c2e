#include <algorithm>

#include <gtest/gtest.h>

#include "app/command_line.h"
#include "app/exit_codes.h"
#include "core/error.h"
#include "volumes/walk_isa.h"

namespace mote {

namespace {

using Arguments = std::vector<std::string>;

template <class Options>
Options parse(const Arguments& arguments)
{
    return std::get<Options>(parse_command_line(arguments));
}

std::string refusal(const Arguments& arguments)
{
    try {
        (void)parse_command_line(arguments);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        return error.what();
    }
    return "accepted";
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST(CommandLine, HelpShowsEveryCommandAndTheTableOfExitCodes)
{
    for (const Arguments& arguments : {Arguments{}, Arguments{"--help"}, Arguments{"-h"}}) {
        const std::string help = parse<PrintText>(arguments).text;
        for (const char* word : {"render", "check", "info", "cache", "sheet", "schema", "verify"}) {
            EXPECT_TRUE(contains(help, word)) << word;
        }
        EXPECT_TRUE(contains(help, exit_code_table()));
    }
    EXPECT_TRUE(contains(parse<PrintText>({"render", "--help"}).text, "--existing"));
    EXPECT_TRUE(contains(parse<PrintText>({"--version"}).text, "mote "));
}

TEST(CommandLine, IsaIsAnOptionOfTheProgram)
{
    const Isa best = walk_isa();
    (void)parse<VersionOptions>({"--isa", "scalar", "version"});
    EXPECT_EQ(walk_isa(), Isa::Scalar);
    EXPECT_TRUE(parse<RenderOptions>({"render", "a.toml", "--isa", "auto", "--dry-run"}).dry_run);
    EXPECT_EQ(walk_isa(), best);
    EXPECT_TRUE(contains(refusal({"--isa", "sse", "version"}), "auto|avx2|avx512|scalar"));
    if (!is_supported(Isa::Avx512)) {
        EXPECT_TRUE(contains(refusal({"--isa", "avx512", "version"}), "has no avx512"));
    }
}

TEST(CommandLine, ReadsARender)
{
    const auto o = parse<RenderOptions>(
        {"render",        "--frames",       "-3-4",     "--set",        "a.b=1",   "scene.toml",
         "--set=c=[1,2]", "--samples",      "4",        "--resolution", "320x180", "--existing",
         "verify",        "--memory-limit", "2GB",      "--threads",    "3",       "-vv",
         "--aovs",        "none",           "--dry-run"});
    EXPECT_EQ(o.scene, "scene.toml");
    EXPECT_EQ(o.frames, "-3-4");
    EXPECT_EQ(o.existing, ExistingMode::Verify);
    EXPECT_EQ(o.threads, 3);
    EXPECT_EQ(o.log.verbosity, 2);
    EXPECT_EQ(o.aovs, "none");
    EXPECT_TRUE(o.dry_run);
    EXPECT_FALSE(o.reproducible);
    EXPECT_DOUBLE_EQ(o.memory_limit, 2.0 * 1024 * 1024 * 1024);
    Arguments overrides = o.overrides;
    std::sort(overrides.begin(), overrides.end());
    EXPECT_EQ(overrides, (Arguments{"a.b=1", "c=[1,2]", "render.height=180", "render.samples=4",
                                    "render.width=320"}));
}

TEST(CommandLine, JsonProgressMakesTheWholeLogJson)
{
    EXPECT_TRUE(parse<RenderOptions>({"render", "s.toml", "--progress", "json"}).log.json);
    EXPECT_FALSE(parse<RenderOptions>({"render", "s.toml"}).log.json);
}

TEST(CommandLine, ReadsTheOtherCommands)
{
    EXPECT_EQ(parse<CheckOptions>({"check", "s.toml"}).scene, "s.toml");
    EXPECT_EQ(parse<InfoOptions>({"info", "a.vdb", "--frame", "-2"}).frame, -2);
    const auto cache = parse<CacheOptions>({"cache", "in.####.ply", "--frames", "1-3", "--grids",
                                            "d.####.vdb", "--voxel-size", "0.5"});
    EXPECT_EQ(cache.input, "in.####.ply");
    EXPECT_FLOAT_EQ(cache.voxel_size.value(), 0.5f);
    const auto sheet = parse<SheetOptions>({"sheet", "o.png", "a.png", "b.png", "--columns", "2"});
    EXPECT_EQ(sheet.inputs, (Arguments{"a.png", "b.png"}));
    EXPECT_EQ(sheet.columns, 2);
    EXPECT_TRUE(parse<SchemaOptions>({"schema", "--markdown"}).markdown);
    (void)parse<VersionOptions>({"version"});
}

TEST(CommandLine, NamesTheNearestKnownWord)
{
    EXPECT_TRUE(contains(refusal({"rendr", "s.toml"}), "did you mean \"render\""));
    EXPECT_TRUE(contains(refusal({"render", "s.toml", "--frmaes", "1"}),
                         "unknown option --frmaes (did you mean \"--frames\"?)"));
    EXPECT_TRUE(contains(refusal({"render", "s.toml", "--frmaes=1"}), "--frames"));
    EXPECT_TRUE(contains(refusal({"render", "--sampels", "2"}), "--samples"));
    EXPECT_TRUE(contains(refusal({"xyzzy"}), "the commands are render"));
}

TEST(CommandLine, RefusesWithAPointerToTheHelp)
{
    EXPECT_TRUE(contains(refusal({"render"}), "Try: mote render --help"));
    EXPECT_TRUE(contains(refusal({"-v"}), "Try: mote --help"));
    EXPECT_TRUE(contains(refusal({"render", "a.toml", "b.toml"}), "unexpected argument b.toml"));
    EXPECT_TRUE(contains(refusal({"render", "a.toml", "--existing", "maybe"}),
                         "\"maybe\" is not one of overwrite|skip|verify"));
    EXPECT_TRUE(contains(refusal({"render", "a.toml", "--resolution", "3x"}), "1920x1080"));
    EXPECT_TRUE(contains(refusal({"render", "a.toml", "--threads", "0"}), "--threads"));
    EXPECT_TRUE(contains(refusal({"render", "a.toml", "--memory-limit", "big"}), "memory-limit"));
}

}  // namespace mote
