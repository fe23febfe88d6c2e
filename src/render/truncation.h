#pragma once

#include <cstdint>

namespace mote {

/// What max_bounces left out of an image.
struct Truncation {
    int64_t paths = 0;  ///< cut though they could have gone on
    /// Sum of the weights that they had left (at most, where paths are not followed one by one).
    /// Over the number of all paths: by how much more the mean pixel could be lit, if light of
    /// radiance 1 came from everywhere.
    double weight = 0.0;

    void add(float cut)
    {
        if (!(cut > 0.0f)) return;
        ++paths;
        weight += static_cast<double>(cut);
    }
    void add(const Truncation& other)
    {
        paths += other.paths;
        weight += other.weight;
    }
};

}  // namespace mote
