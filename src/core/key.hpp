// 128-bit hashes (XXH3) of what a file is made from. Not for security.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume {

/// Hashes a list of values. Each is hashed with its length, so that lists are equal only if all values are.
class KeyHasher {
 public:
  KeyHasher();
  KeyHasher(KeyHasher&&) noexcept = default;
  KeyHasher& operator=(KeyHasher&&) noexcept = default;
  ~KeyHasher();

  void add(std::span<const std::byte> bytes);
  void add(std::string_view text);
  /// The contents of a file of any size, a part at a time. `between` is called between parts and may throw.
  /// Fails with bad_input when it cannot be read or changes its length meanwhile.
  Result<void> add_file(const std::filesystem::path& file, const std::function<void()>& between = {});
  /// 32 hexadecimal digits.
  std::string digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace brume
