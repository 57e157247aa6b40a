// Loops over all cores.
#pragma once

#include <functional>

namespace sfumato::base {

// Calls body(i) for every i in [0, count), on all cores, in no stated order; returns when all are done.
// An exception of a body ends the loop and is thrown on.
void parallelFor(long count, const std::function<void(long)>& body);

}  // namespace sfumato::base
