#include "gpu/swapchain.hpp"

#include <algorithm>

#include "core/error.hpp"

namespace brume::gpu {
namespace {

VkSemaphore make_semaphore(Context& context) {
  VkSemaphoreCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
  VkSemaphore semaphore = VK_NULL_HANDLE;
  check(context.vk().CreateSemaphore(context.device(), &info, nullptr, &semaphore), "vkCreateSemaphore");
  return semaphore;
}

/// Eight bits per channel without conversion: the rendered image is already encoded for the screen.
VkSurfaceFormatKHR choose_format(Context& context, VkSurfaceKHR surface) {
  const Functions& vk = context.vk();
  std::uint32_t count = 0;
  check(vk.GetPhysicalDeviceSurfaceFormatsKHR(context.info().handle, surface, &count, nullptr),
        "vkGetPhysicalDeviceSurfaceFormatsKHR");
  std::vector<VkSurfaceFormatKHR> formats(count);
  check(vk.GetPhysicalDeviceSurfaceFormatsKHR(context.info().handle, surface, &count, formats.data()),
        "vkGetPhysicalDeviceSurfaceFormatsKHR");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
  }
  throw Error(ErrorCode::no_device, "the window does not support 8 bits per channel");
}

}  // namespace

Swapchain::Swapchain(Context& context, SurfaceMaker window, bool vertical_sync)
    : context_(context), window_(std::move(window)), vertical_sync_(vertical_sync) {
  try {
    acquired_ = make_semaphore(context);
    make();
  } catch (...) {
    destroy();
    throw;
  }
}

Swapchain::~Swapchain() {
  destroy();
}

void Swapchain::destroy() {
  const Functions& vk = context_.vk();
  vk.DeviceWaitIdle(context_.device());  // Fails for a lost device; destroy everything all the same.
  for (const VkSemaphore semaphore : drawn_) vk.DestroySemaphore(context_.device(), semaphore, nullptr);
  vk.DestroySemaphore(context_.device(), acquired_, nullptr);
  vk.DestroySwapchainKHR(context_.device(), handle_, nullptr);
  vk.DestroySurfaceKHR(context_.instance(), surface_, nullptr);
}

