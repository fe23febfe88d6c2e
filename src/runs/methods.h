#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scene/description.h"
#include "scene/scene.h"

namespace mote {

/// What decides which methods are worth measuring on a scene.
struct SceneTraits {
    bool several_lights = false;   ///< a choice of light is to be made
    bool local_lights = false;     ///< lights at a finite distance
    bool infinite_lights = false;  ///< distant lights or an environment
    bool surfaces = false;
    bool glowing_media = false;
    int light_count = 0;  ///< the environment apart

    /// Whether restir has reservoirs at all: lights at infinity have closed forms in smoke.
    [[nodiscard]] bool has_reservoirs() const { return local_lights || surfaces || glowing_media; }
};

[[nodiscard]] SceneTraits traits_of(const Scene& scene);

/// One row of the benchmark: a way to render a scene.
struct Method {
    std::string name;        ///< on the command line and in the results
    std::string doc;         ///< one line
    bool is_reference;       ///< row of the reference path tracer, by whose best others are judged
    bool is_biased = false;  ///< known to be: its error has a floor
    bool keeps_history;      ///< frames before the one measured change it: warm-up is rendered
    int samples_per_frame;   ///< 0: as many as take the time of the other rows
    std::function<void(RenderDescription&)> edit;           ///< applied to the scene's settings
    std::function<bool(const SceneTraits&)> is_worthwhile;  ///< measured by default?
};

/// All methods, in the order of the table.
[[nodiscard]] std::span<const Method> all_methods();

/// The methods named in a list by comma; "path*" stands for all that begin so. An empty list: those
/// worthwhile in such a scene. Throws Error(Usage) for a name that no method has.
[[nodiscard]] std::vector<Method> choose_methods(const std::string& list,
                                                 const SceneTraits& traits);

/// The method of this name; throws Error(Usage) as above.
[[nodiscard]] const Method& find_method(const std::string& name);

}  // namespace mote
