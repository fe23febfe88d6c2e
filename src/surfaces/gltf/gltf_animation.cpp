#include <algorithm>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/text.h"
#include "surfaces/gltf/gltf_convert.h"

namespace mote {
namespace {

GltfInterpolation interpolation_of(const GltfSource& source, const std::string& name)
{
    if (name.empty() || name == "LINEAR") return GltfInterpolation::Linear;
    if (name == "STEP") return GltfInterpolation::Step;
    if (name == "CUBICSPLINE") return GltfInterpolation::Cubic;
    source.fail(fmt::format("animation: no interpolation is called \"{}\"", printable(name, 40)));
}

GltfTrack read_track(const GltfSource& source, const tinygltf::AnimationSampler& sampler,
                     int components)
{
    GltfTrack track;
    track.interpolation = interpolation_of(source, sampler.interpolation);
    for (const glm::vec4& time : read_vectors(source, sampler.input, 1, "keyframe times")) {
        if (!std::isfinite(time.x)) source.fail("animation: a keyframe's time is not finite");
        if (!track.times.empty() && !(time.x > track.times.back())) {
            source.fail("animation: the times of keyframes do not ascend");
        }
        track.times.push_back(time.x);
    }
    track.values = read_vectors(source, sampler.output, components, "keyframe values");
    const size_t per_key = track.interpolation == GltfInterpolation::Cubic ? 3 : 1;
    if (track.values.size() != per_key * track.times.size()) {
        source.fail(fmt::format("animation: {} values for {} keyframes", track.values.size(),
                                track.times.size()));
    }
    for (const glm::vec4& value : track.values) {
        for (int c = 0; c < 4; ++c) {
            if (!std::isfinite(value[c])) source.fail("animation: a keyframe is not finite");
        }
    }
    return track;
}

glm::dvec4 mix_rotations(const glm::vec4& a, const glm::vec4& b, double u)
{
    const auto quaternion = [](const glm::vec4& v) {
        const Quatd q(static_cast<double>(v.w), static_cast<double>(v.x), static_cast<double>(v.y),
                      static_cast<double>(v.z));
        return glm::length(q) > 1e-9 ? glm::normalize(q) : Quatd(1.0, 0.0, 0.0, 0.0);
    };
    const Quatd q = glm::slerp(quaternion(a), quaternion(b), u);
    return {q.x, q.y, q.z, q.w};
}

/// The value of a track at a time.
glm::dvec4 value_at(const GltfTrack& track, bool is_rotation, double seconds)
{
    const auto after =
        std::upper_bound(track.times.begin(), track.times.end(), seconds,
                         [](double t, float key) { return t < static_cast<double>(key); });
    const bool is_cubic = track.interpolation == GltfInterpolation::Cubic;
    const auto value = [&](size_t key) { return track.values[is_cubic ? 3 * key + 1 : key]; };
    if (after == track.times.begin()) return glm::dvec4(value(0));
    const auto k = static_cast<size_t>(after - track.times.begin()) - 1;
    if (after == track.times.end() || track.interpolation == GltfInterpolation::Step) {
        return glm::dvec4(value(k));
    }
    const double length =
        static_cast<double>(track.times[k + 1]) - static_cast<double>(track.times[k]);
    const double u = (seconds - static_cast<double>(track.times[k])) / length;
    if (is_cubic) {
        const double u2 = u * u;
        const double u3 = u2 * u;
        return (2.0 * u3 - 3.0 * u2 + 1.0) * glm::dvec4(value(k)) +
               length * (u3 - 2.0 * u2 + u) * glm::dvec4(track.values[3 * k + 2]) +
               (3.0 * u2 - 2.0 * u3) * glm::dvec4(value(k + 1)) +
               length * (u3 - u2) * glm::dvec4(track.values[3 * k + 3]);
    }
    if (is_rotation) return mix_rotations(value(k), value(k + 1), u);
    return (1.0 - u) * glm::dvec4(value(k)) + u * glm::dvec4(value(k + 1));
}

Mat4d parent_from_node(const GltfNode& node, double seconds)
{
    if (node.matrix) return *node.matrix;
    Trs trs = node.trs;
    if (node.translation) trs.translate = Vec3d(value_at(*node.translation, false, seconds));
    if (node.scale) trs.scale = Vec3d(value_at(*node.scale, false, seconds));
    if (node.rotation) {
        const glm::dvec4 v = value_at(*node.rotation, true, seconds);
        const Quatd q(v.w, v.x, v.y, v.z);
        if (glm::length(q) > 1e-9) trs.rotate = glm::normalize(q);
    }
    return matrix(trs);
}

}  // namespace

void convert_animations(const GltfSource& source, const std::vector<int>& node_of, GltfScene& out)
{
    bool has_weights = false;
    bool has_doubles = false;
    for (const tinygltf::Animation& animation : source.model.animations) {
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            if (channel.target_node < 0) continue;
            (void)source.at(source.model.nodes, channel.target_node, "node");
            const int place = node_of[static_cast<size_t>(channel.target_node)];
            if (place < 0) continue;
            GltfNode& node = out.nodes[static_cast<size_t>(place)];
            const std::string& path = channel.target_path;
            std::optional<GltfTrack>* track = path == "translation" ? &node.translation
                                              : path == "rotation"  ? &node.rotation
                                              : path == "scale"     ? &node.scale
                                                                    : nullptr;
            has_weights |= track == nullptr;
            if (!track) continue;
            has_doubles |= track->has_value();
            if (track->has_value()) continue;
            if (node.matrix) {
                source.fail(
                    fmt::format("animation: node {} is placed by a matrix, which cannot be "
                                "animated",
                                channel.target_node));
            }
            *track = read_track(source, source.at(animation.samplers, channel.sampler, "sampler"),
                                path == "rotation" ? 4 : 3);
        }
    }
    if (has_weights) {
        spdlog::warn("{}: morph targets are not shown", printable(source.path));
    }
    if (has_doubles) {
        spdlog::warn("{}: several animations move the same nodes; the first one is shown",
                     printable(source.path));
    }
}

Mat4d world_from_node(const GltfScene& scene, int node, double seconds)
{
    Mat4d out(1.0);
    for (int i = node; i >= 0; i = scene.nodes[static_cast<size_t>(i)].parent) {
        out = parent_from_node(scene.nodes[static_cast<size_t>(i)], seconds) * out;
    }
    return out;
}

bool is_animated(const GltfScene& scene, int node)
{
    for (int i = node; i >= 0; i = scene.nodes[static_cast<size_t>(i)].parent) {
        const GltfNode& at = scene.nodes[static_cast<size_t>(i)];
        if (at.translation || at.rotation || at.scale) return true;
    }
    return false;
}

}  // namespace mote
