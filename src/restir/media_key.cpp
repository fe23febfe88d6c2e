#include "restir/media_key.h"

#include <algorithm>

namespace mote {
namespace {

bool same(const Trs& a, const Trs& b)
{
    return a.translate == b.translate && a.rotate == b.rotate && a.scale == b.scale;
}

bool same(const MediaKey::Item& a, const MediaKey::Item& b)
{
    const std::vector<Trs>& keys_a = a.world_from_object.keys;
    const std::vector<Trs>& keys_b = b.world_from_object.keys;
    return a.density == b.density && a.density_scale == b.density_scale &&
           std::equal(keys_a.begin(), keys_a.end(), keys_b.begin(), keys_b.end(),
                      [](const Trs& x, const Trs& y) { return same(x, y); });
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
