#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/buffer2d.h"
#include "scene/scene.h"

namespace mote {

/// A rectangle on the film [px].
struct FilmBox {
    Vec2 lo{0.0f};
    Vec2 hi{-1.0f};

    [[nodiscard]] bool is_empty() const { return !(lo.x < hi.x && lo.y < hi.y); }
    [[nodiscard]] Vec2 extent() const { return hi - lo; }
};

/// Where the camera is while the shutter is open, often enough for film_box.
[[nodiscard]] std::vector<Trs> shutter_poses(const Camera& camera);

/// Where rays may meet a sphere or a quad on the film, whatever point of the lens they leave, and
/// when (`poses`: shutter_poses). Empty if that is nowhere; none for what is wide, or not all in
/// front of the camera. Cost: 40 ns per pose.
[[nodiscard]] std::optional<FilmBox> film_box(const Camera& camera, std::span<const Trs> poses,
                                              const Light& light);

/// Lamps that are narrow on the film, by the pixels that they may be seen in.
struct LampLists {
    static constexpr uint32_t most = 8;  ///< lamps of a pixel; where there are more, none is listed

    int width = 0;
    std::vector<FilmBox> boxes;   ///< per light of the scene; empty: not listed anywhere
    std::vector<uint32_t> first;  ///< per pixel, into `lamps`, and their end; empty: no lists
    std::vector<uint32_t> lamps;

    [[nodiscard]] std::span<const uint32_t> at(int x, int y) const
    {
        if (first.empty()) return {};
        const auto i = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
        return std::span(lamps).subspan(first[i], first[i + 1] - first[i]);
    }
};

/// Lists lamps by their boxes, one per light of the scene; pixels with too many get `crowded` in
/// the map. Cost: 10 ns per lamp and pixel of its box.
[[nodiscard]] LampLists list_lamps(std::vector<FilmBox> boxes, uint8_t crowded,
                                   Buffer2D<uint8_t>& map);

}  // namespace mote
