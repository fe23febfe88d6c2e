#include "multiscatter/gather_light.h"

#include <algorithm>
#include <cmath>

#include "multiscatter/vertex_lanes.h"

namespace mote {
namespace {

/// Keeps ratios of transmittances finite.
constexpr float most_excess = 80.0f;

/// A draw among the vertices found.
struct Draw {
    int j = -1;        ///< -1: nothing arrives
    float inv = 0.0f;  ///< one over its probability
};

/// A connection whose transmittance is asked for.
struct Check {
    int vertex = 0;
    float log_excess = 0.0f;  ///< of the assumed transmittances
    Spectrum light{0.0f};     ///< that was taken in on their account
};

class Gatherer {
  public:
    Gatherer(const SharingContext& context, PathLevel& level, const PathLevel& next, Rng& rng,
             std::span<Spectrum> light)
        : context_(context), level_(level), next_(next), rng_(rng), light_(light)
    {
    }

    void gather_group(size_t g)
    {
        const VertexGroup& found = level_.found[g];
        const std::span<const int> members = level_.members(level_.groups[g]);
        if (is_first()) {
            for (const int i : members) {
                const PathVertex& v = level_.vertices[static_cast<size_t>(i)];
                light_[static_cast<size_t>(v.from)] += v.weight * v.known;
            }
        }
        if (found.count == 0) return;
        shares_.assign(members.size(), 0.0f);
        fill_lanes(level_.vertices, members, shares_, lanes_);
        const size_t width = lanes_.width();
        const std::span<const float> kernels =
            std::span(level_.kernels).subspan(level_.kernel_of[g], found.count * width);
        sums_.clear(lanes_.lanes.size());
        brought_.resize(found.count * width);
        for (size_t j = 0; j < found.count; ++j) {
            const PathVertex& y = next_.vertices[found.first + j];
            const std::span<const float> kernel = kernels.subspan(j * width, width);
            const std::span<float> brought = std::span(brought_).subspan(j * width, width);
            if (y.surface < 0) {
                scatter_to_group(lanes_, y, kernel, sums_, brought);
            } else {
                scatter_from_surface(members, y, kernel, brought);
            }
        }
        for (size_t i = 0; i < members.size(); ++i) {
            const Draw draw = draw_one(i, found.count, width);
            if (draw.j < 0) continue;
            const auto j = static_cast<size_t>(draw.j);
            const PathVertex& y = next_.vertices[found.first + j];
            take_in(members[i], sums_.at(i), y, kernels[j * width + i] * draw.inv);
        }
    }

    /// Makes good what was assumed.
    void check_connections()
    {
        std::vector<float> taus(queries_.size());
        optical_depths(context_.trace.scene.media, queries_, taus, context_.counts);
        for (size_t i = 0; i < checks_.size(); ++i) {
            const Check& check = checks_[i];
            const float ratio = std::exp(std::min(check.log_excess - taus[i], most_excess));
            const Spectrum missing = check.light * (ratio - 1.0f);
            PathVertex& v = level_.vertices[static_cast<size_t>(check.vertex)];
            if (is_first()) {
                light_[static_cast<size_t>(v.from)] += missing;
            } else {
                v.arrivals[v.arrival_count - 1].E += missing;
            }
        }
    }

  private:
    [[nodiscard]] bool is_first() const { return !light_.empty(); }

    [[nodiscard]] Spectrum scattered(const PathVertex& y, Vec3 wo) const
    {
        Spectrum sum(0.0f);
        ScatterEvent event = next_.event(y, context_.time);
        if (y.phase) event.phase = y.phase;
        for (int a = 0; a < y.arrival_count; ++a) {
            sum += eval_scattering_to(event, wo, y.arrivals[a].wi).f * y.arrivals[a].E;
        }
        return y.weight * sum;
    }

    void scatter_from_surface(std::span<const int> members, const PathVertex& y,
                              std::span<const float> kernel, std::span<float> brought)
    {
        std::fill(brought.begin(), brought.end(), 0.0f);
        for (size_t i = 0; i < members.size(); ++i) {
            const Vec3 to = level_.vertices[static_cast<size_t>(members[i])].x - y.x;
            const Spectrum s = kernel[i] * scattered(y, glm::normalize(to));
            sums_.add(i, s);
            brought[i] = max_component(glm::abs(s));
        }
    }

    Draw draw_one(size_t i, size_t count, size_t width)
    {
        float sum = 0.0f;
        for (size_t j = 0; j < count; ++j) sum += brought_[j * width + i];
        const float goal = rng_.uniform() * sum;
        Draw draw;
        float before = 0.0f;
        for (size_t j = 0; j < count; ++j) {
            const float own = brought_[j * width + i];
            if (!(own > 0.0f)) continue;
            draw = {static_cast<int>(j), sum / own};
            before += own;
            if (before > goal) break;
        }
        return draw;
    }

    /// `kernel`: towards y, over the probability of having drawn it.
    void take_in(int index, Spectrum sum, const PathVertex& y, float kernel)
    {
        PathVertex& v = level_.vertices[static_cast<size_t>(index)];
        const Vec3 to = y.x - v.x;
        const float distance = std::max(glm::length(to), 1e-15f);
        const Vec3 wi = to / distance;
        Check check{index, y.log_excess, kernel * scattered(y, -wi)};
        if (is_first()) {
            light_[static_cast<size_t>(v.from)] += v.weight * sum;
            check.light *= v.weight;
        } else {
            check.light /= phase_pdf(v.lobe, v.wo, wi);
            v.arrivals[v.arrival_count++] = {wi, check.light};
        }
        if (y.from == index) return;  // traced already
        check.log_excess -= std::log(assumed_transmittance(context_.extinction, y.x, v.x));
        queries_.push_back({v.x, distance, wi, context_.time, infinity});
        checks_.push_back(check);
    }

    const SharingContext& context_;
    PathLevel& level_;
    const PathLevel& next_;
    Rng& rng_;
    std::span<Spectrum> light_;
    LaneGroup lanes_;
    LaneSums sums_;
    std::vector<float> shares_;
    std::vector<float> brought_;
    std::vector<DepthQuery> queries_;
    std::vector<Check> checks_;
};

}  // namespace

void gather_light(const SharingContext& context, PathLevel& level, const PathLevel& next, Rng& rng,
                  std::span<Spectrum> light)
{
    Gatherer gatherer(context, level, next, rng, light);
    for (size_t g = 0; g < level.groups.size(); ++g) gatherer.gather_group(g);
    gatherer.check_connections();
}

}  // namespace mote
