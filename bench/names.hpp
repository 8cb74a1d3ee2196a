// What brume bench can measure.
#pragma once

#include <string>
#include <vector>

namespace brume::bench {

/// The names of all benchmarks, in their order.
std::vector<std::string> names();

}  // namespace brume::bench
