#pragma once

#include <optional>
#include <vector>

namespace mote {

/// One value of a keyed thing at a frame: linear between the keys that give it, held outside them;
/// `without_keys` where none does. Keys have a `frame`, ascending.
template <class Key, class T>
[[nodiscard]] T evaluate_key(const std::vector<Key>& keys, std::optional<T> Key::*member,
                             const T& without_keys, double frame)
{
    const Key* before = nullptr;
    const Key* after = nullptr;
    for (const Key& key : keys) {
        if (!(key.*member)) continue;
        if (key.frame <= frame) before = &key;
        if (key.frame > frame && !after) after = &key;
    }
    if (!before && !after) return without_keys;
    if (!before) return *(after->*member);
    if (!after) return *(before->*member);
    const double u = (frame - before->frame) / (after->frame - before->frame);
    return *(before->*member) * (1.0 - u) + *(after->*member) * u;
}

}  // namespace mote
