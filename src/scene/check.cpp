#include "scene/check.h"

#include <cstdlib>
#include <map>

#include <fmt/format.h>

#include "core/text.h"

namespace mote {
namespace {

/// Position of a value by its path; of the nearest thing around it that is in the file, else.
SourcePosition position_of(const Node& root, std::initializer_list<std::string_view> path)
{
    const Node* node = &root;
    for (const std::string_view part : path) {
        const Node* next = nullptr;
        const bool is_number = !part.empty() && part[0] >= '0' && part[0] <= '9';
        if (is_number && node->kind == Node::Kind::Array) {
            const size_t index = std::strtoul(std::string(part).c_str(), nullptr, 10);
            if (index < node->children.size()) next = &node->children[index];
        } else if (is_number) {
            continue;  // a single table in place of a list
        } else {
            next = node->find(part);
        }
        if (!next) break;
        node = next;
    }
    return node->where;
}

struct Checker {
    const SceneDescription& scene;
    const Node& root;
    Problems& problems;

    template <class... Args>
    void report(std::initializer_list<std::string_view> path, fmt::format_string<Args...> format,
                Args&&... args)
    {
        problems.add(position_of(root, path), fmt::format(format, std::forward<Args>(args)...));
    }

    /// Names are the handles of references and of `--set list.name.key=...`.
    template <class Items>
    void check_names(const char* list, const Items& items)
    {
        std::map<std::string, size_t> seen;
        for (size_t i = 0; i < items.size(); ++i) {
            const std::string& name = items[i].name;
            const std::string index = std::to_string(i);
            if (name.empty()) continue;
            if (name.find_first_of(".=") != std::string::npos ||
                (name[0] >= '0' && name[0] <= '9')) {
                report({list, index, "name"},
                       "name \"{}\" must not start with a digit or hold \".\" or \"=\"",
                       printable(name, 60));
            }
            if (const auto [other, is_new] = seen.emplace(name, i); !is_new) {
                report({list, index, "name"}, "name \"{}\" is already that of [[{}]] number {}",
                       printable(name, 60), list, other->second);
            }
        }
    }

    template <class Key>
    void check_ascending(const char* list, size_t i, const std::vector<Key>& keys)
    {
        for (size_t k = 1; k < keys.size(); ++k) {
            if (keys[k].frame > keys[k - 1].frame) continue;
            report({list, std::to_string(i), "keys", std::to_string(k), "frame"},
                   "keyframes of \"keys\" in [{}] must ascend: {} after {}", list, keys[k].frame,
                   keys[k - 1].frame);
        }
    }

    void check_transforms(const char* list, size_t i, const std::vector<TransformKey>& keys)
    {
        const std::string index = std::to_string(i);
        for (size_t k = 0; k < keys.size(); ++k) {
            const std::string key = std::to_string(k);
            if (k > 0 && !(keys[k].frame > keys[k - 1].frame)) {
                report({list, index, "transform", key, "frame"},
                       "keyframes of \"transform\" in [{}] must ascend: {} after {}", list,
                       keys[k].frame, keys[k - 1].frame);
            }
            const Vec3d scale = glm::abs(keys[k].scale);
            if (std::min({scale.x, scale.y, scale.z}) < 1e-6) {
                report({list, index, "transform", key, "scale"},
                       "\"scale\" in [{}.transform] must not be 0", list);
            }
            if (k > 0 && glm::any(glm::lessThan(keys[k].scale * keys[k - 1].scale, Vec3d(0.0)))) {
                report({list, index, "transform", key, "scale"},
                       "\"scale\" in [{}.transform] passes through 0 between keyframes", list);
            }
        }
    }

    /// Pictures that could not be seen.
    void check_pictures(std::initializer_list<std::string_view> path,
                        const MaterialDescription& material)
    {
        if (!material.files.emission.empty() && !(material.emission > 0.0f)) {
            report(path, "\"emission_texture\" multiplies \"emission\", which is 0; set it");
        }
        if (material.files.alpha_cutoff > 0.0f && material.files.color.empty()) {
            report(path, "\"alpha_cutoff\" is about the alpha of \"color_texture\"; name one");
        }
    }

    /// Particle systems are meant by name.
    void check_system(std::initializer_list<std::string_view> path, const std::string& name)
    {
        std::vector<std::string> systems;
        for (const ParticlesDescription& p : scene.particles) systems.push_back(p.name);
        const bool is_known = std::find(systems.begin(), systems.end(), name) != systems.end();
        if (name.empty() || is_known) return;
        report(path, "no [[particles]] entry is named \"{}\"{}", printable(name, 60),
               did_you_mean(name, systems));
    }

