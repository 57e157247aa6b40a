#include "base/parallel.h"

#include <tbb/parallel_for.h>

namespace sfumato::base {

void parallelFor(long count, const std::function<void(long)>& body) {
  tbb::parallel_for(0L, count, body);
}

}  // namespace sfumato::base
