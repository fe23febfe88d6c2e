#pragma once

#include "restir/direction_transmittance.h"

namespace mote {

/// Media coarser than a scene's, for rays that guess how much light of an environment comes, and
/// how far to trust them.
struct LightGuess {
    Media media;         ///< empty: rays through coarser media are not worth it
    float slope = 0.0f;  ///< of correction_chance()

    [[nodiscard]] bool empty() const { return media.empty(); }
};

/// The chance with which a ray that a guess gives optical depth `tau` is walked exactly, too: what
/// the guess may be wrong by, slope * sqrt(tau) * exp(-tau), kept above 0.
[[nodiscard]] float correction_chance(float slope, float tau);

/// Chooses between no coarse media, those that `directions` were walked through, and the same once
/// more halved, by walking some hundred rays through each: coarser ones are cheaper, but their
/// error must stay near that of `directions`, or the exact rays that correct them cost more than is
/// saved. The same for the same arguments. Cost: 3 ms, and that of halving.
[[nodiscard]] LightGuess make_light_guess(const Media& media,
                                          const DirectionTransmittance& directions);

}  // namespace mote
