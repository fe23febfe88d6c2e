#include "core/transform.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace mote {

Mat4d matrix(const Trs& trs)
{
    return glm::translate(Mat4d(1.0), trs.translate) * glm::mat4_cast(trs.rotate) *
           glm::scale(Mat4d(1.0), trs.scale);
}

Trs interpolate(const Trs& a, const Trs& b, double u)
{
    return {glm::mix(a.translate, b.translate, u), glm::slerp(a.rotate, b.rotate, u),
            glm::mix(a.scale, b.scale, u)};
}

Trs MovingTransform::at(float time) const
{
    if (keys.size() == 1) return keys[0];
    const double x =
        std::clamp(static_cast<double>(time), 0.0, 1.0) * static_cast<double>(keys.size() - 1);
    // A time that is no number is at no place, either.
    const size_t i = x >= 0.0 ? std::min(static_cast<size_t>(x), keys.size() - 2) : 0;
    return interpolate(keys[i], keys[i + 1], x - static_cast<double>(i));
}

Trs evaluate(const std::vector<TransformKey>& keys, double frame)
{
    if (keys.empty()) return {};
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), frame,
                         [](double f, const TransformKey& key) { return f < key.frame; });
    const TransformKey& b = after == keys.end() ? keys.back() : *after;
    const TransformKey& a = after == keys.begin() ? keys.front() : *(after - 1);
    const double span = b.frame - a.frame;
    const double u = span > 0.0 ? (frame - a.frame) / span : 0.0;
    const Vec3d angles = glm::radians(glm::mix(a.rotate, b.rotate, u));
    const Quatd rotate = glm::angleAxis(angles.z, Vec3d(0.0, 0.0, 1.0)) *
                         glm::angleAxis(angles.y, Vec3d(0.0, 1.0, 0.0)) *
                         glm::angleAxis(angles.x, Vec3d(1.0, 0.0, 0.0));
    return {glm::mix(a.translate, b.translate, u), rotate, glm::mix(a.scale, b.scale, u)};
}

MovingTransform over_shutter(const std::vector<TransformKey>& keys, double open, double close)
{
    MovingTransform out;
    out.keys = {evaluate(keys, open)};
    const bool moves =
        keys.size() > 1 && close > open && close > keys.front().frame && open < keys.back().frame;
    if (!moves) return out;
    // Steps are linear and spherical; turns about several axes and bends at keys are neither.
    const bool bends = std::any_of(keys.begin(), keys.end(), [&](const TransformKey& key) {
        return (key.frame > open && key.frame < close) || key.rotate != keys.front().rotate;
    });
    const int steps = bends ? 16 : 1;
    for (int i = 1; i <= steps; ++i) {
        out.keys.push_back(evaluate(keys, open + (close - open) * i / steps));
    }
    return out;
}

Affine to_affine(const Mat4d& m)
{
    return {Mat3(glm::dmat3(m)), Vec3(m[3])};
}

}  // namespace mote
