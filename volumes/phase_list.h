#pragma once

#include <vector>

#include "volumes/tracking.h"

namespace mote {

[[nodiscard]] inline bool is_same_phase(const Phase& a, const Phase& b)
{
    return a.g == b.g && a.g_b == b.g_b && a.weight_b == b.weight_b;
}

/// The different phase functions of some media: equal ones share a number.
struct PhaseList {
    std::vector<Phase> phases;
    std::vector<int> of_volume;  ///< into phases

    [[nodiscard]] size_t size() const { return phases.size(); }
};

[[nodiscard]] inline PhaseList list_phases(const Media& media)
{
    PhaseList list;
    for (const Volume& volume : media.volumes) {
        size_t i = 0;
        while (i < list.phases.size() && !is_same_phase(list.phases[i], volume.phase)) ++i;
        if (i == list.phases.size()) list.phases.push_back(volume.phase);
        list.of_volume.push_back(static_cast<int>(i));
    }
    return list;
}

}  // namespace mote
