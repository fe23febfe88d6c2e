#include "scene/matrix_motion.h"

#include <algorithm>

namespace mote {
namespace {

Vec3d column_lengths(const Mat4d& matrix)
{
    return {glm::length(Vec3d(matrix[0])), glm::length(Vec3d(matrix[1])),
            glm::length(Vec3d(matrix[2]))};
}

constexpr double smallest_scale = 1e-9;

}  // namespace

bool is_flat(const Mat4d& matrix)
{
    const Vec3d scale = column_lengths(matrix);
    const double volume = std::abs(glm::determinant(glm::dmat3(matrix)));
    return !(std::min({scale.x, scale.y, scale.z}) > smallest_scale &&
             volume > 1e-9 * scale.x * scale.y * scale.z);
}

std::optional<Trs> decompose(const Mat4d& matrix)
{
    if (is_flat(matrix)) return std::nullopt;
    Trs trs;
    trs.translate = Vec3d(matrix[3]);
    trs.scale = column_lengths(matrix);
    glm::dmat3 rotation(matrix);
    if (glm::determinant(rotation) < 0.0) trs.scale.x = -trs.scale.x;
    for (int c = 0; c < 3; ++c) rotation[c] /= trs.scale[c];
    const glm::dmat3 square = glm::transpose(rotation) * rotation;
    const double shear =
        std::max({std::abs(square[0][1]), std::abs(square[0][2]), std::abs(square[1][2])});
    if (!(shear < 1e-4)) return std::nullopt;
    trs.rotate = glm::normalize(glm::quat_cast(rotation));
    return trs;
}

std::optional<MovingTransform> matrix_motion(const std::function<Mat4d(double)>& matrix_at,
                                             double open, double close, int steps)
{
    MovingTransform out;
    out.keys.clear();
    const int last = close > open ? steps : 0;
    for (int i = 0; i <= last; ++i) {
        const double share = last == 0 ? 0.0 : static_cast<double>(i) / last;
        std::optional<Trs> key = decompose(matrix_at(open + share * (close - open)));
        if (!key) return std::nullopt;
        // Of the two quaternions of a rotation, the one near the key before.
        if (i > 0 && glm::dot(key->rotate, out.keys.back().rotate) < 0.0) {
            key->rotate = -key->rotate;
        }
        out.keys.push_back(*key);
    }
    const bool is_still = std::all_of(out.keys.begin(), out.keys.end(),
                                      [&](const Trs& key) { return key == out.keys[0]; });
    if (is_still) out.keys.resize(1);
    return out;
}

}  // namespace mote
