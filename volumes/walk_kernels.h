#pragma once

#include <cstddef>
#include <cstdint>

// Plain data and function pointers between the batched ray walk and its forms for one instruction
// set each. Nothing here may bring inline functions along: these files are compiled for machines
// that the rest of the program must not assume.

namespace mote {

/// Rays are stepped, and pieces integrated, in groups of this many at most.
inline constexpr size_t lane_group = 16;

/// The table of a BrickGrid.
struct BrickTable {
    const int32_t* entries;
    int32_t count[3];
};

/// Rays on their way through one grid, in its local coordinates (see LocalRay).
struct RayBlock {
    static constexpr size_t capacity = 256;

    alignas(64) float o[3][capacity];
    alignas(64) float d[3][capacity];     ///< voxels per metre
    alignas(64) float inv[3][capacity];   ///< 1 / d; 0 along axes that the ray does not move in
    alignas(64) float cell[3][capacity];  ///< position in the table
    alignas(64) float s[capacity];        ///< how far it has come [m]
    alignas(64) float s1[capacity];       ///< where it ends; below 0: done
};

/// Rays that are marched through one grid, in its local coordinates.
struct MarchBlock {
    static constexpr size_t capacity = 256;

    alignas(64) float o[3][capacity];
    alignas(64) float d[3][capacity];    ///< voxels per metre
    alignas(64) float inv[3][capacity];  ///< 1 / d; 0 along axes that the ray does not move in
    alignas(64) float s1[capacity];      ///< where it ends [m]; below 0: nowhere
    alignas(64) float step[capacity];    ///< > 0 [m]
    alignas(64) float limit[capacity];   ///< integral beyond which nothing matters
};

/// Pieces of rays through bricks, as they come out of the walk. Room for one group more than
/// `capacity`: whole vectors are stored.
struct PieceList {
    static constexpr size_t capacity = 1024;

    float p[3][capacity + lane_group];     ///< entry point in the brick, within [0,8]
    float s[capacity + lane_group];        ///< how far the ray had come there [m]
    float length[capacity + lane_group];   ///< > 0 [m]
    int32_t brick[capacity + lane_group];  ///< number in BrickGrid::values
    int32_t ray[capacity + lane_group];    ///< in the RayBlock
    int32_t cells[capacity + lane_group];  ///< that it crosses, up to rounding: 1 to 22
    size_t count;
};

/// A piece ready for integration. Cells are unit cubes, the brick is [0,8]^3.
struct BrickPiece {
    float p[3];
    float length;
    float d[3];
    int32_t brick;
};
static_assert(sizeof(BrickPiece) == 32);

/// What pieces hold up to the far end of each of their cells: row r is of the r-th cell, column i
/// of the i-th piece in order. Rows behind a piece's last cell repeat that, as far as they are
/// filled.
struct CellTable {
    static constexpr size_t most_cells = 22;  ///< of one piece: three axes of seven borders, and
                                              ///< the start
    static constexpr size_t capacity = 256;   ///< a multiple of lane_group

    float end[most_cells][capacity];       ///< distance from the piece's start [m]
    float integral[most_cells][capacity];  ///< [density units x m]
};

/// One form of the four loops. All forms give the same bits: each lane does the same IEEE
/// operations whatever runs beside it.
struct WalkKernels {
    /// Takes each of the first `count` rays (a multiple of lane_group) `steps` positions of the
    /// table further and appends its pieces through stored bricks, in order along each ray.
    /// Empty positions are jumped over as in BrickWalk. count * steps must fit the list.
    void (*step)(const BrickTable& table, RayBlock& rays, size_t count, int steps,
                 PieceList& pieces);
    /// integral[i] = closed-form integral of the trilinear density over piece i [density units x
    /// m], for every i in `order`, `count` of them, a multiple of lane_group. Indices may repeat.
    /// Quickest where pieces next to each other cross equally many cells.
    void (*integrate)(const float* values, const BrickPiece* pieces, const uint16_t* order,
                      size_t count, float* integral);
    /// The same, cell by cell: column i of the table is of piece order[i]. count is at most the
    /// table's capacity. A piece's last cell ends at its length.
    void (*tabulate)(const float* values, const BrickPiece* pieces, const uint16_t* order,
                     size_t count, CellTable& table);
    /// integral[i] = the same over the first `count` rays (a multiple of lane_group) by the
    /// midpoint rule, in steps of rays.step[i]; any value of at least rays.limit[i] where it
    /// exceeds that. lookups[i]: steps that looked anything up.
    void (*march)(const BrickTable& table, const float* values, const MarchBlock& rays,
                  size_t count, float* integral, float* lookups);
};

/// The form in use (walk_isa.h).
[[nodiscard]] const WalkKernels& walk_kernels();

extern const WalkKernels scalar_walk;
extern const WalkKernels avx2_walk;    ///< needs AVX2 and FMA
extern const WalkKernels avx512_walk;  ///< needs AVX-512 F, DQ, VL and BW

}  // namespace mote
