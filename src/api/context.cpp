#include "api/objects.hpp"

namespace brume::api {

// The size of 0.2.
template <>
inline constexpr std::array kEarlierSizes<brume_context_params>{
    std::uint32_t{offsetof(brume_context_params, run_jobs)}};

namespace {

constexpr std::uint32_t kMaxThreads = 1024;

void create_context(const brume_context_params* given, brume_context** context) {
  required(context, "context");
  const brume_context_params params = params_or_defaults(given);
  require(params.thread_count <= kMaxThreads, "`thread_count` must be at most 1024");
  auto settings = std::make_shared<Settings>();
  settings->thread_count = params.thread_count;
  settings->log = params.log;
  settings->log_user = params.log_user;
  settings->run_jobs = params.run_jobs;
  settings->jobs_user = params.jobs_user;
  create(context, std::move(settings));
}

std::vector<smoke::Mask> copy_masks(const brume_mask_image* images, std::size_t count) {
  require(count <= sim::kMaxMasks, "at most 65536 masks");
  if (count > 0) required(images, "images");
  std::vector<smoke::Mask> masks(count);
  std::uint64_t texels = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const brume_mask_image& image = images[i];
    const bool valid = image.width >= 1 && image.width <= smoke::kMaxMaskAxis && image.height >= 1 &&
                       image.height <= smoke::kMaxMaskAxis && image.texels;
    if (!valid) refuse("mask " + std::to_string(i) + " must have 1 to 4094 texels per axis, and texels");
    const std::size_t size = std::size_t{image.width} * image.height;
    texels += size;
    if (texels > std::uint64_t{smoke::kMaxMaskAtlasAxis} * smoke::kMaxMaskAtlasAxis)
      fail(BRUME_ERROR_LIMIT, "the masks must fit into 4096 x 4096 texels together");
    masks[i] = {image.width, image.height, {image.texels, image.texels + size}};
  }
  return masks;
}

}  // namespace

std::shared_ptr<const smoke::MaskAtlas> atlas_of(Call& call, const brume_masks* masks) {
  if (!masks) return nullptr;
  return call.handle(masks).atlas;
}

}  // namespace brume::api

using namespace brume::api;

extern "C" {

brume_result brume_context_create(const brume_context_params* params,
                                  brume_context** context) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) { create_context(params, context); });
}

brume_result brume_context_destroy(brume_context* context) BRUME_NOEXCEPT {
  if (!context) return BRUME_OK;
  return Call(__func__).run([&](Call& call) {
    brume_context& held = call.handle(context);
    held.settings->log = nullptr;
    held.settings->run_jobs = nullptr;
    delete &held;
  });
}

brume_result brume_masks_create(brume_context* context, const brume_mask_image* images, size_t count,
                                brume_masks** masks) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_context& owner = call.handle(context);
    required(masks, "masks");
    create(masks, owner.settings, unwrap(brume::smoke::MaskAtlas::pack(copy_masks(images, count))));
  });
}

brume_result brume_masks_destroy(brume_masks* masks) BRUME_NOEXCEPT {
  return destroy(__func__, masks);
}

}  // extern "C"