    void check_camera();
    void check_particle_lights(size_t i);
    void check_volumes();
    void check_particles();
    void check_lights();
    void check_objects();
};

void Checker::check_camera()
{
    const CameraDescription& camera = scene.camera;
    if (camera.shutter_close < camera.shutter_open) {
        report({"camera", "shutter_close"}, "\"shutter_close\" is before \"shutter_open\"");
    }
    if (!camera.file.path.empty()) {
        const Node* table = root.find("camera");
        for (const char* key : {"position", "look_at", "up", "fov", "keys"}) {
            if (table && table->find(key)) {
                report({"camera", key}, "\"{}\" and \"file\" of the camera exclude each other",
                       key);
            }
        }
        if (camera.lens_radius > 0.0 && !(camera.focus_distance > 0.0)) {
            report({"camera", "lens_radius"},
                   "a camera with \"file\" and \"lens_radius\" needs a \"focus_distance\"");
        }
        return;
    }
    if (!camera.file.name.empty()) {
        report({"camera", "file"}, "\"file\" of the camera needs a \"path\"");
    }
    CameraDescription at = camera;
    const auto check_view = [&](std::initializer_list<std::string_view> path) {
        const Vec3d view = at.look_at - at.position;
        if (glm::length(view) < 1e-9) {
            report(path, "\"position\" and \"look_at\" of the camera are the same point");
        } else if (glm::length(glm::cross(view, at.up)) <
                       1e-6 * glm::length(view) * glm::length(at.up) ||
                   glm::length(at.up) < 1e-9) {
            report(path, "\"up\" of the camera points along its view; choose another");
        }
    };
    if (camera.keys.empty()) check_view({"camera"});
    for (size_t i = 0; i < camera.keys.size(); ++i) {
        const CameraKey& key = camera.keys[i];
        const std::string index = std::to_string(i);
        if (i > 0 && !(key.frame > camera.keys[i - 1].frame)) {
            report({"camera", "keys", index, "frame"},
                   "keyframes of the camera must ascend: {} after {}", key.frame,
                   camera.keys[i - 1].frame);
        }
        at.position = key.position.value_or(at.position);
        at.look_at = key.look_at.value_or(at.look_at);
        at.up = key.up.value_or(at.up);
        check_view({"camera", "keys", index});
    }
}

void Checker::check_volumes()
{
    for (size_t i = 0; i < scene.volumes.size(); ++i) {
        const VolumeDescription& volume = scene.volumes[i];
        const std::string index = std::to_string(i);
        const int sources = int{volume.file.has_value()} + int{!volume.particles.empty()} +
                            int{volume.procedural.has_value()};
        if (sources == 0) {
            report({"volumes", index},
                   "a volume needs \"file\", \"particles\" or \"procedural\" for its density");
        } else if (sources > 1) {
            report({"volumes", index},
                   "a volume has one source: \"file\", \"particles\" or \"procedural\"");
        }
        if (volume.file && volume.file->pattern.empty()) {
            report({"volumes", index, "file"}, "\"file\" in [volumes] is empty");
        }
        check_system({"volumes", index, "particles"}, volume.particles);
        if (volume.procedural) {
            const Vec3d voxels =
                Vec3d(volume.procedural->size) / static_cast<double>(volume.procedural->voxel_size);
            if (voxels.x * voxels.y * voxels.z > 1e9) {
                report({"volumes", index, "procedural", "voxel_size"},
                       "{:.0f} x {:.0f} x {:.0f} voxels are more than 10^9; choose a larger "
                       "\"voxel_size\"",
                       voxels.x, voxels.y, voxels.z);
            }
        }
        check_transforms("volumes", i, volume.transform);
    }
}

void Checker::check_particles()
{
    for (size_t i = 0; i < scene.particles.size(); ++i) {
        const std::string index = std::to_string(i);
        const Node* list = root.find("particles");
        const bool in_file = list && list->kind == Node::Kind::Array && i < list->children.size();
        if (!in_file) continue;
        const bool has_file = list->children[i].find("file") != nullptr;
        const bool has_emitter = list->children[i].find("emitter") != nullptr;
        if (has_file == has_emitter) {
            report({"particles", index}, "a particle system {}: \"emitter\" or \"file\"",
                   has_file ? "has one source" : "needs a source");
        }
        const auto* cache = std::get_if<CacheParams>(&scene.particles[i].source);
        if (cache && cache->sequence.pattern.empty()) {
            report({"particles", index, "file"}, "\"file\" in [particles] is empty");
        }
    }
}

void Checker::check_lights()
{
    int environments = 0;
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const LightDescription& light = scene.lights[i];
        const std::string index = std::to_string(i);
        if (light.kind == LightKind::Environment && ++environments > 1) {
            report({"lights", index, "type"}, "a scene has one environment light");
        }
        const bool has_direction =
            light.kind == LightKind::Distant || light.kind == LightKind::Spot;
        if (has_direction && !(glm::length(light.direction) > 1e-18f)) {
            report({"lights", index, "direction"}, "\"direction\" in [lights] must not be 0");
        }
        const float area = glm::length(glm::cross(light.edge_u, light.edge_v));
        if (light.kind == LightKind::Quad && !(area > 0.0f && std::isfinite(area))) {
            report({"lights", index, "edge_u"}, "\"edge_u\" and \"edge_v\" span no area");
        }
        if (glm::any(glm::lessThan(light.spread, Vec3(0.0f)))) {
            report({"lights", index, "spread"}, "\"spread\" in [lights] must not be negative");
        }
        if (light.kind == LightKind::Sphere) check_particle_lights(i);
        check_ascending("lights", i, light.keys);
        check_transforms("lights", i, light.transform);
    }
}

/// Particles bring places and sizes; what is about them needs them.
void Checker::check_particle_lights(size_t i)
{
    const std::string index = std::to_string(i);
    const bool has_particles = !scene.lights[i].particles.empty();
    check_system({"lights", index, "particles"}, scene.lights[i].particles);
    const Node* list = root.find("lights");
    const bool in_file = list && list->kind == Node::Kind::Array && i < list->children.size();
    if (!in_file) return;
    const Node& table = list->children[i];
    if (has_particles) {
        for (const char* key : {"position", "radius", "count", "spread", "seed"}) {
            if (!table.find(key)) continue;
            report({"lights", index, key},
                   "\"{}\" of a light with \"particles\" comes from the particles; leave it out",
                   key);
        }
        return;
    }
    for (const char* key : {"radius_scale", "use_color", "use_temperature"}) {
        if (!table.find(key)) continue;
        report({"lights", index, key}, "\"{}\" of a light needs \"particles\"", key);
    }
}

void Checker::check_objects()
{
    std::vector<std::string> materials;
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        materials.push_back(scene.materials[i].name);
        if (materials.back().empty()) {
            report({"materials", std::to_string(i)}, "a material needs a \"name\" to be used by");
        }
    }
    for (size_t i = 0; i < scene.materials.size(); ++i) {
        check_pictures({"materials", std::to_string(i)}, scene.materials[i]);
    }
    const Node* list = root.find("objects");
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        const ObjectDescription& object = scene.objects[i];
        const std::string index = std::to_string(i);
        const std::string& name = object.material.name;
        const bool is_known =
            std::find(materials.begin(), materials.end(), name) != materials.end();
        if (!name.empty() && !is_known) {
            report({"objects", index, "material"}, "no [[materials]] entry is named \"{}\"{}",
                   printable(name, 60), did_you_mean(name, materials));
        }
        check_pictures({"objects", index, "material"}, object.material);
        const bool in_file = list && list->kind == Node::Kind::Array && i < list->children.size();
        const Node* material = in_file ? list->children[i].find("material") : nullptr;
        const bool has_more =
            material && material->kind == Node::Kind::Table && material->children.size() > 1;
        if (!name.empty() && has_more) {
            report({"objects", index, "material"},
                   "\"material\" in [objects] either names a [[materials]] entry or describes one");
        }
        check_transforms("objects", i, object.transform);
    }
}

}  // namespace

