#include "app/verify_options.h"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "app/shared_options.h"
#include "core/error.h"
#include "core/text.h"

namespace mote {

namespace {

/// "1%" or "0.01", between 0 and 1.
void bind_share(CLI::App& app, const char* name, double& share, const char* help)
{
    app.add_option_function<std::string>(
           name,
           [&share, name](const std::string& text) {
               char* end = nullptr;
               double value = std::strtod(text.c_str(), &end);
               const bool is_percent = std::string(end) == "%";
               if (is_percent) value /= 100.0;
               const bool is_number = end != text.c_str() && (is_percent || *end == '\0');
               if (!is_number || !(value > 0.0 && value < 1.0)) {
                   throw CLI::ValidationError(
                       name, fmt::format("\"{}\" is not a share between 0 and 1, e.g. 1% or 0.01",
                                         printable(text)));
               }
               share = value;
           },
           fmt::format("{} Default: {:g}%", help, 100.0 * share))
        ->type_name("SHARE");
}

void bind_tested(CLI::App& app, VerifyOptions& o)
{
    app.add_option("scene", o.scene, "Scene file, .toml or .json")->required()->type_name("SCENE");
    app.add_option("--method", o.method,
                   "What to test, of `mote bench --list`. Default: restir with the scene's own "
                   "settings")
        ->type_name("METHOD");
    app.add_option("--reference", o.reference,
                   "What to test it by. Default: the path tracer that suits the lights")
        ->type_name("METHOD");
    app.add_option(
           "--passes", o.passes,
           "Samples per pixel and frame of what is tested. Default: 1, or more where frames do "
           "not depend on those before")
        ->check(CLI::Range(1, 1'000'000))
        ->type_name("N");
    app.add_option("--frame", o.frame,
                   "The frame compared. Default: the scene's first after the warm-up")
        ->check(CLI::Range(-1'000'000, 1'000'000))
        ->type_name("N");
    app.add_option("--warm-up", o.warm_up,
                   "Frames before it, from empty history. Default: 8; of what moves 4, or what the "
                   "animation has")
        ->check(CLI::Range(0, 1000))
        ->type_name("N");
    bind_resolution(app, o.resolution);
    app.add_flag("--full-size", o.full_size,
                 "Keep the scene's size. Default: lowered to 5,000 pixels, where more runs fit");
    bind_overrides(app, o.overrides);
}

void bind_question(CLI::App& app, VerifyOptions& o)
{
    bind_share(app, "--budget", o.question.budget,
               "Bias of the whole image worth finding, over the picture's mean.");
    bind_share(app, "--tile-budget", o.question.tile_budget, "The same in a typical tile.");
    bind_share(app, "--alpha", o.question.alpha,
               "Chance of finding bias where there is none, of all looks together.");
    bind_share(app, "--power", o.question.power,
               "Chance that a bias of the budget is found, for \"no bias found\".");
    app.add_flag("--equivalence", o.question.equivalence,
                 "Ask whether the bias is under the budget, not whether there is any. Settings "
                 "known to be biased are always asked this");
    app.add_option("--tile", o.tile_size, "Edge of the tiles [pixels]")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--runs", o.runs, "Most runs of each estimator")
        ->check(CLI::Range(2, 1'000'000))
        ->capture_default_str()
        ->type_name("K");
    app.add_option("--time", o.time, "Time for all [s]")
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str()
        ->type_name("S");
}

}  // namespace

void bind_verify(CLI::App& app, VerifyOptions& o)
{
    bind_tested(app, o);
    bind_question(app, o);
    app.add_flag("!--no-sequences", o.sequences, "Do not measure what changes from frame to frame");
    app.add_option("--seed", o.seed, "Seed of the first run")
        ->check(CLI::Range(0, 1'000'000'000))
        ->capture_default_str()
        ->type_name("N");
    app.add_option("--threads", o.threads,
                   "Threads. Default: those this process may use (affinity, SLURM_CPUS_PER_TASK)")
        ->check(CLI::Range(1, 1024))
        ->type_name("N");
    app.add_option("--json", o.json, "Write all figures to this file")->type_name("FILE");
    app.add_option("--html", o.html, "Write a page with figures, pictures and plots")
        ->type_name("FILE");
    bind_log(app, o.log);
    app.footer(
        "Returns 0 if no bias was found where one of the budget would have been, 10 if bias was\n"
        "found, 11 if the runs are too few to say.\n"
        "Examples:\n"
        "  mote verify scenes/puff_sky.toml --html puff_sky.html\n"
        "  mote verify my_scene.toml --method restir-both --warm-up 20 --time 3600\n"
        "  mote verify my_scene.toml --set render.restir.preset=preview --budget 5%\n");
}

VerifyParams verify_params(const VerifyOptions& options)
{
    VerifyParams params;
    params.method = options.method;
    params.reference = options.reference;
    params.frame = options.frame;
    params.warm_up = options.warm_up;
    params.passes = options.passes;
    params.temporal = options.sequences;
    params.study.question = options.question;
    params.study.tile_size = options.tile_size;
    params.study.most_runs = options.runs;
    params.study.seconds = options.time;
    params.study.seed = static_cast<uint32_t>(options.seed);
    if (options.question.power <= options.question.alpha) {
        throw Error(ExitCode::Usage, "--power must be over --alpha: a test finds that much anyway");
    }
    return params;
}

}  // namespace mote
