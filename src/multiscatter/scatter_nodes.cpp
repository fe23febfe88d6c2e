#include "multiscatter/scatter_nodes.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "multiscatter/still_scene.h"
#include "reference/path_tracer.h"
#include "restir/cache_stats.h"
#include "restir/in_view.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

constexpr size_t grain = 64;  ///< nodes per task

/// Nodes that the camera hardly sees still get a path with this probability: pixels at the border
/// of the view may use them.
constexpr float least_paths = 1.0f / 32;

/// Mean extinction around a node, from its own and its eight half-way neighbours' places [1/m].
float extinction_around(const Media& media, Vec3 node, float spacing)
{
    float sum = sigma_t_at(media, node, cache_time);
    for (int n = 0; n < 8; ++n) {
        const Vec3 corner(n & 1 ? 0.5f : -0.5f, n & 2 ? 0.5f : -0.5f, n & 4 ? 0.5f : -0.5f);
        sum += sigma_t_at(media, node + spacing * corner, cache_time);
    }
    return sum / 9.0f;
}

/// Pixels per steradian around the view's middle.
float pixels_per_steradian(const Camera& camera)
{
    return sqr(static_cast<float>(camera.height) / (2.0f * camera.tan_half_fov_y));
}

/// About how much of the image a node stands for: the pixels its cube covers, and the share of
/// their light that scatters in it.
struct NodeView {
    float pixels = 0.0f;
    float share = 0.0f;

    /// A node's noise reaches each of its pixels with its share: the sum of squares over the image
    /// is least with paths in proportion to this.
    [[nodiscard]] float importance() const { return std::sqrt(pixels) * share; }
};

NodeView view_of(const Scene& scene, const SmokeLattice& lattice, Vec3 node, Vec3 eye)
{
    const Camera& camera = scene.camera;
    const float h = lattice.spacing;
    const Vec3 from_eye = node - eye;
    const float distance = std::max(glm::length(from_eye), h);
    const float scale = pixels_per_steradian(camera);
    NodeView view;
    view.pixels = std::min(sqr(h / distance) * scale,
                           static_cast<float>(camera.width) * static_cast<float>(camera.height));
    const std::optional<Vec2> film = project(camera, node, cache_time);
    const float reach = h / distance * std::sqrt(scale);
    const bool inside = film && film->x > -reach && film->y > -reach &&
                        film->x < static_cast<float>(camera.width) + reach &&
                        film->y < static_cast<float>(camera.height) + reach;
    if (!inside && distance > 2.0f * h) return view;
    const Ray ray{eye, from_eye / distance, cache_time};
    if (scene.surfaces && is_shadowed(*scene.surfaces, ray, distance - h)) return view;
    const float T = std::exp(-optical_depth(scene.media, ray, {0.0f, distance}));
    view.share = T * -std::expm1(-h * extinction_around(scene.media, node, h));
    return view;
}

std::vector<NodeView> views_of(const Scene& scene, const SmokeLattice& lattice, Vec3 eye)
{
    std::vector<NodeView> views(lattice.nodes.size());
    parallel_for(views.size() - 1, grain, [&](size_t begin, size_t end) {
        for (size_t i = begin + 1; i < end + 1; ++i) {
            views[i] = view_of(scene, lattice, lattice.position(lattice.nodes[i]), eye);
        }
    });
    return views;
}

/// How many paths there are to share out, and among how many nodes that matter.
struct NodeBudget {
    double paths = 0.0;
    double nodes = 0.0;
    float per_importance = 0.0f;
};

NodeBudget budget_of(const std::vector<NodeView>& views, const ScatterNodesParams& params)
{
    double filled = 0.0;
    double total = 0.0;
    double squares = 0.0;
    for (const NodeView& view : views) {
        const auto importance = static_cast<double>(view.importance());
        filled += static_cast<double>(view.pixels * view.share);
        total += importance;
        squares += importance * importance;
    }
    NodeBudget budget;
    budget.paths = static_cast<double>(params.paths) * params.passes * filled;
    if (!(total > 0.0)) return budget;
    budget.nodes = total * total / squares;
    budget.per_importance = static_cast<float>(budget.paths / total);
    return budget;
}

