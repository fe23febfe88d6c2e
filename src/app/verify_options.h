#pragma once

#include "app/options.h"
#include "study/verify_scene.h"

namespace CLI {
class App;
}

namespace mote {

void bind_verify(CLI::App& app, VerifyOptions& options);

/// What the options ask of a study. Throws Error(Usage) where they do not fit together.
[[nodiscard]] VerifyParams verify_params(const VerifyOptions& options);

}  // namespace mote