void check_scene(const SceneDescription& scene, const Node& root, Problems& problems)
{
    Checker checker{scene, root, problems};
    if (scene.last_frame < scene.first_frame) {
        checker.report({root.find("last_frame") ? "last_frame" : "first_frame"},
                       "\"last_frame\" is {}, before \"first_frame\" {}", scene.last_frame,
                       scene.first_frame);
    }
    const int64_t pixels = int64_t{scene.render.width} * scene.render.height;
    if (pixels > (int64_t{1} << 28)) {
        checker.report({"render", "width"}, "{} x {} pixels are more than 2^28", scene.render.width,
                       scene.render.height);
    }
    const RestirParams& restir = scene.render.restir;
    if (restir.surface.shading == SurfaceShading::All &&
        surface_mis(restir) == ReuseMis::Contribution) {
        checker.report({"render", "restir", "surface", "shading"},
                       "\"shading\" = \"all\" needs weights for every sample, which \"mis\" = "
                       "\"contribution\" has not; choose another \"mis\", or \"chosen\"");
    }
    if (scene.output.path.empty()) {
        checker.report({"output", "path"}, "\"path\" in [output] is empty");
    }
    checker.check_names("volumes", scene.volumes);
    checker.check_names("particles", scene.particles);
    checker.check_names("lights", scene.lights);
    checker.check_names("materials", scene.materials);
    checker.check_names("objects", scene.objects);
    checker.check_camera();
    checker.check_volumes();
    checker.check_particles();
    checker.check_lights();
    checker.check_objects();
}

}  // namespace mote