/// Mean of a node's paths. `mean_count` of them are traced on average.
Spectrum trace_node(const TraceContext& context, const Phase& phase, Vec3 node, Vec3 wo,
                    float mean_count, Rng& rng)
{
    const bool is_rare = mean_count < 1.0f;
    const int count = is_rare ? (rng.uniform() < mean_count ? 1 : 0)
                              : static_cast<int>(std::lround(std::min(mean_count, 1e6f)));
    const float weight = 1.0f / (is_rare ? mean_count : static_cast<float>(count));
    ScatterEvent event{node, wo, 0.0f, &phase};
    Spectrum sum(0.0f);
    for (int i = 0; i < count; ++i) {
        sum += weight * trace_after_event(context, event, rng).indirect;
    }
    return sum;
}

/// Fine enough for the light not to change much from node to node: part of a free flight where the
/// smoke is dense; but not finer than a few pixels, as nodes cost paths.
float choose_spacing(const Scene& scene, Vec3 eye)
{
    constexpr float flights = 1.5f;
    constexpr float pixels = 4.0f;
    Bounds3 box;
    float densest = 0.0f;
    for (const Volume& volume : scene.media.volumes) {
        if (is_void(volume)) continue;
        box.extend(world_bounds(volume));
        for (const BrickRange& range : volume.density->ranges) {
            densest = std::max(densest, range.mean * volume.density_scale);
        }
    }
    const float diagonal = glm::length(box.extent());
    const float nearest = glm::length(glm::max(Vec3(0.0f), glm::max(box.lo - eye, eye - box.hi)));
    const float pixel =
        std::max(nearest, 0.05f * diagonal) / std::sqrt(pixels_per_steradian(scene.camera));
    return std::clamp(std::max(flights / densest, pixels * pixel), 1e-3f * diagonal,
                      0.125f * diagonal);
}

}  // namespace

bool can_have_scatter_nodes(const Scene& scene, const PathTracerParams& path)
{
    const std::vector<Volume>& volumes = scene.media.volumes;
    if (path.max_bounces < 2 || std::all_of(volumes.begin(), volumes.end(), is_void)) return false;
    if (!media_in_view(scene)) return false;
    return is_still_but_for_camera(scene);
}

ScatterNodes make_scatter_nodes(const TraceContext& context, const ScatterNodesParams& params)
{
    const Scene& scene = context.scene;
    const double start = process_cpu_seconds();
    ScatterNodes out;
    out.eye = Vec3(scene.camera.world_from_camera.at(cache_time).translate);
    const float spacing = params.spacing > 0.0f ? params.spacing : choose_spacing(scene, out.eye);
    out.phases = list_phases(scene.media);
    const SmokeLattice& lattice = out.lattice;
    std::vector<NodeView> views;
    NodeBudget budget;
    // Few paths deserve few nodes: one without a path is black, and others make up for it.
    for (float h = spacing;; h *= 1.4f) {
        out.lattice = make_smoke_lattice(scene.media, h, 1'000'000);
        views = views_of(scene, lattice, out.eye);
        budget = budget_of(views, params);
        if (budget.paths >= budget.nodes || lattice.active_count() <= 64) break;
    }
    const size_t slots = lattice.nodes.size();
    const float per_importance = budget.per_importance;
    out.radiance.assign(out.phases.size() * slots, Spectrum(0.0f));
    parallel_for(slots - 1, grain, [&](size_t begin, size_t end) {
        for (size_t i = begin + 1; i < end + 1; ++i) {
            const Vec3 node = lattice.position(lattice.nodes[i]);
            const float mean = std::max(per_importance * views[i].importance(), least_paths);
            for (size_t p = 0; p < out.phases.size(); ++p) {
                Rng rng(params.seed, static_cast<uint32_t>(scene.frame), Stream::ScatterNodes,
                        static_cast<uint32_t>(i), static_cast<uint32_t>(p));
                out.radiance[p * slots + i] =
                    trace_node(context, out.phases.phases[p], node, out.wo(node), mean, rng);
            }
        }
    });
    out.cpu_seconds = process_cpu_seconds() - start;
    return out;
}

}  // namespace mote
