#pragma once

#include "app/options.h"
#include "bench/bench_scene.h"

namespace CLI {
class App;
}

namespace mote {

/// The options of `mote bench`.
void bind_bench(CLI::App& app, BenchOptions& options);

/// What they ask for. Throws Error(Usage) for frames that are not "WARM-UP+STILL".
[[nodiscard]] BenchParams bench_params(const BenchOptions& options);

}  // namespace mote
