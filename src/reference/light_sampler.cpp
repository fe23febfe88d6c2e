#include "reference/light_sampler.h"

#include "scene/environment.h"

namespace mote {
namespace {

/// Up to this many lights, Auto weighs each of them at each point.
constexpr size_t few_lights = 8;

float scene_radius(const Scene& scene)
{
    Bounds3 box;
    for (const Volume& volume : scene.media.volumes) box.extend(world_bounds(volume));
    if (scene.surfaces) box.extend(scene.surfaces->bvh->bounds());
    const float radius = 0.5f * glm::length(box.extent());
    return radius > 0.0f ? std::min(radius, 1e15f) : 1.0f;  // its square is to stay finite
}

bool can_be_met(const Light& light)
{
    return std::holds_alternative<SphereLight>(light) || std::holds_alternative<QuadLight>(light) ||
           std::holds_alternative<TriangleLight>(light);
}

bool is_in_tree(LightSource source, float fluence)
{
    return source == LightSource::Lamp && !(fluence > 0.0f);
}

}  // namespace

LightSampler::LightSampler(const Scene& scene, const PathTracerParams& params)
    : surfaces_(scene.lights)
{
    for (size_t i = 0; i < scene.media.volumes.size(); ++i) {
        const Volume& volume = scene.media.volumes[i];
        if (!volume.emission_params.is_on()) continue;
        EmissiveBricks bricks = make_emissive_bricks(volume);
        if (bricks.empty()) continue;
        const float length = glm::length(world_bounds(volume).extent());
        emissive_volumes_.push_back({static_cast<int>(i), std::move(bricks), length});
    }
    add_emitters(scene, params);
    kind_ = params.light_sampler;
    if (kind_ == LightSamplerKind::Auto) {
        kind_ = emitters_.size() <= few_lights ? LightSamplerKind::PowerDistance
                                               : LightSamplerKind::Tree;
    }
    listed_ = emitters_.size();
    if (emitters_.size() > 1 && kind_ == LightSamplerKind::Tree) {
        const auto middle = std::stable_partition(
            emitters_.begin(), emitters_.end(),
            [](const Emitter& e) { return !is_in_tree(e.source, e.fluence); });
        listed_ = static_cast<size_t>(middle - emitters_.begin());
        std::vector<LightTree::Item> items;
        for (size_t i = listed_; i < emitters_.size(); ++i) {
            items.push_back({static_cast<int>(i), emitters_[i].bounds, emitters_[i].power});
        }
        tree_ = LightTree(std::move(items));
    }
    if (emitters_.size() > 1 && kind_ == LightSamplerKind::Power) {
        std::vector<float> powers;
        powers.reserve(emitters_.size());
        for (const Emitter& emitter : emitters_) powers.push_back(emitter.power);
        table_ = AliasTable(powers);
    }
    emitter_of_lamp_.assign(scene.lights.size(), -1);
    for (size_t i = 0; i < emitters_.size(); ++i) {
        if (emitters_[i].source != LightSource::Lamp) continue;
        emitter_of_lamp_[static_cast<size_t>(emitters_[i].index)] = static_cast<int>(i);
    }
}

void LightSampler::add_emitters(const Scene& scene, const PathTracerParams& params)
{
    const bool shadow_rays = params.light_strategy != LightStrategy::Phase;
    const float cross_section = pi * sqr(scene_radius(scene));
    const auto add = [this](const Emitter& emitter) {
        if (emitter.power > 0.0f && std::isfinite(emitter.power)) emitters_.push_back(emitter);
    };
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        const int index = static_cast<int>(i);
        if (const auto* distant = std::get_if<DistantLight>(&light)) {
            const float fluence = luminance(distant->irradiance);
            add({LightSource::Lamp, index, cross_section * fluence, fluence, {}});
        } else if (shadow_rays || !can_be_met(light)) {
            add({LightSource::Lamp, index, brightest_power(light, 1.0f), 0.0f,
                 light_bounds(light)});
        }
    }
    if (!shadow_rays) return;
    // Scattered rays meet a constant environment wherever they leave, at no cost and with the
    // phase function's density: shadow rays could only add noise.
    const bool by_scattered_rays = scene.environment && !scene.environment->map &&
                                   params.light_strategy == LightStrategy::Auto;
    if (scene.environment && !by_scattered_rays) {
        const float fluence = environment_fluence(*scene.environment);
        add({LightSource::Environment, 0, cross_section * fluence, fluence, {}});
    }
    for (size_t i = 0; i < emissive_volumes_.size(); ++i) {
        const EmissiveVolume& emissive = emissive_volumes_[i];
        const Volume& volume = scene.media.volumes[static_cast<size_t>(emissive.volume)];
        const double scale =
            glm::determinant(glm::dmat3(matrix(volume.world_from_object.at(0.0f))));
        const auto power = static_cast<float>(emissive.bricks.total_power * std::abs(scale));
        add({LightSource::EmissiveVolume, static_cast<int>(i), power, 0.0f, world_bounds(volume)});
    }
}

