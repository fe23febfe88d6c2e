#include "app/shared_options.h"

#include <cstdio>

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "core/text.h"

namespace mote {

void bind_log(CLI::App& app, LogOptions& log)
{
    app.add_flag("-q,--quiet", log.quiet, "Errors only, no progress");
    app.add_flag("-v,--verbose", log.verbosity, "Say what is done; -vv says more");
    app.add_option("--log-file", log.file, "Write the log to this file as well")->type_name("FILE");
}

void bind_overrides(CLI::App& app, std::vector<std::string>& overrides)
{
    app.add_option("--set", overrides,
                   "Override a scene value, e.g. volumes.smoke.density_scale=4; repeatable")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
}

void bind_resolution(CLI::App& app, std::vector<std::string>& overrides)
{
    app.add_option_function<std::string>(
           "--resolution",
           [&overrides](const std::string& text) {
               int width = 0;
               int height = 0;
               int used = 0;
               if (std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) != 2 ||
                   static_cast<size_t>(used) != text.size()) {
                   throw CLI::ValidationError(
                       "--resolution",
                       fmt::format("\"{}\" is not WIDTHxHEIGHT, e.g. 1920x1080", printable(text)));
               }
               overrides.push_back(fmt::format("render.width={}", width));
               overrides.push_back(fmt::format("render.height={}", height));
           },
           "Image size in pixels, e.g. 1920x1080")
        ->type_name("WxH");
}

}  // namespace mote
