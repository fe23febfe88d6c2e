#pragma once

#include <optional>
#include <vector>

#include "multiscatter/reused_path.h"
#include "reference/trace_context.h"
#include "restir/mixed_phase.h"
#include "restir/pixel_domain.h"
#include "surfaces/surface_vertex.h"

namespace mote {

/// Everything outside the pixel that a path's light depends on; the pass before's is kept as long
/// as its paths are.
struct PathWorld {
    const FrameDomain& frame;
    TraceContext trace;
    uint32_t seed = 1;  ///< of the run

    [[nodiscard]] const Media& media() const { return frame.scene->media; }
};

/// Bins and lost light of a camera ray, as paths' numbers need them: u is the share of the ray's
/// lost light that is lost before the event. Any surface ends the ray.
void make_path_domain(const FrameDomain& frame, const Ray& ray, PixelDomain& domain,
                      BinCounts& counts);

/// A walk up to its second vertex, in a medium or on a surface.
struct SecondVertex {
    Vec3 x1{0.0f};
    Vec3 x2{0.0f};
    Vec3 w1{0.0f};            ///< from x1 to x2 [unit]
    float r = 0.0f;           ///< [m]
    float density = 0.0f;     ///< of w1 [1/sr]
    Spectrum carried{0.0f};   ///< share of the light scattered at x2 that reaches the camera, over
                              ///< the density of (u, w1, r)
    Vec3 wi{0.0f};            ///< where light is looked for at x2 in a medium [unit]
    float density_wi = 0.0f;  ///< [1/sr]
    bool reconnects = false;  ///< see can_reconnect
    std::optional<Collision> collision;
    std::optional<SurfaceVertex> surface;
};

/// Walks from number u on a pixel's ray with the numbers that `key` names; empty where light does
/// not scatter twice.
[[nodiscard]] std::optional<SecondVertex> walk_to_second(const PathWorld& world,
                                                         const PixelDomain& domain, float u,
                                                         const WalkKey& key);

/// Whether paths through two vertices in media keep the second one in other pixels: no lobe is so
/// narrow that it would hardly scatter there, and they are not so close together that directions
/// between them would turn. `depth`: r sigma_t(x2). A function of the path alone, asked on either
/// side of a shift: a path that reconnects on one side and not on the other has no counterpart.
[[nodiscard]] bool can_reconnect(const MixedPhase& first, const MixedPhase& second, float depth);

/// What is found with the random numbers of a path that ends at x2: of ToLight where its shadow ray
/// goes, too. Light that either form could find counts by shares that do not depend on where x2 is
/// seen from, so that E stays what it is in all pixels: as if scattered rays were spread evenly.
/// To `cut` is added what the ray has left when max_bounces cuts it, see PathResult.
void find_light(const PathWorld& world, ReusedPath& path, float& cut);

/// All light that a walk's second vertex scatters towards the first, that it reflects included.
[[nodiscard]] Spectrum light_of_second(const PathWorld& world, const SecondVertex& second,
                                       const WalkKey& key, float& cut);

/// A path as drawn: how much it brings over its density.
struct DrawnPath {
    ReusedPath y;
    Spectrum value{0.0f};
};

/// Walks once from u and appends what it finds, up to two paths.
void draw_paths(const PathWorld& world, const PixelDomain& domain, float u, const WalkKey& key,
                std::vector<DrawnPath>& paths, float& cut);

/// The light that a path brings in a pixel's domain, in its form's measure: transmittance of the
/// first two segments is exact. Black where the walk does not exist there, or would have another
/// form.
[[nodiscard]] Spectrum eval_path(const PathWorld& world, const PixelDomain& domain,
                                 const ReusedPath& path);

}  // namespace mote
