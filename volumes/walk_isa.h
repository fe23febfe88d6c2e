#pragma once

#include <optional>
#include <string>

namespace mote {

/// Instruction sets that the batched ray walk has a form for. All give the same bits.
enum class Isa { Scalar, Avx2, Avx512 };

/// "scalar", "avx2", "avx512".
[[nodiscard]] const char* name_of(Isa isa);

/// Whether this machine can run it.
[[nodiscard]] bool is_supported(Isa isa);

/// The form in use: at first the best that this machine has.
[[nodiscard]] Isa walk_isa();

/// Pins the form for the whole process; empty: the best one again. Throws Error(Usage) if this
/// machine lacks it.
void set_walk_isa(std::optional<Isa> isa);

}  // namespace mote
