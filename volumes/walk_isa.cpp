#include "volumes/walk_isa.h"

#include <atomic>

#include "core/error.h"
#include "volumes/walk_kernels.h"

namespace mote {
namespace {

Isa best_isa()
{
    for (const Isa isa : {Isa::Avx512, Isa::Avx2}) {
        if (is_supported(isa)) return isa;
    }
    return Isa::Scalar;
}

std::atomic<Isa>& chosen()
{
    static std::atomic<Isa> isa = best_isa();
    return isa;
}

}  // namespace

const char* name_of(Isa isa)
{
    switch (isa) {
        case Isa::Avx2:
            return "avx2";
        case Isa::Avx512:
            return "avx512";
        case Isa::Scalar:
            break;
    }
    return "scalar";
}

bool is_supported(Isa isa)
{
    switch (isa) {
        case Isa::Avx2:
            return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
        case Isa::Avx512:
            return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw");
        case Isa::Scalar:
            break;
    }
    return true;
}

Isa walk_isa()
{
    return chosen().load(std::memory_order_relaxed);
}

const WalkKernels& walk_kernels()
{
    switch (walk_isa()) {
        case Isa::Avx512:
            return avx512_walk;
        case Isa::Avx2:
            return avx2_walk;
        case Isa::Scalar:
            break;
    }
    return scalar_walk;
}

void set_walk_isa(std::optional<Isa> isa)
{
    if (isa && !is_supported(*isa)) {
        throw Error(ExitCode::Usage,
                    std::string("this machine has no ") + name_of(*isa) + "; leave --isa at auto");
    }
    chosen().store(isa.value_or(best_isa()), std::memory_order_relaxed);
}

}  // namespace mote
