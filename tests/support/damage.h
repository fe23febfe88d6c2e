#pragma once

#include <cstring>
#include <string>

#include "core/rng.h"

namespace mote::test {

/// A file's bytes with damage number `trial`: a truncation, an extreme integer, or random bytes.
inline std::string damage(std::string bytes, uint32_t trial)
{
    Rng rng(trial, 0, Stream::Test, 0, 0);
    const auto somewhere = [&](size_t room) {
        return static_cast<size_t>(rng.uniform() * static_cast<float>(room));
    };
    const uint32_t kind = rng.next() % 4;
    if (kind == 0) bytes.resize(somewhere(bytes.size()));
    const size_t head = std::min<size_t>(bytes.size(), 4096);
    if (kind == 1 && head > 8) {
        static constexpr uint32_t extremes[] = {0xffffffffu, 0x7fffffffu, 0x80000000u, 0u,
                                                1u << 20u};
        const uint32_t value = extremes[rng.next() % 5];
        std::memcpy(&bytes[somewhere(head - 4)], &value, 4);
    }
    const int flips = kind == 2 ? 3 : kind == 3 ? 20 : 0;
    for (int i = 0; i < flips && !bytes.empty(); ++i) {
        bytes[somewhere(kind == 2 ? head : bytes.size())] = static_cast<char>(rng.next());
    }
    return bytes;
}

}  // namespace mote::test
