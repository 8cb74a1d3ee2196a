// Buffers, images and samplers. Buffers and images track their last use, from which barriers are derived.
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <optional>

#include "gpu/context.hpp"
#include "gpu/recorded.hpp"

namespace brume::gpu {

/// The last accesses to a resource. A resource is used by one recording at a time.
struct LastUse {
  VkPipelineStageFlags2 write_stages = 0;  ///< Stages of the last write or layout change.
  VkAccessFlags2 write_access = 0;
  VkPipelineStageFlags2 read_stages = 0;     ///< Stages that have read since that write.
  VkPipelineStageFlags2 visible_stages = 0;  ///< Stages to which that write is already visible.
  VkAccessFlags2 visible_access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

class Buffer {
 public:
  Buffer() = default;
  /// `bytes` > 0. Throws resource_limit when there is no memory.
  Buffer(Context& context, VkDeviceSize bytes, VkBufferUsageFlags usage, MemoryUse use = MemoryUse::device);
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  VkBuffer handle() const { return handle_; }
  VkDeviceSize size() const { return size_; }
  /// For upload and readback memory; otherwise null.
  std::byte* mapped() const { return range_.mapped; }

  mutable Recorded<LastUse> last_use;

 private:
  Context* context_ = nullptr;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  Memory::Range range_;
};

/// Ensures that a storage buffer has at least this size, growing in powers of two; true when it was
/// recreated, with undefined contents. Throws resource_limit when the device does not support a buffer of
/// that size.
bool grow(Context& context, Buffer& buffer, VkDeviceSize bytes);
/// Replaces buffers that grow by the smallest ones. Throws resource_limit.
void shrink(Context& context, std::initializer_list<Buffer*> buffers);

struct ImageInfo {
  VkFormat format = VK_FORMAT_UNDEFINED;
  glm::uvec3 size{1};  ///< Texels; z > 1 makes it three-dimensional.
  bool three_dimensional = false;
  std::uint32_t layers = 1;  ///< > 1: a 2D array.
  std::uint32_t mip_levels = 1;
  VkImageUsageFlags usage = 0;
};

/// An image that shaders store and sample, and the CPU reads back: 2D, or 3D. `more`: usages beside these.
ImageInfo storage_image(const glm::uvec2& size, VkFormat format, VkImageUsageFlags more = 0);
ImageInfo storage_image_3d(const glm::uvec3& size, VkFormat format, VkImageUsageFlags more = 0);
/// An image that is uploaded, for shaders to sample: 2D, or 3D.
ImageInfo sampled_image(const glm::uvec2& size, VkFormat format, VkImageUsageFlags more = 0);
ImageInfo sampled_image_3d(const glm::uvec3& size, VkFormat format, VkImageUsageFlags more = 0);

/// An image of a host, lent for as long as the Image is used.
struct LentImage {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;  ///< For one aspect, or for what is rendered into.
  VkFormat format = VK_FORMAT_UNDEFINED;
  glm::uvec2 size_px{1};
  /// When the image is lent, and again afterwards. The host makes its own writes visible before, and waits
  /// for the accesses to the image afterwards.
  VkImageLayout layout = VK_IMAGE_LAYOUT_GENERAL;
};

class Image {
 public:
  Image() = default;
  /// Throws resource_limit when there is no memory.
  Image(Context& context, const ImageInfo& info);
  /// Owns nothing.
  explicit Image(const LentImage& lent);
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }
  const ImageInfo& info() const { return info_; }
  VkImageAspectFlags aspect() const;
  /// Images that shaders write remain in GENERAL; others are read in SHADER_READ_ONLY.
  VkImageLayout sampled_layout() const {
    if (lent_layout_ != VK_IMAGE_LAYOUT_UNDEFINED) return lent_layout_;
    return info_.usage & VK_IMAGE_USAGE_STORAGE_BIT ? VK_IMAGE_LAYOUT_GENERAL
                                                    : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  }

  mutable Recorded<LastUse> last_use;

 private:
  Context* context_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  ImageInfo info_;
  VkImageLayout lent_layout_ = VK_IMAGE_LAYOUT_UNDEFINED;  // LentImage::layout
  Memory::Range range_;
};

/// A view of one layer of an image, to render into.
class LayerView {
 public:
  LayerView(Context& context, const Image& image, std::uint32_t layer);
  LayerView(LayerView&& other) noexcept;
  LayerView& operator=(LayerView&&) = delete;
  ~LayerView();
  VkImageView handle() const { return handle_; }

 private:
  Context* context_ = nullptr;
  VkImageView handle_ = VK_NULL_HANDLE;
};

struct SamplerInfo {
  VkFilter filter = VK_FILTER_LINEAR;
  VkSamplerAddressMode address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  bool mipmaps = false;
  bool compare = false;  ///< A depth comparison, reverse depth: lit where the reference >= the stored depth.
  float anisotropy = 1;  ///< Most samples along the longer axis of a minified pixel, in [1, 16].
  std::optional<VkSamplerAddressMode> address_v = {};  ///< Along v, if it differs from `address`.
};

class Sampler {
 public:
  Sampler(Context& context, const SamplerInfo& info);
  ~Sampler();
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;
  VkSampler handle() const { return handle_; }

 private:
  Context& context_;
  VkSampler handle_ = VK_NULL_HANDLE;
};

}  // namespace brume::gpu
