#include "render/parts/tanks.hpp"

#include <algorithm>

#include "planning/device_camera.hpp"
#include "planning/view_frustum.hpp"

namespace brume::render {
namespace {

/// For how many frames a tank that is not shown stays on the device.
constexpr std::uint64_t kKeptFrames = 256;
/// Samples of a picture: floats count them, and more change nothing.
constexpr std::uint32_t kMostSamples = 1u << 16;

bool is_alike(const scene::MovedObject& a, const scene::MovedObject& b) {
  return a.object == b.object && a.world_from_mesh == b.world_from_mesh;
}

/// Glass may be anywhere.
bool may_be_seen(const planning::TankInput& tank, const planning::ViewFrustum& frustum) {
  const float radius = 0.5f * tank.placement.scale * glm::length(planning::size_of(tank.content->tank));
  return tank.light->scene.glass || frustum.may_intersect({tank.placement.position_world, radius});
}

}  // namespace

TanksPart::TanksPart(gpu::Context& context, gpu::CommandStream& stream, glm::uvec2 size_px, Over over)
    : context_(context), stream_(stream), over_(over), layer_pass_(context), size_px_(size_px) {
  if (over == Over::level) copy_pass_.emplace(context);
  resize(size_px);
}

void TanksPart::resize(glm::uvec2 size_px) {
  // Images of the frame's size are never refused.
  const gpu::Memory::Unlimited always(context_.memory());
  size_px_ = size_px;
  layers_ = gpu::Image(
      context_, gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_TRANSFER_DST_BIT));
  if (over_ == Over::level)
    surfaces_ = gpu::Image(context_, gpu::storage_image(size_px, VK_FORMAT_R32_SFLOAT));
  for (Slot& slot : slots_) slot.sampler.resize(size_px);
}

/// The slot of the same tank that no other of this frame has, or a new one.
TanksPart::Slot& TanksPart::slot_of(const planning::TankInput& tank) {
  const auto found = std::ranges::find_if(
      slots_, [&](const Slot& slot) { return slot.content == tank.content && slot.frame < frame_; });
  if (found != slots_.end()) return *found;
  Slot& made = slots_.emplace_back(context_, stream_, *tank.content);
  const gpu::Memory::Unlimited always(context_.memory());
  made.sampler.resize(size_px_);
  made.content = tank.content;  // last: a slot that failed is none's
  return made;
}

void TanksPart::add(const planning::TankInput& tank, const planning::View& view, glm::uvec2 size_px) {
  Slot& slot = slot_of(tank);
  const bool continues = tank.continues && level_stands_ && slot.frame + 1 == frame_ &&
                         slot.light == tank.light && slot.sampler.samples() > 0;
  slot.frame = frame_;
  shown_.push_back(&slot);
  planning::TankPlan plan = planning::plan_tank_in_frame(tank.light->scene, tank.content->tank,
                                                         tank.placement, view.camera, view.sample, size_px);
  plan.view = tank.view;
  if (slot.light != tank.light) slot.sampler.set_photons(tank.light->paths);
  slot.light = tank.light;
  if (!continues || !planning::same_samples(plan, slot.sampler.plan()))
    slot.sampler.set_view(plan, tank.index);
  slot.sampler.reserve(true);
  slot.samples = std::min(tank.samples, kMostSamples - slot.sampler.samples());
}

bool TanksPart::LevelSurfaces::is(const planning::LevelState& level) const {
  return hidden_objects == level.hidden_objects && grenades == level.grenades &&
         std::ranges::equal(moved, level.moved, is_alike);
}

/// Whether the level's surfaces are those of the frame before.
void TanksPart::begin_level(const FrameInput& input) {
  level_stands_ = level_.is(input.level);
  if (!level_stands_) level_ = {input.level.hidden_objects, input.level.grenades, input.level.moved};
}

void TanksPart::prepare(const FrameInput& input, glm::uvec2 size_px) {
  const scene::Camera& camera = input.view.camera;
  ++frame_;
  shown_.clear();
  has_layers_now_ = over_ == Over::host && !input.tanks.empty();
  std::erase_if(slots_, [&](const Slot& slot) { return slot.frame + kKeptFrames < frame_; });
  // Tanks have a depth; all else that debug views show is the level's.
  const planning::DebugView view = input.debug.view;
  if (input.tanks.empty() || (view != planning::DebugView::none && view != planning::DebugView::depth))
    return;
  if (over_ == Over::level) begin_level(input);
  std::vector<const planning::TankInput*> far_first;
  for (const planning::TankInput& tank : input.tanks) far_first.push_back(&tank);
  const auto distance = [&](const planning::TankInput* tank) {
    return glm::distance(tank->placement.position_world, camera.position_world);
  };
  std::ranges::stable_sort(far_first, std::ranges::greater(), distance);
  const planning::ViewFrustum frustum(planning::device_camera(camera, size_px));
  for (const planning::TankInput* tank : far_first)
    if (may_be_seen(*tank, frustum)) add(*tank, input.view, size_px);
  has_layers_now_ = has_layers_now_ || !shown_.empty();
}

void TanksPart::record_surfaces(gpu::Recorder& recorder, const gpu::Image& depth,
                                const gpu::Image& blue_noise) {
  const gpu::Image* const surfaces = this->surfaces();
  if (surfaces) copy_pass_->record_copy(recorder, depth, *surfaces);
  for (Slot* slot : shown_)
    slot->sampler.record_samples(recorder, blue_noise, slot->samples, surfaces ? surfaces : &depth);
}

void TanksPart::record_layers(gpu::Recorder& recorder, const gpu::Image& media) {
  recorder.change(has_layers_) = has_layers_now_;
  if (!has_layers_now_) return;
  const gpu::Scope timed(recorder, "tank_layers");
  layer_pass_.begin(recorder, layers_);
  for (const Slot* slot : shown_) layer_pass_.add(recorder, slot->sampler.radiance(), layers_);
  layer_pass_.add(recorder, media, layers_);
}

}  // namespace brume::render
