#include "multiscatter/cached_lights.h"

namespace mote {

CachedGuesses::CachedGuesses(const LightCaches& caches) : shadows(caches)
{
    // Cells may also choose glowing media, which are no lamps.
    for (const auto& bricks : caches.emissive) {
        if (bricks) return;
    }
    if (caches.cells) lights.emplace(*caches.cells);
}

}  // namespace mote
