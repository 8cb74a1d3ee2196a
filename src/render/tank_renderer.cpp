#include "render/tank_renderer.hpp"

#include "passes/blue_noise.hpp"

namespace brume::render {

TankRenderer::TankRenderer(gpu::Context& context, gpu::CommandStream& stream, const spheres::Tank& tank,
                           glm::uvec2 size_px, bool with_ids)
    : context_(context),
      sampler_(context, stream, tank, spheres::list_bricks(tank), with_ids),
      display_pass_(context),
      frame_(context, sizeof(shared::FrameConstants),
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  resize(size_px);
  stream.run([&](gpu::Recorder& recorder) { blue_noise_ = passes::make_blue_noise(context, recorder); });
}

void TankRenderer::set_view(const planning::TankPlan& plan, const planning::TankDisplay& display) {
  sampler_.set_view(plan);
  display_ = display;
}

void TankRenderer::resize(glm::uvec2 size_px) {
  sampler_.resize(size_px);
  shown_ = gpu::Image(context_, gpu::storage_image(size_px, VK_FORMAT_R8G8B8A8_UNORM));
}

void TankRenderer::record_samples(gpu::Recorder& recorder, std::uint32_t count) {
  sampler_.record_samples(recorder, blue_noise_, count);
  record_display(recorder);
}

void TankRenderer::record_rows(gpu::Recorder& recorder, std::uint32_t rows) {
  sampler_.record_rows(recorder, blue_noise_, rows);
  if (sampler_.rows() == 0) record_display(recorder);
}

void TankRenderer::record_display(gpu::Recorder& recorder) {
  recorder.upload(frame_, 0, std::as_bytes(std::span(&display_.frame, 1)));
  const gpu::Scope scope(recorder, "display");
  display_pass_.record(recorder, frame_, blue_noise_, radiance(), shown_, display_.dither);
}

}  // namespace brume::render
