// The container of .nvdb files: segments of grids, each compressed or not.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "grids/limits.hpp"

namespace brume::vdb {

/// Bytes aligned as NanoVDB requires, at first 0.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::size_t size);
  std::span<std::byte> bytes() { return {data_.get(), size_}; }
  std::span<const std::byte> bytes() const { return {data_.get(), size_}; }

 private:
  struct Free {
    void operator()(std::byte* data) const;
  };
  std::unique_ptr<std::byte, Free> data_;
  std::size_t size_;
};

/// Calls `use` with the bytes of each grid of a file. Throws Error (bad_input, resource_limit).
void for_each_nvdb_grid(const std::string& path, const grids::GridLimits& limits,
                        const std::function<void(const AlignedBytes&)>& use);

}  // namespace brume::vdb
