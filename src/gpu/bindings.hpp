// Resources at the bindings of shaders, and the comparison with what a shader declares.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "core/frame_memory.hpp"
#include "gpu/resources.hpp"
#include "gpu/shader_interface.hpp"
#include "shared/shim.h"

namespace brume::gpu {

// Descriptor types by their GLSL names.
constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
constexpr VkDescriptorType kStored = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

/// A resource bound to a pass, and how the pass accesses it.
struct Binding {
  VkDescriptorType type = kBuffer;
  const Buffer* buffer = nullptr;
  const Image* image = nullptr;
  const Sampler* sampler = nullptr;
  bool reads = false, writes = false;
};
inline Binding read(const Buffer& buffer) {
  return {kBuffer, &buffer, nullptr, nullptr, true, false};
}
inline Binding write(const Buffer& buffer) {
  return {kBuffer, &buffer, nullptr, nullptr, false, true};
}
inline Binding read_write(const Buffer& buffer) {
  return {kBuffer, &buffer, nullptr, nullptr, true, true};
}
inline Binding uniform(const Buffer& buffer) {
  return {kUniform, &buffer, nullptr, nullptr, true, false};
}
inline Binding sampled(const Image& image, const Sampler& sampler) {
  return {kSampled, nullptr, &image, &sampler, true, false};
}
inline Binding stored(const Image& image) {
  return {kStored, nullptr, &image, nullptr, false, true};
}
inline Binding read_stored(const Image& image) {
  return {kStored, nullptr, &image, nullptr, true, false};
}
inline Binding read_write_stored(const Image& image) {
  return {kStored, nullptr, &image, nullptr, true, true};
}

/// A resource at a binding of a shader: `{shared::kBindPages, gpu::read(pages)}`.
struct BoundResource {
  shared::BindingIndex at;
  Binding resource;
};
using BoundResources = std::initializer_list<BoundResource>;

/// All that something has for shaders, such as a medium; each shader has bindings for a part of it.
using Bundle = std::span<const BoundResource>;
using Bundles = std::initializer_list<Bundle>;

/// `resources`, and from the bundles what the shader has bindings for and `resources` do not bind.
FrameVector<BoundResource> with_bundles(const ShaderInterface& interface, Bundles bundles,
                                        std::span<const BoundResource> resources, Allocator memory = {});

/// Compares bound resources with the interface of a shader: a binding that the shader lacks, one of another
/// type, one bound twice, or one without a resource. Empty when all match, else a message that names the
/// binding.
std::string binding_fault(const ShaderInterface& interface, std::span<const BoundResource> resources);

}  // namespace brume::gpu
