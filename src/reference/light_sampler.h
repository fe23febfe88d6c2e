#pragma once

#include <optional>
#include <vector>

#include "core/distribution.h"
#include "core/rng.h"
#include "reference/light_guide.h"
#include "scene/lamp_surfaces.h"
#include "scene/light_tree.h"
#include "scene/path_tracer_params.h"
#include "scene/scene.h"
#include "volumes/emission.h"

namespace mote {

/// What kind of emitter a light choice points to.
enum class LightSource { Lamp, Environment, EmissiveVolume };

/// A volume that gives light, with where it does.
struct EmissiveVolume {
    int volume = -1;  ///< into Media::volumes
    EmissiveBricks bricks;
    float length = 1.0f;  ///< diagonal of its bounds [m]: the scale of distances along rays
};

/// A light chosen for a shadow ray.
struct LightChoice {
    LightSource source = LightSource::Lamp;
    int index = 0;  ///< into Scene::lights or emissive_volumes(); 0 for the environment
    float pmf = 0.0f;
};

/// Chooses lights for shadow rays and finds the lamps that rays meet. Built once per frame; a scene
/// with one light builds no table. Lights without power are never chosen.
class LightSampler {
  public:
    LightSampler() = default;
    LightSampler(const Scene& scene, const PathTracerParams& params);

    /// Chooses a light for point x [world]; empty if there is none to choose.
    /// With a guide (may be null) lamps come from there where a tree would choose them.
    [[nodiscard]] std::optional<LightChoice> choose(Vec3 x, Rng& rng,
                                                    const LightGuide* guide = nullptr) const;

    /// Probability with which `choose` returns this light at x; 0 if it never does.
    [[nodiscard]] float pmf(LightSource source, int index, Vec3 x,
                            const LightGuide* guide = nullptr) const;

    /// Calls f(index) for the lamps that a ray may meet.
    template <class F>
    void for_each_lamp_on_ray(const Ray& ray, F&& f) const
    {
        surfaces_.for_each_on_ray(ray, f);
    }

    /// Whether any lamp has a surface that rays can meet.
    [[nodiscard]] bool has_surfaces() const { return !surfaces_.is_empty(); }
    [[nodiscard]] const std::vector<EmissiveVolume>& emissive_volumes() const
    {
        return emissive_volumes_;
    }
    /// What Auto stands for in this scene.
    [[nodiscard]] LightSamplerKind kind() const { return kind_; }

  private:
    /// One light as far as choosing goes.
    struct Emitter {
        LightSource source = LightSource::Lamp;
        int index = 0;
        float power = 0.0f;    ///< [W]
        float fluence = 0.0f;  ///< of lights at infinity [W/m^2]; 0 for the others
        Bounds3 bounds;        ///< of lights that are not at infinity
    };
    void add_emitters(const Scene& scene, const PathTracerParams& params);
    [[nodiscard]] int find(LightSource source, int index) const;
    /// What a light is expected to bring at x [W/m^2], shadows apart.
    [[nodiscard]] static double importance(const Emitter& emitter, Vec3 x);
    [[nodiscard]] double listed_importance(Vec3 x) const;
    [[nodiscard]] double tree_importance(Vec3 x) const;

    std::vector<Emitter> emitters_;
    std::vector<int> emitter_of_lamp_;
    size_t listed_ = 0;  ///< the first emitters_ are weighed one by one, the rest by the tree
    LightSamplerKind kind_ = LightSamplerKind::PowerDistance;
    AliasTable table_;
    LightTree tree_;  ///< its ids are positions in emitters_
    LampSurfaces surfaces_;
    std::vector<EmissiveVolume> emissive_volumes_;
};

/// Sampler for the scene's lights, environment and emissive volumes.
[[nodiscard]] LightSampler build_light_sampler(const Scene& scene, const PathTracerParams& params);

}  // namespace mote
