#include "multiscatter/cached_shadows.h"

#include <algorithm>
#include <cmath>

namespace mote {

std::optional<float> CachedShadows::to_infinity(Vec3 x, Vec3 wi) const
{
    const auto valid = [](float T) -> std::optional<float> {
        if (!std::isfinite(T)) return std::nullopt;
        return std::clamp(T, 0.0f, 1.0f);
    };
    for (const LightCaches::Distant& distant : caches_.distant) {
        if (distant.spot < 0 && distant.direction == wi) {
            return valid(distant.map->transmittance(x));
        }
    }
    if (caches_.directions) return valid(caches_.directions->transmittance(x, wi));
    return std::nullopt;
}

}  // namespace mote
