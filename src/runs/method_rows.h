#pragma once

#include <vector>

#include "runs/methods.h"

namespace mote {

/// The rows of the estimators; all_methods() holds them in this order.
[[nodiscard]] std::vector<Method> path_methods();
[[nodiscard]] std::vector<Method> restir_methods();
[[nodiscard]] Method march_method();

}  // namespace mote
