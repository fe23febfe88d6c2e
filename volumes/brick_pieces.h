#pragma once

#include <cstddef>
#include <cstdint>

namespace mote {

/// A ray's piece through one brick, in the brick's own coordinates (cells are unit cubes, the brick
/// is [0,8]^3). Plain data: it crosses into files that are compiled for other instruction sets.
struct BrickPiece {
    float p[3];     ///< entry point, within [0,8]
    float length;   ///< of the parameter [m], >= 0
    float d[3];     ///< voxels per metre
    int32_t brick;  ///< number in BrickGrid::values
};
static_assert(sizeof(BrickPiece) == 32);

/// Pieces are taken in groups of this many; `order` below is padded to whole groups.
inline constexpr size_t piece_group = 16;

/// integral[i] = closed-form integral of the trilinear density over piece i [density units x m],
/// for every i in `order`, `count` of them, a multiple of piece_group. Indices may repeat. Groups
/// are quickest when their pieces cross equally many cells. Every form gives the same bits: each
/// lane does the same IEEE operations whatever runs beside it.
using IntegratePieces = void (*)(const float* values, const BrickPiece* pieces,
                                 const uint16_t* order, size_t count, float* integral);

void integrate_pieces_scalar(const float* values, const BrickPiece* pieces, const uint16_t* order,
                             size_t count, float* integral);
/// Needs AVX2 and FMA.
void integrate_pieces_avx2(const float* values, const BrickPiece* pieces, const uint16_t* order,
                           size_t count, float* integral);
/// Needs AVX-512 F, DQ, VL and BW.
void integrate_pieces_avx512(const float* values, const BrickPiece* pieces, const uint16_t* order,
                             size_t count, float* integral);

}  // namespace mote
