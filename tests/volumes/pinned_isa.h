#pragma once

#include <vector>

#include "volumes/walk_isa.h"

namespace mote::test {

/// Forms that this machine can run.
inline std::vector<Isa> supported_isas()
{
    std::vector<Isa> out;
    for (const Isa isa : {Isa::Scalar, Isa::Avx2, Isa::Avx512}) {
        if (is_supported(isa)) out.push_back(isa);
    }
    return out;
}

/// Pins the form for one test.
struct PinnedIsa {
    explicit PinnedIsa(Isa isa) { set_walk_isa(isa); }
    ~PinnedIsa() { set_walk_isa(std::nullopt); }
    PinnedIsa(const PinnedIsa&) = delete;
    PinnedIsa& operator=(const PinnedIsa&) = delete;
};

}  // namespace mote::test
