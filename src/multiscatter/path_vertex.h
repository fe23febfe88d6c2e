#pragma once

#include "reference/aimed_light.h"

namespace mote {

/// Light that arrives at a vertex: the sum over a vertex's arrivals of phase(wo, wi) E is an
/// unbiased estimate of what it scatters towards wo, whatever wo is, less what is known of that
/// (PathSharing::known): E may be below 0.
struct IncidentSample {
    Vec3 wi{0.0f};     ///< [unit]
    Spectrum E{0.0f};  ///< radiance over the density of wi
};

/// A vertex of paths that are shared.
struct PathVertex {
    /// A shadow ray's, that of the ray which goes on, and what is behind that, or was sought.
    static constexpr int most_arrivals = 2 + AimedLights::most;

    Vec3 x{0.0f};                  ///< world [m]
    const Phase* phase = nullptr;  ///< how it scatters; null on surfaces
    int surface = -1;              ///< into the level's surfaces; -1: in a medium
    Spectrum weight{1.0f};         ///< of what it scatters: the albedo in a medium, and of first
                                   ///< vertices their share of the pixel's light
    Vec3 wo{0.0f};                 ///< with `lobe`, how directions are proposed: of first vertices
    Phase lobe;                    ///< as it scatters, else for all together that look at it
    float drawn = 1.0f;            ///< of first ones: times as often as by what collides there
    /// Paths do; places that were drawn around lamps are looked at for lamps' light alone.
    bool goes_on = true;
    float carried = 1.0f;  ///< weight in the image of the path that has found it
    /// The vertex before; of first ones the pixel of the tile; -1: none, drawn around a lamp.
    int from = 0;
    /// Of the transmittance to the vertex before: log of assumed over true.
    float log_excess = 0.0f;
    /// Of first vertices: what is known of the light that their own paths have found, over the
    /// number of these that was to be expected.
    Spectrum known{0.0f};
    IncidentSample arrivals[most_arrivals];
    int arrival_count = 0;

    void add(const IncidentSample& arrival)
    {
        if (arrival.E != Spectrum(0.0f)) arrivals[arrival_count++] = arrival;
    }
};

}  // namespace mote