VkPresentModeKHR Swapchain::choose_mode() const {
  if (vertical_sync_) return VK_PRESENT_MODE_FIFO_KHR;  // supported by every surface
  const Functions& vk = context_.vk();
  std::uint32_t count = 0;
  check(vk.GetPhysicalDeviceSurfacePresentModesKHR(context_.info().handle, surface_, &count, nullptr),
        "vkGetPhysicalDeviceSurfacePresentModesKHR");
  std::vector<VkPresentModeKHR> modes(count);
  check(vk.GetPhysicalDeviceSurfacePresentModesKHR(context_.info().handle, surface_, &count, modes.data()),
        "vkGetPhysicalDeviceSurfacePresentModesKHR");
  for (const VkPresentModeKHR wanted : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
    if (std::find(modes.begin(), modes.end(), wanted) != modes.end()) return wanted;
  return VK_PRESENT_MODE_FIFO_KHR;
}

void Swapchain::get_images() {
  const Functions& vk = context_.vk();
  std::uint32_t count = 0;
  check(vk.GetSwapchainImagesKHR(context_.device(), handle_, &count, nullptr), "vkGetSwapchainImagesKHR");
  images_.resize(count);
  check(vk.GetSwapchainImagesKHR(context_.device(), handle_, &count, images_.data()),
        "vkGetSwapchainImagesKHR");
}

// Recreates surface and swapchain as necessary; false when there are no images to render into.
bool Swapchain::make() {
  const Functions& vk = context_.vk();
  check(vk.DeviceWaitIdle(context_.device()), "vkDeviceWaitIdle");
  if (surface_lost_) {
    vk.DestroySwapchainKHR(context_.device(), handle_, nullptr);
    vk.DestroySurfaceKHR(context_.instance(), surface_, nullptr);
    handle_ = VK_NULL_HANDLE;
    surface_ = VK_NULL_HANDLE;
    surface_lost_ = false;
  }
  if (!surface_) surface_ = window_.make(context_.instance());
  out_of_date_ = true;
  VkSurfaceCapabilitiesKHR can{};
  const VkResult known = vk.GetPhysicalDeviceSurfaceCapabilitiesKHR(context_.info().handle, surface_, &can);
  if (known == VK_ERROR_SURFACE_LOST_KHR) {
    surface_lost_ = true;
    return false;
  }
  check(known, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  const bool free_size = can.currentExtent.width == 0xffffffffu;
  size_px_ = free_size ? window_.size_px() : glm::uvec2(can.currentExtent.width, can.currentExtent.height);
  if (size_px_.x == 0 || size_px_.y == 0) return false;

  // The swapchain.
  const VkSurfaceFormatKHR format = choose_format(context_, surface_);
  VkSwapchainCreateInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
  info.surface = surface_;
  info.minImageCount = can.minImageCount + 1;
  if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format.format;
  info.imageColorSpace = format.colorSpace;
  info.imageExtent = {size_px_.x, size_px_.y};
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  info.presentMode = choose_mode();
  info.clipped = VK_TRUE;
  info.oldSwapchain = handle_;
  VkSwapchainKHR made = VK_NULL_HANDLE;
  const VkResult result = vk.CreateSwapchainKHR(context_.device(), &info, nullptr, &made);
  vk.DestroySwapchainKHR(context_.device(), handle_, nullptr);
  handle_ = VK_NULL_HANDLE;
  // The window may have changed since its size was queried; the next frame tries again.
  if (result == VK_ERROR_OUT_OF_DATE_KHR) return false;
  surface_lost_ = result == VK_ERROR_SURFACE_LOST_KHR || result == VK_ERROR_NATIVE_WINDOW_IN_USE_KHR;
  if (surface_lost_) return false;
  check(result, "vkCreateSwapchainKHR");
  handle_ = made;

  get_images();
  while (drawn_.size() < images_.size()) drawn_.push_back(make_semaphore(context_));
  out_of_date_ = false;
  return true;
}

std::optional<Recorder::WindowImage> Swapchain::acquire() {
  // A window that is being resized may change again while its images are created.
  for (int attempt = 0; attempt < 3; ++attempt) {
    if ((out_of_date_ || surface_lost_ || window_.size_px() != size_px_) && !make()) return std::nullopt;
    const VkResult result = context_.vk().AcquireNextImageKHR(context_.device(), handle_, UINT64_MAX,
                                                              acquired_, VK_NULL_HANDLE, &index_);
    if (result == VK_SUCCESS || result == VK_SUBOPTIMAL_KHR) {
      out_of_date_ = result == VK_SUBOPTIMAL_KHR;
      return Recorder::WindowImage{images_[index_], size_px_};
    }
    out_of_date_ = result == VK_ERROR_OUT_OF_DATE_KHR;
    surface_lost_ = result == VK_ERROR_SURFACE_LOST_KHR;
    if (!out_of_date_ && !surface_lost_) check(result, "vkAcquireNextImageKHR");
  }
  return std::nullopt;
}

WindowSemaphores Swapchain::semaphores() const {
  return {acquired_, drawn_[index_]};
}

void Swapchain::present() {
  VkPresentInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &drawn_[index_];
  info.swapchainCount = 1;
  info.pSwapchains = &handle_;
  info.pImageIndices = &index_;
  const VkResult result = context_.vk().QueuePresentKHR(context_.queue(), &info);
  out_of_date_ = out_of_date_ || result == VK_SUBOPTIMAL_KHR || result == VK_ERROR_OUT_OF_DATE_KHR;
  surface_lost_ = surface_lost_ || result == VK_ERROR_SURFACE_LOST_KHR;
  if (!out_of_date_ && !surface_lost_) check(result, "vkQueuePresentKHR");
}

void Swapchain::set_vertical_sync(bool wanted) {
  out_of_date_ = out_of_date_ || wanted != vertical_sync_;
  vertical_sync_ = wanted;
}

}  // namespace brume::gpu
