// Packets: the classes Sender and Receiver of the module.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "python/calls.hpp"

namespace brume::python {

py::bytes bytes_of(std::span<const std::byte> bytes);
std::vector<std::byte> copy_of(const py::bytes& bytes);

/// After bind_world.
void bind_wire(py::module_& module);

}  // namespace brume::python
