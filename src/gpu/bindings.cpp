#include "gpu/bindings.hpp"

#include <algorithm>

namespace brume::gpu {

FrameVector<BoundResource> with_bundles(const ShaderInterface& interface, Bundles bundles,
                                        std::span<const BoundResource> resources, Allocator memory) {
  FrameVector<BoundResource> bound(memory);
  bound.reserve(interface.bindings.size() + resources.size());
  bound.assign(resources.begin(), resources.end());
  const auto is_bound = [&](const BoundResource& one) {
    return std::ranges::any_of(resources,
                               [&](const BoundResource& own) { return own.at.number == one.at.number; });
  };
  for (const Bundle& bundle : bundles)
    for (const BoundResource& one : bundle)
      if (interface.find(one.at.number) && !is_bound(one)) bound.push_back(one);
  return bound;
}

std::string binding_fault(const ShaderInterface& interface, std::span<const BoundResource> resources) {
  const auto name = [](shared::BindingIndex at) {
    return std::string(at.name) + " (binding " + std::to_string(at.number) + ")";
  };
  for (const BoundResource& bound : resources) {
    const ShaderInterface::Binding* binding = interface.find(bound.at.number);
    if (!binding) return "has no " + name(bound.at);
    if (binding->type != bound.resource.type)
      return name(bound.at) + " is a " + name_of(binding->type) + ", not a " + name_of(bound.resource.type);
  }
  for (const ShaderInterface::Binding& binding : interface.bindings) {
    const auto binds = [&](const BoundResource& bound) { return bound.at.number == binding.number; };
    const auto count = std::count_if(resources.begin(), resources.end(), binds);
    if (count != 1)
      return "binding " + std::to_string(binding.number) + ", a " + name_of(binding.type) +
             (count == 0 ? ", has no resource" : ", has more than one resource");
  }
  return {};
}

}  // namespace brume::gpu
