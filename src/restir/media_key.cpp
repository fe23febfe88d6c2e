#include "restir/media_key.h"

#include <algorithm>

#include "restir/same.h"

namespace mote {
namespace {

bool same(const MediaKey::Item& a, const MediaKey::Item& b)
{
    return a.density == b.density && a.density_scale == b.density_scale &&
           is_same(a.world_from_object, b.world_from_object);
}

}  // namespace

MediaKey media_key(const Media& media)
{
    MediaKey key;
    for (const Volume& volume : media.volumes) {
        key.items.push_back({volume.density, volume.density_scale, volume.world_from_object});
    }
    return key;
}

bool operator==(const MediaKey& a, const MediaKey& b)
{
    return std::equal(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(),
                      [](const MediaKey::Item& x, const MediaKey::Item& y) { return same(x, y); });
}

}  // namespace mote
