#include "gpu/resources.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include "core/error.hpp"

namespace brume::gpu {

Buffer::Buffer(Context& context, VkDeviceSize bytes, VkBufferUsageFlags usage, MemoryUse use)
    : context_(&context), size_(bytes) {
  BRUME_ASSERT(bytes > 0, "a buffer of no bytes");
  context.expect_retirement();
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = bytes;
  info.usage = usage;
  const Functions& vk = context.vk();
  check(vk.CreateBuffer(context.device(), &info, vk.allocator, &handle_), "vkCreateBuffer");
  try {
    VkMemoryRequirements needs{};
    vk.GetBufferMemoryRequirements(context.device(), handle_, &needs);
    range_ = context.memory().allocate(needs, use, false);
    check(vk.BindBufferMemory(context.device(), handle_, range_.memory, range_.offset), "vkBindBufferMemory");
  } catch (...) {
    context.memory().free(range_);
    vk.DestroyBuffer(context.device(), handle_, vk.allocator);
    throw;
  }
}

bool grow(Context& context, Buffer& buffer, VkDeviceSize bytes) {
  if (buffer && buffer.size() >= bytes) return false;
  const VkDeviceSize most = context.limits().maxStorageBufferRange;
  if (bytes > most) {
    throw Error(ErrorCode::resource_limit, "the smoke needs a buffer of " + std::to_string(bytes) +
                                               " bytes, the device supports " + std::to_string(most) +
                                               "; use larger voxels or less smoke");
  }
  buffer = Buffer(context, std::min(std::bit_ceil(std::max<VkDeviceSize>(bytes, 256)), most),
                  VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT |
                      VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  return true;
}

void shrink(Context& context, std::initializer_list<Buffer*> buffers) {
  for (Buffer* buffer : buffers) {
    *buffer = Buffer();
    grow(context, *buffer, 1);
  }
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(context_, other.context_);
  std::swap(handle_, other.handle_);
  std::swap(size_, other.size_);
  std::swap(range_, other.range_);
  std::swap(last_use, other.last_use);
  return *this;
}

Buffer::~Buffer() {
  if (handle_) context_->retire({.buffer = handle_, .range = range_});
}

namespace {

VkImageViewCreateInfo view_info(const Image& image, VkImageViewType type, std::uint32_t layer,
                                std::uint32_t layers) {
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image.handle();
  info.viewType = type;
  info.format = image.info().format;
  info.subresourceRange = {image.aspect(), 0, image.info().mip_levels, layer, layers};
  return info;
}

}  // namespace

ImageInfo storage_image(const glm::uvec2& size, VkFormat format, VkImageUsageFlags more) {
  ImageInfo info = storage_image_3d({size, 1}, format, more);
  info.three_dimensional = false;
  return info;
}

ImageInfo storage_image_3d(const glm::uvec3& size, VkFormat format, VkImageUsageFlags more) {
  ImageInfo info;
  info.format = format;
  info.size = size;
  info.three_dimensional = true;
  info.usage =
      VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | more;
  return info;
}

ImageInfo sampled_image(const glm::uvec2& size, VkFormat format, VkImageUsageFlags more) {
  ImageInfo info = sampled_image_3d({size, 1}, format, more);
  info.three_dimensional = false;
  return info;
}

ImageInfo sampled_image_3d(const glm::uvec3& size, VkFormat format, VkImageUsageFlags more) {
  ImageInfo info;
  info.format = format;
  info.size = size;
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | more;
  return info;
}

Image::Image(Context& context, const ImageInfo& wanted) : context_(&context), info_(wanted) {
  context.expect_retirement();
  // The image.
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.imageType = wanted.three_dimensional ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = wanted.format;
  info.extent = {wanted.size.x, wanted.size.y, wanted.size.z};
  info.mipLevels = wanted.mip_levels;
  info.arrayLayers = wanted.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = wanted.usage;
  const Functions& vk = context.vk();
  check(vk.CreateImage(context.device(), &info, vk.allocator, &handle_), "vkCreateImage");
  // Its memory and view.
  try {
    VkMemoryRequirements needs{};
    vk.GetImageMemoryRequirements(context.device(), handle_, &needs);
    range_ = context.memory().allocate(needs, MemoryUse::device, true);
    check(vk.BindImageMemory(context.device(), handle_, range_.memory, range_.offset), "vkBindImageMemory");
    const VkImageViewType type = wanted.three_dimensional ? VK_IMAGE_VIEW_TYPE_3D
                                 : wanted.layers > 1      ? VK_IMAGE_VIEW_TYPE_2D_ARRAY
                                                          : VK_IMAGE_VIEW_TYPE_2D;
    const auto view = view_info(*this, type, 0, wanted.layers);
    check(vk.CreateImageView(context.device(), &view, vk.allocator, &view_), "vkCreateImageView");
  } catch (...) {
    context.memory().free(range_);
    vk.DestroyImage(context.device(), handle_, vk.allocator);
    throw;
  }
}

Image::Image(const LentImage& lent) : handle_(lent.handle), view_(lent.view), lent_layout_(lent.layout) {
  info_.format = lent.format;
  info_.size = {lent.size_px, 1};
  LastUse lent_use;
  lent_use.layout = lent.layout;
  last_use = Recorded(lent_use);
}

Image::Image(Image&& other) noexcept {
  *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
  std::swap(context_, other.context_);
  std::swap(handle_, other.handle_);
  std::swap(view_, other.view_);
  std::swap(info_, other.info_);
  std::swap(lent_layout_, other.lent_layout_);
  std::swap(range_, other.range_);
  std::swap(last_use, other.last_use);
  return *this;
}

Image::~Image() {
  if (handle_ && context_) context_->retire({.image = handle_, .view = view_, .range = range_});
}

VkImageAspectFlags Image::aspect() const {
  const bool depth = info_.format == VK_FORMAT_D32_SFLOAT || info_.format == VK_FORMAT_D16_UNORM;
  return depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

LayerView::LayerView(Context& context, const Image& image, std::uint32_t layer) : context_(&context) {
  context.expect_retirement();
  const auto info = view_info(image, VK_IMAGE_VIEW_TYPE_2D, layer, 1);
  check(context.vk().CreateImageView(context.device(), &info, context.vk().allocator, &handle_),
        "vkCreateImageView");
}

LayerView::LayerView(LayerView&& other) noexcept
    : context_(other.context_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}

LayerView::~LayerView() {
  if (handle_) context_->retire({.view = handle_});
}

Sampler::Sampler(Context& context, const SamplerInfo& wanted) : context_(context) {
  context.expect_retirement();
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = info.minFilter = wanted.filter;
  info.mipmapMode = wanted.mipmaps ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = info.addressModeW = wanted.address;
  info.addressModeV = wanted.address_v.value_or(wanted.address);
  info.maxLod = wanted.mipmaps ? VK_LOD_CLAMP_NONE : 0.0f;
  info.maxAnisotropy = std::min(wanted.anisotropy, context.limits().maxSamplerAnisotropy);
  info.anisotropyEnable = info.maxAnisotropy > 1 ? VK_TRUE : VK_FALSE;
  info.compareEnable = wanted.compare ? VK_TRUE : VK_FALSE;
  info.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  check(context.vk().CreateSampler(context.device(), &info, context.vk().allocator, &handle_),
        "vkCreateSampler");
}

Sampler::~Sampler() {
  context_.retire({.sampler = handle_});
}

}  // namespace brume::gpu
