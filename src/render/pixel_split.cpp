#include "render/pixel_split.h"

#include "core/parallel.h"
#include "render/lamp_marks.h"
#include "render/seen_look.h"
#include "restir/in_view.h"

namespace mote {
namespace {

/// Of all pixels, those that small glowing triangles may divide into parts, each of which costs a
/// sample of light: where lamps are everywhere, that is more than it brings (measured).
constexpr float triangle_share = 1.0f / 16.0f;

/// Looks at the corners of a tile's pixels, each given what was seen one corner before; marks the
/// pixels whose corners differ.
template <class Look, class LookAt, class Alike>
void mark_edges(const Camera& camera, const Tile& tile, uint8_t strata, LookAt&& look_at,
                Alike&& alike, SplitMap& map)
{
    const int width = tile.x1 - tile.x0 + 1;
    std::vector<Look> above(static_cast<size_t>(width));
    std::vector<Look> below(static_cast<size_t>(width));
    for (int y = tile.y0; y <= tile.y1; ++y) {
        for (int i = 0; i < width; ++i) {
            const auto k = static_cast<size_t>(i);
            const Ray ray = generate_ray(camera, Vec2(tile.x0 + i, y), Vec2(0.5f), 0.5f);
            below[k] = look_at(ray, i > 0 ? below[k - 1] : above[k]);
        }
        for (int i = 0; y > tile.y0 && i + 1 < width; ++i) {
            const auto k = static_cast<size_t>(i);
            const Look& first = above[k];
            const bool is_smooth =
                alike(first, above[k + 1]) && alike(first, below[k]) && alike(first, below[k + 1]);
            if (!is_smooth) map.at(tile.x0 + i, y - 1) = strata;
        }
        std::swap(above, below);
    }
}

void split_at_surfaces(const Scene& scene, uint8_t strata, SplitMap& map)
{
    const Camera& camera = scene.camera;
    map = SplitMap(camera.width, camera.height, 1);
    LampMarks marks(camera, 0.5f);
    for (const Light& light : scene.lights) {
        const auto* triangle = std::get_if<TriangleLight>(&light);
        if (triangle) (void)marks.add(light_bounds(light), luminance(triangle->radiance));
    }
    marks.mark(strata, triangle_share, map);
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        if (!surfaces_in_view(scene, tile)) return;
        mark_edges<SeenLook>(
            camera, tile, strata,
            [&](const Ray& ray, const SeenLook& near) {
                return look_along(*scene.surfaces, ray, &near);
            },
            looks_alike, map);
    });
}

/// Spheres and quads that rays can meet: those of LampSurfaces.
bool is_lamp(const Light& light)
{
    return (std::holds_alternative<SphereLight>(light) ||
            std::holds_alternative<QuadLight>(light)) &&
           light_power(light, 1.0f) > 0.0f;
}

float lamp_radiance(const Light& lamp)
{
    const auto* sphere = std::get_if<SphereLight>(&lamp);
    return luminance(sphere ? sphere->radiance : std::get<QuadLight>(lamp).radiance);
}

std::vector<std::optional<FilmBox>> film_boxes(const Scene& scene)
{
    const std::vector<Trs> poses = shutter_poses(scene.camera);
    std::vector<std::optional<FilmBox>> boxes(scene.lights.size());
    parallel_for(boxes.size(), 1024, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            if (is_lamp(scene.lights[i])) boxes[i] = film_box(scene.camera, poses, scene.lights[i]);
        }
    });
    return boxes;
}

void split_at_lamps(const Scene& scene, uint8_t strata, PixelSplits& splits)
{
    const Camera& camera = scene.camera;
    LampMarks marks(camera, 0.5f);
    std::vector<FilmBox> boxes(scene.lights.size());
    std::vector<Light> wide;
    bool has_lamps = false;
    const std::vector<std::optional<FilmBox>> found = film_boxes(scene);
    for (size_t i = 0; i < scene.lights.size(); ++i) {
        const Light& light = scene.lights[i];
        if (!is_lamp(light)) continue;
        has_lamps = true;
        if (found[i]) {
            boxes[i] = *found[i];
        } else if (!marks.add(light_bounds(light), lamp_radiance(light))) {
            wide.push_back(light);
        }
    }
    if (!has_lamps) return;
    splits.lamps = SplitMap(camera.width, camera.height, 1);
    marks.mark(strata, 1.0f, splits.lamps);
    splits.lists = list_lamps(std::move(boxes), strata, splits.lamps);
    const LampSurfaces index(wide);
    if (index.is_empty()) return;
    for_each_tile(camera.width, camera.height, [&](const Tile& tile) {
        mark_edges<Spectrum>(
            camera, tile, strata,
            [&](const Ray& ray, Spectrum /*near*/) { return lamp_light(wide, index, ray); },
            emits_alike, splits.lamps);
    });
}

}  // namespace

PixelSplits find_split_pixels(const Scene& scene, int strata)
{
    PixelSplits splits;
    if (strata < 2) return splits;
    const auto mark = static_cast<uint8_t>(strata);
    if (scene.surfaces) split_at_surfaces(scene, mark, splits.parts);
    split_at_lamps(scene, mark, splits);
    return splits;
}

}  // namespace mote
