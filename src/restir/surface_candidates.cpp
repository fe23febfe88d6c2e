#include <algorithm>
#include <cmath>

#include "restir/direction_hits.h"
#include "restir/surface_domain.h"
#include "scene/environment.h"
#include "surfaces/bsdf.h"

namespace mote {
namespace {

/// Candidates per lamp where there are few of them.
constexpr int candidates_per_lamp = 4;
/// Next to surfaces the caches are at their worst: nodes behind a wall see nothing. What they think
/// dark must not become rare and bright.
constexpr float least_known = 0.25f;

/// Steps of a lattice that fills the square of the first two numbers evenly however many are taken
/// (powers of 1/1.3247, after Roberts 2018, "The Unreasonable Effectiveness of Quasirandom
/// Sequences"), and by golden ratio the third.
const Vec3 lattice_step(0.75487767f, 0.56984029f, 0.61803399f);

/// How many candidates of each kind a surface draws.
struct Counts {
    int local = 0;
    int environment = 0;
    int bsdf = 0;
};

Counts counts_for(const FrameDomain& frame)
{
    const SurfaceRestirParams& params = frame.params.surface;
    Counts n;
    const auto lamps =
        static_cast<int>(std::min<size_t>(frame.caches->local_lights.size(), size_t{1} << 20));
    if (frame.samples_local)
        n.local = std::min(params.light_candidates, candidates_per_lamp * lamps);
    if (frame.bsdf_finds.any()) n.bsdf = params.bsdf_candidates;
    // A constant environment is found by the BSDF's directions alone.
    const auto& environment = frame.scene->environment;
    if (!environment) return n;
    if (frame.bsdf_finds.environment) n.bsdf = std::max(n.bsdf, environment_rays_of(frame.params));
    if (environment->map) n.environment = std::max(1, environment_rays_of(frame.params) / 2);
    return n;
}

/// Asks memory for what sampling a light takes.
void prefetch_light(const FrameDomain& frame, int light)
{
    const auto i = static_cast<size_t>(light);
    __builtin_prefetch(frame.lights.data() + i);
    if (i >= frame.scene->lights.size()) return;  // a volume that glows
    const auto* lamp = reinterpret_cast<const char*>(frame.scene->lights.data() + i);
    __builtin_prefetch(lamp);
    __builtin_prefetch(lamp + sizeof(Light) - 1);
}

/// Draws a surface's candidates, one kind after the other.
struct Drawing {
    const FrameDomain& frame;
    const SurfaceDomain& domain;
    Counts n;
    Rng& rng;
    std::vector<Candidate>& out;

    /// `by_light`: expected number of candidates there by the lights' own sampling, per unit of the
    /// sample's measure.
    void add(const PathSample& y, float by_light) const
    {
        const std::optional<Arrival> arrival = light_at(frame, y, domain.v.p, domain.time);
        if (!arrival) return;
        Candidate c;
        c.y = y;
        const float pdf_dir = light_surface(domain, *arrival, c);
        if (!(max_component(c.f) > 0.0f)) return;
        c.density = by_light;
        if (n.bsdf > 0 && pdf_dir > 0.0f) {
            c.density += static_cast<float>(n.bsdf) * pdf_dir *
                         density_per_direction(frame, frame.bsdf_finds, domain.v.p, domain.time, y,
                                               *arrival);
        }
        c.known = std::max(least_known, cached_visibility(frame, y, c.x, c.arrival));
        if (c.density > 0.0f) out.push_back(c);
    }

    /// By one of the lights' own sampling, which is tried `count` times and chooses it with `pmf`.
    void add_point(int light, int count, float pmf) const
    {
        const auto point =
            sample_light_point(frame, frame.lights[static_cast<size_t>(light)], domain.time, rng);
        if (!point || !(point->density > 0.0f)) return;
        add({0.0f, light, point->v}, static_cast<float>(count) * pmf * point->density);
    }

    void local() const
    {
        if (n.local == 0) return;
        const double u_light = uniform_double(rng);
        double u[256];  // as many as params.surface.light_candidates may be
        LightPick picks[256];
        const auto count = static_cast<size_t>(n.local);
        for (int i = 0; i < n.local; ++i) {
            u[i] = u_light + 0.6180339887498949 * i;  // golden-ratio steps, as in the volume
            u[i] -= std::floor(u[i]);
        }
        frame.caches->cells->sample(domain.v.p, {u, count}, {picks, count});
        // Among many lights each is a wait for memory: all of them at once.
        for (size_t i = 0; i < count; ++i) prefetch_light(frame, picks[i].light);
        for (size_t i = 0; i < count; ++i) {
            const LightPick& pick = picks[i];
            add_point(pick.light, n.local, pick.pmf);
        }
    }

    void infinite() const
    {
        for (const int light : frame.at_infinity) {
            const SampledLight& sampled = frame.lights[static_cast<size_t>(light)];
            const bool is_distant = sampled.kind == SampledLightKind::Distant;
            const int count = is_distant ? 1 : n.environment;
            for (int k = 0; k < count; ++k) add_point(light, count, 1.0f);
        }
    }

    [[nodiscard]] float own_density(const DirectionHit& hit) const
    {
        if (frame.lights[static_cast<size_t>(hit.light)].kind == SampledLightKind::Environment) {
            return static_cast<float>(n.environment) * hit.light_density;
        }
        if (n.local == 0) return 0.0f;
        const float pmf = frame.caches->cells->pmf(hit.light, domain.v.p);
        return static_cast<float>(n.local) * pmf * hit.light_density;
    }

    void directions() const
    {
        const Vec3 base = n.bsdf > 0 ? rng.uniform3() : Vec3(0.0f);
        for (int i = 0; i < n.bsdf; ++i) {
            // A shifted lattice spreads directions evenly; each alone is as good as random.
            const Vec3 shifted = base + static_cast<float>(i) * lattice_step;
            const auto sample = sample_bsdf(domain.v, domain.wo, shifted - glm::floor(shifted));
            const float u = rng.uniform();
            if (!sample) continue;
            const Ray ray{ray_origin(domain.v, sample->wi), sample->wi, domain.time};
            for_each_light_along(frame, frame.bsdf_finds, ray, u, [&](const DirectionHit& hit) {
                add({0.0f, hit.light, hit.v}, own_density(hit));
            });
        }
    }
};

}  // namespace

void draw_surface_candidates(const FrameDomain& frame, const SurfaceDomain& domain, Rng& rng,
                             std::vector<Candidate>& out)
{
    const Drawing draw{frame, domain, counts_for(frame), rng, out};
    draw.local();
    draw.infinite();
    draw.directions();
}

}  // namespace mote
