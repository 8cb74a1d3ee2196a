// A shader embedded by the build.
#pragma once

#include <cstdint>
#include <span>

namespace brume::gpu {

struct ShaderCode {
  const char* name;  ///< File name, for messages: "march.comp".
  std::span<const std::uint32_t> words;
};

}  // namespace brume::gpu
