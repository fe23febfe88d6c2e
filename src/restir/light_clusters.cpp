#include "restir/light_clusters.h"

#include <algorithm>

namespace mote {
namespace {

/// More clusters than this would not make distributions over at most a few dozen of them better.
constexpr size_t most_leaves = 16384;

/// Of a light, what sorting looks at.
struct Place {
    Vec3 position{0.0f};
    int light = 0;
};

LightCluster merge(const LightCluster& a, const LightCluster& b)
{
    const double power = static_cast<double>(a.power) + static_cast<double>(b.power);
    const auto share = static_cast<float>(static_cast<double>(b.power) / power);
    const Vec3 apart = b.centre - a.centre;
    LightCluster out;
    out.centre = a.centre + share * apart;
    out.power = static_cast<float>(std::min(power, 1e37));
    out.facing = a.facing + share * (b.facing - a.facing);
    out.spread2 = a.spread2 + share * (b.spread2 - a.spread2) +
                  share * (1.0f - share) * glm::dot(apart, apart);
    out.begin = a.begin;
    out.end = b.end;
    return out;
}

class Builder {
  public:
    Builder(std::span<const LocalLight> lights, LightClusters& out) : lights_(lights), out_(out)
    {
        places_.reserve(lights.size());
        for (size_t i = 0; i < lights.size(); ++i)
            places_.push_back({lights[i].position, static_cast<int>(i)});
        leaf_size_ = (lights.size() + most_leaves - 1) / most_leaves;
    }

    int build(size_t begin, size_t end)
    {
        const size_t index = out_.nodes.size();
        out_.nodes.emplace_back();
        Bounds3 box;
        for (size_t i = begin; i < end; ++i) box.extend(places_[i].position);
        out_.bounds.push_back(box);
        if (end - begin <= leaf_size_) {
            out_.nodes[index] = leaf(begin, end);
            return static_cast<int>(index);
        }
        const size_t middle = begin + (end - begin) / 2;
        split(begin, middle, end, box.extent());
        build(begin, middle);
        const int right = build(middle, end);
        LightCluster node = merge(out_.nodes[index + 1], out_.nodes[static_cast<size_t>(right)]);
        node.right = right;
        out_.nodes[index] = node;
        return static_cast<int>(index);
    }

    [[nodiscard]] const std::vector<Place>& places() const { return places_; }

  private:
    void split(size_t begin, size_t middle, size_t end, Vec3 extent)
    {
        int axis = extent.y > extent.x ? 1 : 0;
        if (extent.z > extent[axis]) axis = 2;
        const auto at = [this](size_t i) {
            return places_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(at(begin), at(middle), at(end), [axis](const Place& a, const Place& b) {
            const float pa = a.position[axis];
            const float pb = b.position[axis];
            return pa != pb ? pa < pb : a.light < b.light;
        });
    }

    [[nodiscard]] LightCluster leaf(size_t begin, size_t end) const
    {
        LightCluster sum;
        for (size_t i = begin; i < end; ++i) {
            const LocalLight& light = lights_[static_cast<size_t>(places_[i].light)];
            LightCluster one;
            one.centre = light.position;
            one.power = light.power;
            one.facing = light.facing;
            one.spread2 = light.spread2;
            one.begin = static_cast<int>(i);
            one.end = static_cast<int>(i + 1);
            sum = i == begin ? one : merge(sum, one);
        }
        return sum;
    }

    std::span<const LocalLight> lights_;
    LightClusters& out_;
    std::vector<Place> places_;
    size_t leaf_size_ = 1;
};

}  // namespace

LightClusters make_light_clusters(std::span<const LocalLight> lights)
{
    LightClusters out;
    if (lights.empty()) return out;
    const size_t most_nodes = 2 * std::min(lights.size(), 2 * most_leaves);
    out.nodes.reserve(most_nodes);
    out.bounds.reserve(most_nodes);
    Builder builder(lights, out);
    builder.build(0, lights.size());

    int last_id = 0;
    double power = 0.0;
    for (const LocalLight& light : lights) {
        last_id = std::max(last_id, light.id);
        power += static_cast<double>(light.power);
    }
    out.place_of_id.assign(static_cast<size_t>(last_id) + 1, -1);
    out.ids.reserve(lights.size());
    out.share_sum.reserve(lights.size() + 1);
    out.share_sum.push_back(0.0);
    const double least = 1e-6 / static_cast<double>(lights.size());
    for (const Place& place : builder.places()) {
        const LocalLight& light = lights[static_cast<size_t>(place.light)];
        out.place_of_id[static_cast<size_t>(light.id)] = static_cast<int>(out.ids.size());
        out.ids.push_back(light.id);
        const double share = static_cast<double>(light.power) / power;
        out.share_sum.push_back(out.share_sum.back() + std::max(share, least));
    }
    return out;
}

}  // namespace mote
