#include "film/volume_part.hpp"

#include <algorithm>
#include <glm/gtc/packing.hpp>

#include "film/read_back.hpp"

namespace brume::film {
namespace {

constexpr std::size_t kHalvesPerPixel = 4;

void check_frame(const planning::FramePlan& plan) {
  const planning::FrameInput& input = plan.input;
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorCode::usage, "parts of a volume: " + what);
  };
  if (input.volumes.size() != 1) refuse("expected a frame of one volume");
  const planning::VolumeInput& volume = input.volumes.front();
  if (input.smoke.volume && input.smoke.volume->slot_count() > 0) refuse("smoke cannot be divided");
  if (volume.heat.volume || !volume.tints.empty() || volume.colors || !volume.disturbance.empty() ||
      !volume.detail.empty())
    refuse("a volume with heat, masks, colours, a disturbance or detail cannot be divided");
  if (volume.preview) refuse("a volume with a preview cannot be divided");
  if ((plan.media.media & shared::kMediumDense) != 0)
    refuse("a volume that is opaque within a voxel or two cannot be divided; give a smaller extinction");
  if (plan.lights.size() > (plan.media.sun == shared::kNoSun ? 0u : 1u))
    refuse("only the sun and the sky may light it");
  if (!input.tanks.empty()) refuse("there are no tanks; remove [[tank]]");
  if (input.environment.bounces > 0) refuse("there is no indirect light; set bounces to 0");
  if (plan.media.frame.volume_count != 1) refuse("the volume is not in view; move the camera");
}

}  // namespace

void add_depths(std::span<float> depths, std::span<const float> more) {
  BRUME_ASSERT(depths.size() == more.size(), std::to_string(more.size()));
  for (std::size_t i = 0; i < depths.size(); ++i) depths[i] = std::min(depths[i] + more[i], kMostDepth);
}

void composite_behind(Pixels& front, const Pixels& behind) {
  BRUME_ASSERT(front.size() == behind.size(), std::to_string(behind.size()));
  for (std::size_t i = 0; i < front.size(); ++i) {
    const float passed = front[i].a;
    front[i] = glm::vec4(glm::vec3(front[i]) + passed * glm::vec3(behind[i]), passed * behind[i].a);
  }
}

VolumePartRenderer::VolumePartRenderer(gpu::Context& context, gpu::CommandRunner& runner,
                                       const scene::Scene& scene, glm::uvec2 size_px)
    : context_(context),
      runner_(runner),
      renderer_(context, runner, scene, render::RendererOptions{size_px}) {
  if (!scene.objects.empty())
    throw Error(ErrorCode::usage, "parts of a volume: expected a volume alone, without a level");
}

std::vector<std::uint16_t> VolumePartRenderer::halves_of(const gpu::Image& image) {
  const std::size_t per_texel = &image == &renderer_.media() ? kHalvesPerPixel : 1;
  const gpu::Buffer copy = gpu::read_back(context_, runner_, image, per_texel * sizeof(std::uint16_t));
  const auto halves = gpu::values_of<std::uint16_t>(copy);
  return {halves.begin(), halves.end()};
}

void VolumePartRenderer::set_halves(const gpu::Image& image, std::span<const std::uint16_t> halves) {
  // A layer at a time: staging memory grows by what is uploaded at once.
  const glm::uvec3 size = image.info().size;
  const std::size_t layer = halves.size() / size.z;
  for (std::uint32_t z = 0; z < size.z; ++z) {
    const gpu::Recorder::Region region{
        std::as_bytes(halves.subspan(z * layer, layer)), {0, 0, static_cast<int>(z)}, {size.x, size.y, 1}};
    runner_.run([&](gpu::Recorder& recorder) { recorder.upload(image, std::span(&region, 1)); });
  }
}

std::vector<float> VolumePartRenderer::find_depths(const planning::FrameInput& input) {
  plan_.reset();  // its lists end before the next plan's begin in their memory
  input_ = input;
  plan_.emplace(renderer_.plan(input_));
  check_frame(*plan_);
  volume_bytes_ = std::uint64_t{input.volumes.front().volume->slot_count()} * shared::kTexelsPerBrick *
                  sizeof(std::uint16_t);
  runner_.run([&](gpu::Recorder& recorder) { renderer_.record_sweeps(recorder, *plan_); });
  std::vector<float> depths;
  if (!plan_->volume_light.update) return depths;
  const passes::VolumeLightPass& light = renderer_.volumes().light();
  for (const gpu::Image* image : {&light.sun_depths(), &light.sky_depths()})
    for (const std::uint16_t half : halves_of(*image)) depths.push_back(glm::unpackHalf1x16(half));
  return depths;
}

Pixels VolumePartRenderer::march(std::span<const float> depths) {
  BRUME_ASSERT(plan_, "a frame begins with find_depths");
  if (plan_->volume_light.update) {
    std::vector<std::uint16_t> halves(depths.size());
    std::ranges::transform(depths, halves.begin(), [](float depth) { return glm::packHalf1x16(depth); });
    const passes::VolumeLightPass& light = renderer_.volumes().light();
    const std::size_t of_sun = gpu::texel_count(light.sun_depths());
    BRUME_ASSERT(depths.size() == of_sun + gpu::texel_count(light.sky_depths()),
                 std::to_string(depths.size()));
    set_halves(light.sun_depths(), std::span(halves).first(of_sun));
    set_halves(light.sky_depths(), std::span(halves).subspan(of_sun));
  }
  runner_.run([&](gpu::Recorder& recorder) { renderer_.record_rays(recorder, *plan_); });
  const std::vector<std::uint16_t> halves = halves_of(renderer_.media());
  Pixels pixels(halves.size() / kHalvesPerPixel);
  for (std::size_t i = 0; i < halves.size(); ++i)
    pixels[i / kHalvesPerPixel][static_cast<int>(i % kHalvesPerPixel)] = glm::unpackHalf1x16(halves[i]);
  return pixels;
}

image::Image8 VolumePartRenderer::picture(const Pixels& pixels) {
  BRUME_ASSERT(plan_, "a frame begins with find_depths");
  std::vector<std::uint16_t> halves;
  for (const glm::vec4& pixel : pixels)
    for (int channel = 0; channel < 4; ++channel) halves.push_back(glm::packHalf1x16(pixel[channel]));
  set_halves(renderer_.media(), halves);
  return read_picture(context_, runner_, renderer_.targets().display,
                      [&](gpu::Recorder& recorder) { renderer_.record_picture(recorder, *plan_); });
}

}  // namespace brume::film