double LightSampler::importance(const Emitter& emitter, Vec3 x)
{
    if (emitter.fluence > 0.0f) return static_cast<double>(emitter.fluence);
    const double distance2 = effective_distance2(emitter.bounds, x);
    return static_cast<double>(emitter.power) /
           (4.0 * std::numbers::pi * std::max(distance2, 1e-60));
}

double LightSampler::listed_importance(Vec3 x) const
{
    double sum = 0.0;
    for (size_t i = 0; i < listed_; ++i) sum += importance(emitters_[i], x);
    return sum;
}

double LightSampler::tree_importance(Vec3 x) const
{
    return tree_.importance(x) / (4.0 * std::numbers::pi);
}

std::optional<LightChoice> LightSampler::choose(Vec3 x, Rng& rng, const LightGuide* guide) const
{
    if (emitters_.empty()) return std::nullopt;
    const auto choice = [this](size_t i, double pmf) {
        return LightChoice{emitters_[i].source, emitters_[i].index, static_cast<float>(pmf)};
    };
    if (emitters_.size() == 1) return choice(0, 1.0);
    if (!table_.is_empty()) {
        const AliasTable::Sample sample = table_.sample(uniform_double(rng));
        return choice(sample.index, static_cast<double>(sample.pmf));
    }
    const double in_list = listed_importance(x);
    const double in_tree = tree_importance(x);
    const double total = in_list + in_tree;
    double u = listed_ == 0 ? total : uniform_double(rng) * total;
    if (!tree_.is_empty() && u >= in_list) {
        if (guide) {
            const LightGuide::Choice sample = guide->choose(x, uniform_double(rng));
            if (sample.lamp < 0) return std::nullopt;
            return LightChoice{
                LightSource::Lamp, sample.lamp,
                static_cast<float>(static_cast<double>(sample.pmf) * (in_tree / total))};
        }
        const LightTree::Choice sample = tree_.sample(x, rng);
        return choice(static_cast<size_t>(sample.id),
                      static_cast<double>(sample.pmf) * (in_tree / total));
    }
    size_t i = 0;
    double weight = importance(emitters_[0], x);
    while (u >= weight && i + 1 < listed_) {
        u -= weight;
        weight = importance(emitters_[++i], x);
    }
    return choice(i, weight / total);
}

float LightSampler::pmf(LightSource source, int index, Vec3 x, const LightGuide* guide) const
{
    const int found = find(source, index);
    if (found < 0) return 0.0f;
    const auto i = static_cast<size_t>(found);
    if (emitters_.size() == 1) return 1.0f;
    if (!table_.is_empty()) return table_.pmf(i);
    const double in_tree = tree_importance(x);
    const double total = listed_importance(x) + in_tree;
    if (i < listed_) return static_cast<float>(importance(emitters_[i], x) / total);
    const float own = guide ? guide->pmf(index, x) : tree_.pmf(found, x);
    return static_cast<float>(static_cast<double>(own) * (in_tree / total));
}

int LightSampler::find(LightSource source, int index) const
{
    if (source == LightSource::Lamp) return emitter_of_lamp_[static_cast<size_t>(index)];
    for (size_t i = 0; i < listed_; ++i) {
        if (emitters_[i].source == source && emitters_[i].index == index)
            return static_cast<int>(i);
    }
    return -1;
}

LightSampler build_light_sampler(const Scene& scene, const PathTracerParams& params)
{
    return LightSampler(scene, params);
}

}  // namespace mote
