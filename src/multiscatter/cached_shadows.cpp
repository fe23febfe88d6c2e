#include "multiscatter/cached_shadows.h"

#include <algorithm>

namespace mote {

std::optional<float> CachedShadows::to_infinity(Vec3 x, Vec3 wi) const
{
    const auto rounded = [](float T) { return std::min(T, 1.0f); };
    for (const LightCaches::Distant& distant : caches_.distant) {
        if (distant.spot < 0 && distant.direction == wi) {
            return rounded(distant.map->transmittance(x));
        }
    }
    if (caches_.directions) return rounded(caches_.directions->transmittance(x, wi));
    return std::nullopt;
}

}  // namespace mote
