#include <gtest/gtest.h>

#include "core/rng.h"
#include "support/scene_files.h"

namespace mote {
namespace {

/// Either a scene or an Input error that names the file; anything else fails the test or crashes.
void expect_survives(const std::string& name, const std::string& content)
{
    const TemporaryFolder folder;
    try {
        (void)load_scene(folder.write(name, content));
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Input);
        EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
        EXPECT_LT(std::string(error.what()).size(), 20'000u);
    }
}

/// before + text text text ... + after
std::string repeat(const char* before, std::string_view text, size_t count, const char* after = "")
{
    std::string out(before);
    for (size_t i = 0; i < count; ++i) out.append(text);
    return out.append(after);
}

TEST(SceneHostile, DeepNestingIsRefused)
{
    expect_survives("a.toml", repeat("a = ", "[", 100'000));
    expect_survives("a.toml", repeat("a = ", "[", 200, "1"));
    expect_survives("a.toml", repeat("a = ", "{a=", 100'000));
    expect_survives("a.toml", repeat("[", "a.", 1'000'000, "a]"));
    expect_survives("a.toml", repeat("", "a . ", 500'000, "a = 1"));
    expect_survives("a.toml", repeat("b = {", "\"x\".", 500'000, "a = 1}"));
    expect_survives("a.json", repeat("", "[", 1'000'000));
    expect_survives("a.json", repeat("", "{\"a\":", 500'000));
    EXPECT_EQ(test::problems_of(repeat("\n", "a.", 100, "a = 1")),
              "scene.toml:2:1: error: key of too many parts");
    EXPECT_EQ(test::problems_of(repeat("", "[", 100), {}, "scene.json"),
              "scene.json:1:33: error: nested too deeply");
}

TEST(SceneHostile, LongListsAreBounded)
{
    expect_survives("a.toml", repeat("", "[[volumes]]\n", 300'000));
    expect_survives("a.toml", repeat("[camera]\nkeys = [", "{},", 1'000'000, "]"));
    expect_survives("a.json", repeat("{\"lights\":[", "{},", 1'000'000, "{}]}"));
    expect_survives("a.json", repeat("{\"lights\":[", "[],", 90'000, "[]]}"));
    std::string keys = "{";
    for (int i = 0; i < 100'000; ++i) keys.append("\"k").append(std::to_string(i)).append("\":1,");
    expect_survives("a.json", keys.append("\"z\":1}"));
}

TEST(SceneHostile, OddBytesAreRefused)
{
    expect_survives("a.toml", std::string("fps = 24\0\n", 10));
    expect_survives("a.toml", "name = \"\xff\xfe\"");
    expect_survives("a.toml", "name = \"\xed\xa0\x80\"");
    expect_survives("a.json", std::string("{\"fps\": 24\0}", 12));
    expect_survives("a.json", "{\"name\": \"\xff\xfe\"}");
    expect_survives("a.json", "\xef\xbb\xbf{\"fps\": 1e999}");
    expect_survives("a.toml", "fps = 99999999999999999999999");
    expect_survives("a.json", "{\"render\": {\"samples\": 18446744073709551615}}");
    expect_survives("a.json", "");
    expect_survives("a.toml", "");
    expect_survives("a.toml", repeat("", "x", 4'000'000));
    expect_survives("a.toml", repeat("\"", "y", 3'000'000, "\" = 1"));
    EXPECT_NE(test::problems_of("\"a\\nb\\u001b\" = 1").find("unknown key \"a?b?\""),
              std::string::npos);
}

TEST(SceneHostile, MutatedScenesNeverCrash)
{
    const std::string toml = R"(fps = 24
[camera]
position = [0, 1, 6]
keys = [{ frame = 1, fov = 30 }, { frame = 10, position = [0, 0, 9] }]
[render]
samples = 16
path = { transmittance = "ratio" }
[[volumes]]
name = "smoke"
particles = "plume"
phase = { g = 0.3 }
transform = { translate = [0, 1, 0], scale = 2 }
[[particles]]
name = "plume"
emitter = "plume"
count = 1000
[[lights]]
type = "sphere"
radius = 0.5
)";
    const std::string json =
        "{\"fps\": 24, \"camera\": {\"position\": [0, 1, 6]}, \"volumes\": [{\"name\": \"s\","
        "\"procedural\": {\"type\": \"puff\", \"size\": 2.5e0}}], \"lights\": [{\"type\": "
        "\"quad\", "
        "\"edge_u\": [1, 2, 3], \"two_sided\": true}], \"name\": \"\\u00e4\"}";
    const std::string tokens[] = {"1e38", "-1",   "nan",   "\"",  "'''", "[",     "]]",
                                  "{",    "}",    "\\u",   "\\",  "0x",  "\n",    "=",
                                  ".",    "\xf0", "1e400", "inf", "#",   "false", "99999999999"};
    for (uint32_t i = 0; i < 300; ++i) {
        Rng rng(7, 0, Stream::Test, i, 0);
        const bool is_json = i % 2 == 1;
        std::string text = is_json ? json : toml;
        const int edits = 1 + static_cast<int>(rng.next() % 4);
        for (int e = 0; e < edits && !text.empty(); ++e) {
            const size_t at = rng.next() % text.size();
            const size_t length = 1 + rng.next() % 12;
            switch (rng.next() % 5) {
                case 0:
                    text[at] = static_cast<char>(rng.next() & 0xffu);
                    break;
                case 1:
                    text.erase(at, length);
                    break;
                case 2:
                    text.insert(at, tokens[rng.next() % std::size(tokens)]);
                    break;
                case 3:
                    text.insert(at, text.substr(rng.next() % text.size(), length * 4));
                    break;
                default:
                    text.resize(at);
                    break;
            }
        }
        expect_survives(is_json ? "m.json" : "m.toml", text);
    }
}

}  // namespace
}  // namespace mote
