// The container of .nvdb files: segments of grids, each compressed or not.
#pragma once

#include <nanovdb/NanoVDB.h>

#include <cstddef>
#include <cstdint>
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

/// How files and grids may begin: "NanoVDB0" in all versions before 32.6, since then a digit of their own.
/// The layouts of all versions of 32 are alike (NanoVDB.h of each).
constexpr std::uint64_t kFirstMagic = NANOVDB_MAGIC_NUMBER;
constexpr std::uint64_t kGridMagic = kFirstMagic + (std::uint64_t{1} << 56);
constexpr std::uint64_t kFileMagic = kFirstMagic + (std::uint64_t{2} << 56);

/// Calls `use` with the bytes of each grid of a file. Throws Error (bad_input, resource_limit).
void for_each_nvdb_grid(const std::string& path, const grids::GridLimits& limits,
                        const std::function<void(const AlignedBytes&)>& use);

}  // namespace brume::vdb
