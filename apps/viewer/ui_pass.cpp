#include "apps/viewer/ui_pass.hpp"

#include <imgui.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "brume_shaders.hpp"
#include "core/error.hpp"
#include "shared/ui.h"

namespace brume::viewer {
namespace {

static_assert(sizeof(ImDrawVert) == sizeof(shared::UiVertex));

gpu::GraphicsInfo pipeline_info(VkFormat target) {
  gpu::GraphicsInfo info;
  info.vertex = &shaders::ui_vert;
  info.fragment = &shaders::ui_frag;
  info.colours = {target};
  info.depth = VK_FORMAT_UNDEFINED;
  info.blend = gpu::Blend::alpha;
  return info;
}

gpu::Image make_font(gpu::Context& context, gpu::CommandRunner& runner) {
  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&texels, &width, &height);
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8_UNORM;
  info.size = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), 1};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  gpu::Image image(context, info);
  const std::span pixels(texels, std::size_t{info.size.x} * info.size.y);
  runner.run([&](gpu::Recorder& recorder) {
    const gpu::Recorder::Region region{std::as_bytes(pixels), glm::ivec3(0), info.size};
    recorder.upload(image, std::span(&region, 1));
  });
  return image;
}

void grow(gpu::Context& context, gpu::Buffer& buffer, std::size_t bytes, VkBufferUsageFlags usage) {
  if (buffer && buffer.size() >= bytes) return;
  buffer = gpu::Buffer(context, std::bit_ceil(std::max<std::size_t>(bytes, 1 << 16)),
                       usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

}  // namespace

UiPass::UiPass(gpu::Context& context, gpu::CommandRunner& runner, VkFormat target)
    : context_(context),
      pipeline_(context, pipeline_info(target)),
      linear_(context, {}),
      font_(make_font(context, runner)) {}

void UiPass::reserve(const ImDrawData& data) {
  grow(context_, vertices_, static_cast<std::size_t>(data.TotalVtxCount) * sizeof(ImDrawVert),
       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  grow(context_, indices_, static_cast<std::size_t>(data.TotalIdxCount) * sizeof(std::uint32_t),
       VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
}

void UiPass::record_upload(gpu::Recorder& recorder, const ImDrawData& data) const {
  std::vector<ImDrawVert> vertices;
  std::vector<std::uint32_t> indices;
  for (const ImDrawList* list : std::span(data.CmdLists, static_cast<std::size_t>(data.CmdListsCount))) {
    vertices.insert(vertices.end(), list->VtxBuffer.begin(), list->VtxBuffer.end());
    indices.insert(indices.end(), list->IdxBuffer.begin(), list->IdxBuffer.end());
  }
  recorder.upload(vertices_, 0, std::as_bytes(std::span(vertices)));
  recorder.upload(indices_, 0, std::as_bytes(std::span(indices)));
}

void UiPass::record(gpu::Recorder& recorder, const ImDrawData& data, const gpu::Image& picture) const {
  if (data.TotalIdxCount == 0) return;

  // Inputs, over the picture as it is.
  record_upload(recorder, data);
  const gpu::Binding vertices = gpu::read(vertices_), font = gpu::sampled(font_, linear_);
  recorder.prepare_for_draws({vertices, font});
  recorder.prepare_indices(indices_);
  const glm::uvec2 size(picture.info().size);
  gpu::Recorder::Attachments attachments;
  attachments.colours = {&picture};
  attachments.keep = 1;
  recorder.begin_rendering(attachments, size);
  recorder.bind_for_draws(pipeline_, {{shared::kBindUiVertices, vertices}, {shared::kBindUiFont, font}});
  const shared::UiConstants constants{glm::vec2(data.DisplayPos.x, data.DisplayPos.y),
                                      glm::vec2(data.DisplaySize.x, data.DisplaySize.y)};
  recorder.push(pipeline_, std::as_bytes(std::span(&constants, 1)));

  // One draw per clip rectangle; the lists lie one behind the other in the buffers.
  std::uint32_t first_index = 0, first_vertex = 0;
  const glm::vec2 scale(data.FramebufferScale.x, data.FramebufferScale.y);
  for (const ImDrawList* list : std::span(data.CmdLists, static_cast<std::size_t>(data.CmdListsCount))) {
    for (const ImDrawCmd& command : list->CmdBuffer) {
      const glm::vec2 low = (glm::vec2(command.ClipRect.x, command.ClipRect.y) - constants.origin) * scale;
      const glm::vec2 high = (glm::vec2(command.ClipRect.z, command.ClipRect.w) - constants.origin) * scale;
      const glm::ivec2 from(glm::max(low, glm::vec2(0)));
      const glm::ivec2 to(glm::min(glm::ceil(high), glm::vec2(size)));
      if (command.UserCallback || from.x >= to.x || from.y >= to.y) continue;
      recorder.set_scissor(from, glm::uvec2(to - from));
      recorder.draw_indexed(indices_, command.ElemCount, first_index + command.IdxOffset,
                            static_cast<std::int32_t>(first_vertex + command.VtxOffset));
    }
    first_index += static_cast<std::uint32_t>(list->IdxBuffer.Size);
    first_vertex += static_cast<std::uint32_t>(list->VtxBuffer.Size);
  }
  recorder.end_rendering();
}

}  // namespace brume::viewer
