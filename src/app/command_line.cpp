#include "app/command_line.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/bench_options.h"
#include "app/compare_threshold.h"
#include "app/exit_codes.h"
#include "app/shared_options.h"
#include "app/verify_options.h"
#include "core/error.h"
#include "core/text.h"
#include "volumes/walk_isa.h"

namespace mote {

namespace {

constexpr const char* frames_help =
    "Frames: a, a-b, a-bxN, lists by comma or blank, negatives. Default: the scene's range";
constexpr const char* pattern_help = "#### , %04d , $F4 or {frame:04} stand for the frame";

const std::map<std::string, ExistingMode> existing_modes{{"overwrite", ExistingMode::Overwrite},
                                                         {"skip", ExistingMode::Skip},
                                                         {"verify", ExistingMode::Verify}};
const std::map<std::string, ExistingMode> cache_existing_modes{
    {"overwrite", ExistingMode::Overwrite}, {"skip", ExistingMode::Skip}};
const std::map<std::string, ProgressMode> progress_modes{
    {"auto", ProgressMode::Auto}, {"json", ProgressMode::Json}, {"none", ProgressMode::None}};
const std::map<std::string, std::optional<Isa>> isas{
    {"auto", std::nullopt}, {"scalar", Isa::Scalar}, {"avx2", Isa::Avx2}, {"avx512", Isa::Avx512}};

/// An option whose value is one of a few words.
template <class T>
CLI::Option* add_choice(CLI::App& app, const std::string& name, T& value,
                        const std::map<std::string, T>& choices, const std::string& help)
{
    std::string words;
    for (const auto& [word, meaning] : choices) words += (words.empty() ? "" : "|") + word;
    return app
        .add_option_function<std::string>(
            name,
            [&value, &choices, name, words](const std::string& text) {
                const auto choice = choices.find(text);
                if (choice == choices.end()) {
                    throw CLI::ValidationError(
                        name, fmt::format("\"{}\" is not one of {}", printable(text), words));
                }
                value = choice->second;
            },
            help)
        ->type_name(words);
}

/// `option VALUE` as a shorthand for `--set key=VALUE`, so that both check and record alike.
void bind_shorthand(CLI::App& app, std::vector<std::string>& overrides, const std::string& option,
                    const std::string& key, const std::string& type, const std::string& help)
{
    app.add_option_function<std::string>(
           option,
           [&overrides, key](const std::string& value) { overrides.push_back(key + "=" + value); },
           help)
        ->type_name(type);
}

void bind_render(CLI::App& app, RenderOptions& o, std::vector<std::string>& shorthands)
{
    app.add_option("scene", o.scene, "Scene file, .toml or .json")->required()->type_name("SCENE");
    app.add_option("--frames", o.frames, frames_help)->type_name("LIST");
    app.add_option("--output", o.output, std::string("OpenEXR files; ") + pattern_help)
        ->type_name("PATTERN");
    app.add_option("--preview", o.preview, "PNG previews; tokens as for --output")
        ->type_name("PATTERN");
    add_choice(app, "--existing", o.existing, existing_modes,
               "Files already there: overwrite them (the default), skip complete ones, or verify: "
               "skip those complete, of the same scene, size, layers and input files (path, "
               "size and modification time)");
    app.add_option("--aovs", o.aovs,
                   "Layers beside RGBA, by comma; none for none. Default: the scene's")
        ->type_name("LIST");
    bind_shorthand(app, shorthands, "--samples", "render.samples", "N", "Samples per pixel");
    bind_shorthand(app, shorthands, "--seed", "render.seed", "N", "Seed of the random numbers");
    bind_resolution(app, shorthands);
    bind_overrides(app, o.overrides);
    app.add_option("--warmup", o.warmup,
                   "Frames rendered before the first one, and not written, so that reuse over time "
                   "starts with a history. None before the scene's first frame; 0 (the default): "
                   "the first frame is as noisy as one without history")
        ->check(CLI::Range(0, 1000))
        ->type_name("N");
    app.add_option("--threads", o.threads,
                   "Threads. Default: those this process may use (affinity, SLURM_CPUS_PER_TASK)")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    app.add_option("--memory-limit", o.memory_limit,
                   "Fail (exit code 5) rather than use more memory than this, e.g. 8GB")
        ->transform(CLI::AsSizeValue(false))
        ->type_name("SIZE");
    add_choice(app, "--progress", o.progress, progress_modes,
               "auto: a bar on a terminal, log lines otherwise; json: one object per line");
    app.add_option("--stats", o.stats, "Write times and counts per frame as JSON")
        ->type_name("FILE");
    app.add_flag("--dry-run", o.dry_run, "List frames, files and memory; render nothing");
    app.add_flag("--reproducible", o.reproducible, "Leave dates and times out of the files");
    bind_log(app, o.log);
    app.footer(
        "Examples:\n"
        "  mote render scenes/demo.toml --frames 1-48 --output 'out/demo.####.exr'\n"
        "  mote render smoke.toml --frames 1-100x10 --samples 4 --preview 'look.####.png'\n"
        "  mote render smoke.toml --set camera.fov=30 --existing verify --stats out/stats.json\n");
}

void bind_check(CLI::App& app, CheckOptions& o)
{
    app.add_option("scene", o.scene, "Scene file, .toml or .json")->required()->type_name("SCENE");
    app.add_option("--frames", o.frames,
                   "Frames whose input files must exist. Default: the scene's range")
        ->type_name("LIST");
    bind_overrides(app, o.overrides);
    bind_log(app, o.log);
    app.footer("Returns 0 for a good scene; prints every problem and returns 3 otherwise.\n");
}

void bind_info(CLI::App& app, InfoOptions& o)
{
    app.add_option(
           "file", o.file,
           "Scene, .vdb, particle file (.vdb .ply .csv .npy), mesh (.obj .ply .gltf .glb) or .exr")
        ->required()
        ->type_name("FILE");
    app.add_option("--frame", o.frame, "Frame of a scene or of a file pattern")->type_name("N");
    app.add_option("--fps", o.fps, "Frames per second, for displacements of plain files")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    bind_overrides(app, o.overrides);
    bind_log(app, o.log);
}

void bind_cache(CLI::App& app, CacheOptions& o)
{
    app.add_option("input", o.input, "Scene, or particle files (.vdb .ply .csv .npy, ####)")
        ->required()
        ->type_name("SCENE|FILES");
    app.add_option("--particles", o.particles,
                   "Which [[particles]] of the scene. Default: the only one")
        ->type_name("NAME");
    app.add_option("--frames", o.frames, frames_help)->type_name("LIST");
    app.add_option("--points", o.points, std::string("VDB point files; ") + pattern_help)
        ->type_name("PATTERN");
    app.add_option("--grids", o.grids, "VDB density grids; tokens as for --points")
        ->type_name("PATTERN");
    app.add_option("--channels", o.channels,
                   "Grids beside density, by comma: velocity, temperature, color")
        ->type_name("LIST");
    app.add_option("--voxel-size", o.voxel_size, "Edge of a voxel [m]. Default: the scene's, 0.02")
        ->check(CLI::Range(1e-6, 1e6))
        ->type_name("M");
    app.add_option("--fps", o.fps, "Frames per second of plain files")
        ->check(CLI::Range(1e-3, 1e6))
        ->capture_default_str();
    app.add_flag("--velocity-per-frame", o.velocity_per_frame,
                 "Velocities of plain files are per frame, not per second");
    app.add_option("--attribute", o.attributes,
                   "Name of an attribute in plain files, e.g. radius=pscale; repeatable")
        ->type_name("MOTE=FILE")
        ->allow_extra_args(false);
    bind_overrides(app, o.overrides);
    add_choice(app, "--existing", o.existing, cache_existing_modes,
               "Files already there: overwrite them (the default), or skip those that open");
    app.add_option("--threads", o.threads, "Threads")->check(CLI::Range(1, 1024))->type_name("N");
    add_choice(app, "--progress", o.progress, progress_modes, "As for mote render");
    bind_log(app, o.log);
    app.footer(
        "Examples:\n"
        "  mote cache scenes/demo.toml --particles plume --frames 1-24 --points 'p.####.vdb'\n"
        "  mote cache 'sim.####.ply' --frames 1-24 --grids 'density.####.vdb' --voxel-size 0.05\n");
}

void bind_sheet(CLI::App& app, SheetOptions& o)
{
    app.add_option("output", o.output, "PNG file to write")->required()->type_name("OUT.png");
    app.add_option("inputs", o.inputs, "PNG files, left to right, top to bottom")
        ->required()
        ->type_name("IN.png");
    app.add_option("--columns", o.columns, "Images per row. Default: near a square")
        ->check(CLI::Range(1, 1000))
        ->type_name("N");
    bind_log(app, o.log);
}

void bind_compare(CLI::App& app, CompareOptions& o)
{
    app.add_option("tested", o.tested, "Image to judge, .exr or .png")->required()->type_name("A");
    app.add_option("reference", o.reference, "Image to judge it by, .exr or .png")
        ->required()
        ->type_name("B");
    std::string names;
    for (const ThresholdMetric& metric : threshold_metrics()) {
        names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", metric.name, metric.meaning);
    }
    app.add_option(
           "--threshold", o.thresholds,
           "Return 10 if a channel is over this, e.g. relmse=0.01; repeatable. Figures: " + names)
        ->type_name("FIGURE=LIMIT")
        ->allow_extra_args(false);
    app.add_option(
           "--layers", o.layers,
           "Layers to compare, by comma, e.g. rgb,alpha,Z,volume. Default: all but variance "
           "and samples; both images must have them")
        ->type_name("LIST");
    app.add_option("--json", o.json, "Write the figures to this file")->type_name("FILE");
    app.add_option("--diff", o.difference,
                   "Write A - B as .exr, or a picture of the first layer's signed relative "
                   "difference as .png")
        ->type_name("FILE");
    bind_log(app, o.log);
    app.footer(
        "Examples:\n"
        "  mote compare new.exr reference.exr --threshold relmse=0.01 --diff diff.png\n"
        "  mote compare new.exr old.exr --layers rgb,volume --json figures.json\n");
}

/// The options of every command while the arguments are read.
struct AllOptions {
    RenderOptions render;
    CheckOptions check;
    InfoOptions info;
    CacheOptions cache;
    SheetOptions sheet;
    CompareOptions compare;
    BenchOptions bench;
    VerifyOptions verify;
    SchemaOptions schema;
    std::optional<Isa> isa;
    std::vector<std::string> shorthands;  ///< overrides that render options stand for
};

void bind_all(CLI::App& app, AllOptions& o)
{
    app.require_subcommand(1);
    app.set_version_flag("--version", "mote " MOTE_VERSION);
    add_choice(app, "--isa", o.isa, isas,
               "Instruction set of the ray walk, the best there is by default; the pictures are "
               "the same to the bit. Also behind a command");
    app.footer(exit_code_table() + "\n`mote COMMAND --help` explains a command.\n");
    bind_render(*app.add_subcommand("render", "Render frames of a scene to OpenEXR and PNG"),
                o.render, o.shorthands);
    bind_check(*app.add_subcommand("check", "Find mistakes in a scene without rendering"), o.check);
    bind_info(*app.add_subcommand("info", "Describe a scene, volume, particle or image file"),
              o.info);
    bind_cache(*app.add_subcommand("cache", "Write particles as VDB points and density grids"),
               o.cache);
    bind_sheet(*app.add_subcommand("sheet", "Put images side by side on one contact sheet"),
               o.sheet);
    bind_compare(*app.add_subcommand("compare", "Measure the error of an image against another"),
                 o.compare);
    bind_bench(*app.add_subcommand("bench", "Measure error against time of several methods"),
               o.bench);
    bind_verify(*app.add_subcommand("verify", "Test whether an estimator is biased on a scene"),
                o.verify);
    app.add_subcommand("schema", "Print the JSON Schema of scene files")
        ->add_flag("--markdown", o.schema.markdown, "Print the tables of scenes/README.md instead");
    app.add_subcommand("version", "Print the version, the build and the libraries");
    for (CLI::App* command : app.get_subcommands({})) command->fallthrough();
}

std::vector<std::string> option_names(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> command_names(const CLI::App& app)
{
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    return names;
}

[[noreturn]] void refuse(const CLI::App& app, const std::string& what)
{
    const auto chosen = app.get_subcommands();
    throw Error(ExitCode::Usage,
                fmt::format("{}\nTry: mote {}--help", what,
                            chosen.empty() ? "" : chosen.front()->get_name() + " "));
}

/// Says what is wrong with the first argument nobody understood.
[[noreturn]] void refuse_unknown(const CLI::App& app, const std::string& argument)
{
    const auto chosen = app.get_subcommands();
    const std::string shown = printable(argument);
    if (argument.substr(0, 1) == "-") {
        const std::string name = argument.substr(0, argument.find('='));
        const auto known = option_names(chosen.empty() ? app : *chosen.front());
        refuse(app, fmt::format("unknown option {}{}", shown, did_you_mean(name, known)));
    }
    if (chosen.empty()) {
        const auto known = command_names(app);
        refuse(app, fmt::format("unknown command {}{}; the commands are {}", shown,
                                did_you_mean(argument, known), fmt::join(known, ", ")));
    }
    refuse(app, fmt::format("unexpected argument {}", shown));
}

/// The first argument that CLI11 left over, in the order given.
std::string first_unknown(const CLI::App& app, const std::vector<std::string>& arguments)
{
    const std::vector<std::string> left = app.remaining(true);
    for (const std::string& argument : arguments) {
        if (std::find(left.begin(), left.end(), argument) != left.end()) return argument;
    }
    return left.empty() ? "" : left.front();
}

CommandLine chosen_command(const CLI::App& app, AllOptions& o)
{
    const std::string name = app.get_subcommands().front()->get_name();
    if (name == "render") {
        // Behind --set: the more specific spelling wins.
        o.render.overrides.insert(o.render.overrides.end(), o.shorthands.begin(),
                                  o.shorthands.end());
        o.render.log.json = o.render.progress == ProgressMode::Json;
        return std::move(o.render);
    }
    if (name == "check") return std::move(o.check);
    if (name == "info") return std::move(o.info);
    if (name == "cache") {
        o.cache.log.json = o.cache.progress == ProgressMode::Json;
        return std::move(o.cache);
    }
    if (name == "sheet") return std::move(o.sheet);
    if (name == "compare") return std::move(o.compare);
    if (name == "bench") return std::move(o.bench);
    if (name == "verify") return std::move(o.verify);
    if (name == "schema") return o.schema;
    return VersionOptions{};
}

}  // namespace

CommandLine parse_command_line(const std::vector<std::string>& arguments)
{
    CLI::App app("mote renders particle volumes: smoke, dust, snow, fire.", "mote");
    AllOptions options;
    bind_all(app, options);
    if (arguments.empty()) return PrintText{app.help()};
    try {
        app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    } catch (const CLI::CallForHelp&) {
        return PrintText{app.help()};
    } catch (const CLI::CallForVersion& version) {
        return PrintText{std::string(version.what()) + "\n"};
    } catch (const CLI::ExtrasError&) {
        refuse_unknown(app, first_unknown(app, arguments));
    } catch (const CLI::RequiredError& error) {
        const std::string unknown = first_unknown(app, arguments);
        if (!unknown.empty()) refuse_unknown(app, unknown);
        refuse(app, printable(error.what()));
    } catch (const CLI::ParseError& error) {
        refuse(app, printable(error.what()));
    }
    set_walk_isa(options.isa);
    return chosen_command(app, options);
}

}  // namespace mote
