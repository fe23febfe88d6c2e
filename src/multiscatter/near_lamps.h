#pragma once

#include <span>
#include <vector>

#include "core/rng.h"
#include "multiscatter/path_vertex.h"
#include "reference/trace_context.h"

namespace mote {

/// Places close to lamps, drawn for a group of vertices beside those that its paths find. Near a
/// small lamp light grows with 1/r^2, so that the few paths which end there bring far too much, to
/// all of the group alike; balls whose points lie as dense as that make it even. After
/// equiangular sampling (Kulla and Fajardo 2012), which does the same along one ray.
///
/// Any choice of balls is unbiased, as long as both kinds of places are weighted by `density`.
class NearLamps {
  public:
    /// Chooses balls around point, spot and sphere lamps that matter to vertices around `center`
    /// [m], by the light sampler: none if it chooses other lights. `count`: points to draw in all.
    /// `sigma_t`: extinction around the vertices [1/m]; balls need not be larger than a free path.
    void choose(const TraceContext& context, Vec3 center, float sigma_t, int count, Rng& rng);

    /// Without balls nothing is drawn.
    void clear() { balls_.clear(); }

    /// Expected number of drawn points per volume around y [1/m^3].
    [[nodiscard]] float density(Vec3 y) const;

    /// Calls f(point) for each point.
    template <class F>
    void for_each_point(Rng& rng, F&& f) const
    {
        for (const Ball& ball : balls_) {
            for (int i = 0; i < ball.count; ++i) f(sample(ball, i, rng));
        }
    }

  private:
    /// Points spread evenly over radii from inner to outer.
    struct Ball {
        Vec3 center{0.0f};
        float inner = 0.0f;  ///< of the lamp [m]
        float outer = 0.0f;
        int count = 0;
    };
    [[nodiscard]] static Vec3 sample(const Ball& ball, int index, Rng& rng);

    std::vector<Ball> balls_;
};

/// Whether the scene has a lamp that balls can be drawn around.
[[nodiscard]] bool has_small_lamps(const Scene& scene);

}  // namespace mote
