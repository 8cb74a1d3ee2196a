// Bytes between Python and C++.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "python/calls.hpp"

namespace brume::python {

py::bytes bytes_of(std::span<const std::byte> bytes);
std::vector<std::byte> copy_of(const py::bytes& bytes);

}  // namespace brume::python
