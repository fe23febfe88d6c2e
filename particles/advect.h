#pragma once

#include <algorithm>
#include <cmath>

#include "particles/lanes.h"

namespace mote {

/// Equal steps of age, the same for all particles of an emitter, so that a particle's path does
/// not depend on the frame that asks for it.
struct AdvectSteps {
    int count = 16;    ///< steps to the end of life
    float dt = 0.25f;  ///< [s]
};

/// Steps that resolve eddies of this size and speed, at most `most` so that the cost is bounded.
[[nodiscard]] inline AdvectSteps choose_steps(float lifetime, float eddy_speed, float eddy_size,
                                              float most)
{
    const float wanted = 6.0f * lifetime * eddy_speed / eddy_size;
    const float count = std::clamp(std::ceil(wanted), 8.0f, most);
    return {static_cast<int>(count), lifetime / count};
}

/// Moves points from birth to `age` [s] by Adams-Bashforth 2: one evaluation per step, velocity
/// extrapolated linearly inside it. `v` is the exact derivative of the resulting path by age.
/// Calls velocity_at(step, p, u) with the points at age step * dt.
template <class VelocityAt>
void advect(const AdvectSteps& steps, const Lanes& age, const VelocityAt& velocity_at, Lanes3& p,
            Lanes3& v)
{
    float oldest = 0.0f;
    for (const float a : age.v) oldest = std::max(oldest, a);
    const float inv_dt = 1.0f / steps.dt;
    Lanes3 u;
    Lanes3 previous;
    for (int step = 0; step < steps.count; ++step) {
        const float begin = static_cast<float>(step) * steps.dt;
        if (step > 0 && begin > oldest) break;
        velocity_at(step, p, u);
        if (step == 0) previous = u;
        const auto move = [&](float& x, float& v_x, float u_x, float& previous_x, float a) {
            const float s = std::min(a - begin, steps.dt);
            const float slope = (u_x - previous_x) * inv_dt;
            const float moved = x + s * (u_x + 0.5f * slope * s);
            const float v_moved = u_x + slope * s;
            const bool is_alive = s >= 0.0f;  // lanes that are younger have arrived already
            x = is_alive ? moved : x;
            v_x = is_alive ? v_moved : v_x;
            previous_x = u_x;
        };
        for (size_t i = 0; i < lane_count; ++i) move(p.x[i], v.x[i], u.x[i], previous.x[i], age[i]);
        for (size_t i = 0; i < lane_count; ++i) move(p.y[i], v.y[i], u.y[i], previous.y[i], age[i]);
        for (size_t i = 0; i < lane_count; ++i) move(p.z[i], v.z[i], u.z[i], previous.z[i], age[i]);
    }
}

}  // namespace mote
