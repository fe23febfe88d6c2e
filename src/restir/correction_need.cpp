#include "restir/correction_need.h"

#include <algorithm>
#include <cmath>

#include "core/buffer2d.h"
#include "core/parallel.h"
#include "restir/pixel_domain.h"
#include "volumes/media_extent.h"

namespace mote {
namespace {

/// What a pixel may need, over what the mean one does: caches may be wrong.
constexpr float least_need = 1.0f / 16.0f;
constexpr float most_need = 4.0f;

}  // namespace

RayCount rays_needed(int usual, float known, float mean_known, float u)
{
    auto wanted = static_cast<float>(usual);
    if (mean_known > 0.0f) {
        wanted *= std::clamp(std::sqrt(known / mean_known), least_need, most_need);
    }
    const float whole = std::floor(wanted);
    RayCount out;
    out.count = static_cast<int>(whole) + (u < wanted - whole ? 1 : 0);
    if (out.count > 0) out.share = 1.0f / std::min(wanted, static_cast<float>(out.count));
    if (wanted > 1.0f) out.share = 1.0f / static_cast<float>(out.count);
    return out;
}

Vec2 mean_known_light(const FrameDomain& frame)
{
    if (!frame.params.control_variate || !frame.params.corrections) return Vec2(0.0f);
    const Camera& camera = frame.scene->camera;
    constexpr int step = image_tile_size;
    const int columns = (camera.width + step - 1) / step;
    const int rows = (camera.height + step - 1) / step;
    Buffer2D<Vec3> known(columns, rows);
    parallel_for(known.size(), 16, [&](size_t begin, size_t end) {
        BinCounts counts;
        PixelDomain pixel;
        for (size_t i = begin; i < end; ++i) {
            const int x = static_cast<int>(i) % columns * step;
            const int y = static_cast<int>(i) / columns * step;
            const Vec2 middle(0.5f * static_cast<float>(x + std::min(x + step, camera.width)),
                              0.5f * static_cast<float>(y + std::min(y + step, camera.height)));
            const Ray ray = generate_ray(camera, middle, Vec2(0.5f), cache_time);
            make_pixel_domain(frame, ray, pixel, counts);
            if (pixel.bins.empty()) continue;
            const KnownLight light = known_infinite_lights(frame, ray, pixel.bins);
            known.data()[i] = {luminance(light.distant), luminance(light.environment), 1.0f};
        }
    });
    Vec3d sum(0.0);
    for (size_t i = 0; i < known.size(); ++i) sum += Vec3d(known.data()[i]);
    return sum.z > 0.0 ? Vec2(Vec3(sum / sum.z)) : Vec2(0.0f);
}

}  // namespace mote
