#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "surfaces/mesh.h"

namespace mote {

/// Polygons that are not convex have at most this many corners: cost is quadratic, 0.2 s for these.
inline constexpr size_t max_concave_corners = 10'000;

/// Adds the triangles of a polygon, counterclockwise as it is: a fan around the first corner if it
/// is convex, else exactly its inside if it does not cross itself; edges that run there and back
/// (to holes) may coincide. One that is not flat is seen along its mean normal. Fewer than three
/// corners add nothing. Throws Error(Input), `place` in front, if it is not convex and has more
/// than max_concave_corners.
void add_face(Mesh& mesh, std::span<const uint32_t> corners, const std::string& place);

}  // namespace mote
