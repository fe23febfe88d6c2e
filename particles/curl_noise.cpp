#include "particles/curl_noise.h"

#include <cmath>

#include "core/rng.h"

namespace mote {

namespace {

constexpr int octave_count = 4;
constexpr int waves_per_octave = CurlNoise::mode_count / octave_count;
constexpr float two_pi = 2.0f * pi;

/// Wave directions spread evenly over the half sphere: k and -k are the same wave.
Vec3 wave_direction(int wave, Rng& rng)
{
    const float z = (static_cast<float>(wave) + rng.uniform()) / waves_per_octave;
    const float phi = two_pi * rng.uniform();
    const float r = std::sqrt(std::max(0.0f, 1.0f - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

double wrap_turns(double x)
{
    return x - std::floor(x);
}

}  // namespace

CurlNoise make_curl_noise(const CurlNoiseParams& params, double time)
{
    CurlNoise noise{};
    Rng rng(params.seed, 0, Stream::Emitter, 0xc0711u, 0);
    float energy = 0.0f;
    for (int octave = 0; octave < octave_count; ++octave) {
        const float size = std::ldexp(params.size, -octave);
        const float strength = std::cbrt(std::ldexp(1.0f, -octave));
        const Mat3 turn = make_frame(wave_direction(0, rng));  // octaves must not line up
        for (int wave = 0; wave < waves_per_octave; ++wave) {
            const int m = octave * waves_per_octave + wave;
            const Vec3 direction = turn * wave_direction(wave, rng);
            const Vec3 k = direction * ((0.75f + 0.5f * rng.uniform()) / (2.0f * size));
            const float angle = two_pi * rng.uniform();
            const Mat3 frame = make_frame(direction);
            const Vec3 a = strength * (std::cos(angle) * frame[0] + std::sin(angle) * frame[1]);
            const float churn = 0.5f * params.speed * strength / size * (rng.uniform() - 0.5f);
            const float rate = churn - glm::dot(k, params.drift);
            noise.kx[m] = k.x;
            noise.ky[m] = k.y;
            noise.kz[m] = k.z;
            noise.rate[m] = rate;
            noise.phase[m] =
                static_cast<float>(wrap_turns(double{rng.uniform()} + double{rate} * time));
            noise.ax[m] = a.x;
            noise.ay[m] = a.y;
            noise.az[m] = a.z;
            energy += 0.5f * glm::dot(a, a);  // mean square of a sine
        }
    }
    const float scale = params.speed / std::sqrt(energy);
    for (int m = 0; m < CurlNoise::mode_count; ++m) {
        noise.ax[m] *= scale;
        noise.ay[m] *= scale;
        noise.az[m] *= scale;
    }
    return noise;
}

void eval_curl_noise(const CurlNoise& noise, const Lanes3& p, const Lanes& t, Lanes3& velocity)
{
    Lanes3 sum;
    for (int m = 0; m < CurlNoise::mode_count; ++m) {
        for (size_t i = 0; i < lane_count; ++i) {
            const float turns = noise.kx[m] * p.x[i] + noise.ky[m] * p.y[i] + noise.kz[m] * p.z[i] +
                                noise.rate[m] * t[i] + noise.phase[m];
            const float wave = sin_turns(turns);
            sum.x[i] += noise.ax[m] * wave;
            sum.y[i] += noise.ay[m] * wave;
            sum.z[i] += noise.az[m] * wave;
        }
    }
    velocity = sum;
}

void eval_curl_noise_with_rate(const CurlNoise& noise, const Lanes3& p, const Lanes3& motion,
                               Lanes3& velocity, Lanes3& velocity_rate)
{
    Lanes3 sum;
    Lanes3 sum_rate;
    for (int m = 0; m < CurlNoise::mode_count; ++m) {
        for (size_t i = 0; i < lane_count; ++i) {
            const float kx = noise.kx[m];
            const float ky = noise.ky[m];
            const float kz = noise.kz[m];
            const float turns = kx * p.x[i] + ky * p.y[i] + kz * p.z[i] + noise.phase[m];
            const float turns_rate =
                kx * motion.x[i] + ky * motion.y[i] + kz * motion.z[i] + noise.rate[m];
            const float wave = sin_turns(turns);
            const float wave_rate = two_pi * turns_rate * sin_turns(turns + 0.25f);
            sum.x[i] += noise.ax[m] * wave;
            sum.y[i] += noise.ay[m] * wave;
            sum.z[i] += noise.az[m] * wave;
            sum_rate.x[i] += noise.ax[m] * wave_rate;
            sum_rate.y[i] += noise.ay[m] * wave_rate;
            sum_rate.z[i] += noise.az[m] * wave_rate;
        }
    }
    velocity = sum;
    velocity_rate = sum_rate;
}

}  // namespace mote
