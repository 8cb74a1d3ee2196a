// The interface of a shader: what it binds, pushes and how large its workgroups are, read from its SPIR-V.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "gpu/functions.hpp"
#include "gpu/shader_code.hpp"

namespace brume::gpu {

struct ShaderInterface {
  struct Binding {
    std::uint32_t number;
    VkDescriptorType type;
    bool operator==(const Binding&) const = default;
  };
  std::vector<Binding> bindings;         ///< Descriptor set 0, ascending by number.
  std::uint32_t push_bytes = 0;          ///< Size of the push constants.
  std::array<std::uint32_t, 3> group{};  ///< Workgroup size; 0 in stages other than compute.

  /// The binding of a number, or null.
  const Binding* find(std::uint32_t number) const;
};

/// Reads the interface of a shader. Fails with bad_input where the shader declares what no pipeline offers:
/// another descriptor set, arrays of resources, resources other than buffers, sampled images and storage
/// images.
Result<ShaderInterface> reflect(const ShaderCode& shader);

/// The interface of a pipeline of several stages. Fails with bad_input where two stages disagree about a
/// binding.
Result<ShaderInterface> reflect(std::span<const ShaderCode> stages);

/// Whether a pipeline made for `offered` can run a shader of the interface `shader`: each of its bindings is
/// offered with the same type, and its push constants and workgroups are no larger and no different. Fails
/// with bad_input.
Result<void> check_fit(const ShaderInterface& shader, const ShaderInterface& offered);

/// "storage buffer", "sampled image" and so on, for messages.
std::string name_of(VkDescriptorType type);

}  // namespace brume::gpu
