#pragma once

#include <vector>

#include "render/camera_pass.h"

namespace mote {

/// A camera ray of a pixel's pass, and the share of the pixel that it stands for.
struct PixelPart {
    Ray ray;
    float weight = 1.0f;
};

/// A pixel's pass divides into at most this many parts.
inline constexpr int most_parts = 4;

/// Divides a pixel's pass by what stratified rays through it see: rays that look alike are one
/// part, of which one ray is followed, any of them as likely as the others; so the parts' mean by
/// weight is the pixel's. The first part's ray is `main`, which must be camera_ray(inputs, key):
/// the ray of its stratum. One part where all rays look alike, and where inputs.split.parts has no
/// mark.
void split_pixel(const PassInputs& inputs, const PassKey& key, const Ray& main,
                 std::vector<PixelPart>& parts);

}  // namespace mote
