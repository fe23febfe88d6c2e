#pragma once

#include <bitset>
#include <span>
#include <string>
#include <vector>

namespace mote {

/// An image layer that may be asked for beside RGBA ("arbitrary output variable").
enum class Aov {
    Z,
    VolumeZ,
    Albedo,
    Motion,
    Variance,
    Samples,
    VolumeDirect,
    VolumeIndirect,
    VolumeEmission,
    Background,
    Transmittance,
    OpticalDepth,
    Restir,
    Cost,
    Work,
    Direct,
    Indirect,
    Emission,
    Normal,
    Position,
    MaterialId,
};
inline constexpr size_t aov_count = 21;

/// One row of the table of layers.
struct AovInfo {
    Aov aov;
    std::string name;                   ///< as in output.aovs
    std::vector<std::string> channels;  ///< names in the file
    bool always_float;                  ///< never stored as half: depths, variances, counts
    std::string doc;                    ///< one sentence with the unit
};

/// Every layer, in the order of the enum.
[[nodiscard]] std::span<const AovInfo> aov_table();

/// Depth written where nothing was hit; float only, as half ends at 65504.
inline constexpr float background_depth = 1e10f;

/// The layers asked for. Those not in it cost nothing.
class AovSet {
  public:
    void add(Aov aov) { bits_.set(static_cast<size_t>(aov)); }
    [[nodiscard]] bool has(Aov aov) const { return bits_.test(static_cast<size_t>(aov)); }
    /// Whether the scene must be prepared with velocity grids and the next frame's transforms.
    [[nodiscard]] bool needs_motion() const { return has(Aov::Motion); }
    /// Whether any of them tells of the first surface on the camera ray, media in front or not.
    [[nodiscard]] bool needs_first_surface() const
    {
        return has(Aov::Normal) || has(Aov::Position) || has(Aov::MaterialId);
    }
    /// Whether any of them tells of first collisions.
    [[nodiscard]] bool needs_first_collision() const
    {
        return has(Aov::Z) || has(Aov::VolumeZ) || has(Aov::Albedo) || has(Aov::Motion);
    }

  private:
    std::bitset<aov_count> bits_;
};

/// The set of the named layers. Throws Error(Input) for an unknown name, with the nearest known
/// one.
[[nodiscard]] AovSet parse_aovs(const std::vector<std::string>& names);

}  // namespace mote
