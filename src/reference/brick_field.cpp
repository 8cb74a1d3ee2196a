#include "reference/brick_field.hpp"

#include <cstddef>
#include <glm/gtc/packing.hpp>

namespace brume::reference {

const std::array<float, 65536>& half_values() {
  static const std::array<float, 65536> values = [] {
    std::array<float, 65536> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = glm::unpackHalf1x16(static_cast<std::uint16_t>(i));
    return all;
  }();
  return values;
}

template <int Components>
BrickField<Components>::BrickField(const volume::SparseVolume& volume) {
  // The box around all bricks.
  Box<int> box{glm::ivec3(1 << 30), glm::ivec3(-(1 << 30))};
  const auto include = [&](glm::ivec3 brick) { box = united(box, {brick, brick + 1}); };
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.in_use(slot)) include(volume.brick_of(slot));
  for (const volume::UniformBrick& brick : volume.uniform_bricks()) include(brick.at);
  if (box.empty()) return;

  low_ = box.low;
  size_ = box.high - box.low;
  const glm::u64vec3 size(size_);
  if (size.x * size.y * size.z > (std::uint64_t{1} << 28))
    throw Error(
        ErrorCode::resource_limit,
        "the reference renderer holds volumes within 5,000 voxels along each axis; this one's voxels are too "
        "far apart");
  bricks_.resize(size.x * size.y * size.z);
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.in_use(slot))
      bricks_[index(volume.brick_of(slot) - low_)].texels =
          reinterpret_cast<const std::uint16_t*>(volume.channel(volume::ChannelId{0}, slot).data());
  for (const volume::UniformBrick& brick : volume.uniform_bricks())
    bricks_[index(brick.at - low_)].uniform = brick.texel;
}

template class BrickField<1>;
template class BrickField<2>;
template class BrickField<4>;

}  // namespace brume::reference
