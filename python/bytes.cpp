#include "python/bytes.hpp"

#include <cstring>

namespace brume::python {

py::bytes bytes_of(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::vector<std::byte> copy_of(const py::bytes& bytes) {
  char* data = nullptr;
  Py_ssize_t size = 0;
  if (PyBytes_AsStringAndSize(bytes.ptr(), &data, &size) != 0) throw py::error_already_set();
  std::vector<std::byte> copy(static_cast<std::size_t>(size));
  if (size > 0) std::memcpy(copy.data(), data, copy.size());
  return copy;
}

}  // namespace brume::python
