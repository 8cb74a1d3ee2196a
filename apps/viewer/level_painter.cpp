#include "apps/viewer/level_painter.hpp"

#include <chrono>

#include "render/exposure.hpp"
#include "render/volume_room.hpp"

namespace brume::viewer {
namespace {

// A still waits for further input before it is refined. Then the light of the smoke is updated in as many
// slices, each in a frame that ends soon after an input.
constexpr int kFramesUntilRefined = 3;
constexpr int kLightSlices = 8;
// Upload of volume bricks in a frame: 3 ms on a bus of 6 GB/s.
constexpr std::uint64_t kVolumeUploadBytes = 16u << 20;

render::RendererOptions renderer_options(const scenario::Scenario& scenario, glm::uvec2 size_px) {
  render::RendererOptions options{size_px};
  options.antialias = true;
  options.smoke.temporal = true;
  options.smoke.prepare_all = true;
  options.smoke.masks = &scenario.masks;
  return options;
}

/// The scenario, its volumes reduced to the room of the device.
const scenario::Scenario& limited(gpu::Context& context, const scenario::Scenario& scenario,
                                  std::uint64_t volume_bytes) {
  if (!scenario.volumes) return scenario;
  volumes::VolumeRoom room = render::volume_room(context, volume_bytes);
  const std::uint64_t previews = 2 * volumes::kPreviewBricks * scenario.timeline.volumes.size();
  room.bricks -= std::min(room.bricks / 4, previews);
  scenario.volumes->limit(room).value_or_throw();
  scenario.volumes->make_previews();
  return scenario;
}

glm::uvec2 scaled(glm::uvec2 size_px, float scale) {
  return glm::max(glm::uvec2(glm::round(glm::vec2(size_px) * scale)), glm::uvec2(1));
}

}  // namespace

LevelPainter::LevelPainter(Screen& screen, Window& window, const scenario::Scenario& scenario,
                           std::uint64_t volume_bytes)
    : screen_(screen),
      window_(window),
      renderer_(screen.context(), screen.runner(), limited(screen.context(), scenario, volume_bytes).scene,
                renderer_options(scenario, glm::max(window.size_px(), glm::uvec2(1)))) {}

void LevelPainter::restart() {
  continues_ = false;
  samples_ = 0;
  is_best_ = false;
  rendered_ = {};
}

void LevelPainter::set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale) {
  if (picture_px != renderer_.targets().size_px) {
    renderer_.resize(picture_px);
    history_lost_ = true;
  }
  if (march_scale != march_scale_) renderer_.set_march_scale(march_scale);
  march_scale_ = march_scale;
}

/// Renders `input` (null: repeats the previous image) and shows it.
bool LevelPainter::show(render::FrameInput* input, const Quality& quality, const ImDrawData& ui) {
  const auto size_px = screen_.begin();
  if (!size_px) return false;
  const auto begin = std::chrono::steady_clock::now();
  std::optional<render::FramePlan> plan;
  if (input) {
    set_resolution(scaled(*size_px, quality.picture_scale), quality.march_scale);
    input->view.continues = input->view.continues && !history_lost_;
    history_lost_ = false;
    plan.emplace(renderer_.plan(*input));
  }
  plan_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  screen_.show(
      [&](gpu::Recorder& recorder) {
        if (plan) renderer_.record_frame(recorder, *plan);
      },
      &renderer_.targets().display, ui);
  return true;
}

/// Prepares for the image that `brume render` renders of `input`.
void LevelPainter::begin_still(render::FrameInput& input, glm::uvec2 size_px) {
  set_resolution(size_px, 1);
  history_lost_ = true;
  input.view.continues = false;
  input.quality = {};
}

/// Renders `input` at full quality in parts, to be shown next; false as soon as there is an input between two
/// parts: then the next frame must be rendered.
bool LevelPainter::refine(render::FrameInput input) {
  begin_still(input, screen_.size_px());
  const std::uint64_t events = window_.events();
  const render::FramePlan plan = renderer_.plan(input);
  for (int part = 0; part < render::Renderer::kParts; ++part) {
    if (part > 0) window_.poll(0);
    if (window_.events() != events) return false;
    screen_.runner().run([&](gpu::Recorder& recorder) { renderer_.record_part(recorder, plan, part); });
  }
  return true;
}

float LevelPainter::measure_exposure(const render::FrameInput& input) {
  return render::measure_exposure(screen_.context(), renderer_, input);
}

image::Image8 LevelPainter::picture(const Game& game, glm::uvec2 size_px) {
  const StillFrame frame(game);
  for (std::uint32_t i = 0; i < frame.samples(); ++i) {
    render::FrameInput input = frame.sample(i);
    begin_still(input, size_px);
    renderer_.draw(input);
  }
  restart();
  return screen_.read(renderer_.targets().display);
}

/// Whether the paused image is up to date.
bool LevelPainter::is_still(const Game& game) {
  const scene::Camera camera = game.player().camera();
  const Key now{game.session().seconds(), camera.position_world, camera.target_world,
                optics_of(camera),        window_.size_px(),     game.changes()};
  // Volumes are shown at another time or resolution than they will be.
  const auto& volumes = game.session().live().scenario().volumes;
  if (now != rendered_ || renderer_.streams_volumes() || (volumes && volumes->is_behind())) {
    rendered_ = now;
    still_frames_ = 0;
    samples_ = 0;
    is_best_ = false;
    return false;
  }
  ++still_frames_;
  return game.session().paused();
}

bool LevelPainter::draw_film(const Game& game, const Quality& quality, float light_update_fraction,
                             const ImDrawData& ui) {
  std::vector<shared::Hole> holes;
  render::FrameInput input = frame_input(game, holes, volumes::VolumeWait::never);
  input.quality.volume_upload_bytes = kVolumeUploadBytes;
  input.view.continues = continues_ && game.choices().temporal;
  input.view.frame_index = ++frame_index_;
  for (planning::TankInput& tank : input.tanks) tank.index = frame_index_;
  if (input.view.continues) input.view.sample = planning::film_sample(frame_index_);
  input.quality.step_scale = quality.step_scale;
  input.quality.resolve_error_scale = quality.resolve_error_scale;
  input.quality.light_update_fraction = light_update_fraction;
  input.quality.indirect_update_fraction = quality.indirect_update_fraction;
  input.quality.fine_shadows = quality.fine_shadows;
  input.quality.detail = quality.detail;
  continues_ = true;
  return show(&input, quality, ui);
}

bool LevelPainter::draw_best(const Game& game, const Quality& quality, const ImDrawData& ui) {
  StillFrame still(game);
  const bool is_refined = refine(still.last_sample(samples_));
  continues_ = false;
  if (is_refined) {
    is_best_ = ++samples_ == still.samples();
    return show(nullptr, quality, ui);
  }
  still_frames_ = 0;
  samples_ = 0;
  return draw_film(game, quality, 1.0f / kLightSlices, ui);
}

bool LevelPainter::draw_frame(const Game& game, const Quality& quality, double frame_seconds,
                              const ImDrawData& ui) {
  in_motion_ = !is_still(game);
  if (in_motion_) {
    const float fraction = light_update_fraction(quality.light_update_fraction, frame_seconds);
    return draw_film(game, quality, fraction, ui);
  }
  if (is_best_ || still_frames_ < kFramesUntilRefined) return show(nullptr, quality, ui);
  const int slices = quality.light_update_fraction < 1 ? kLightSlices : 0;
  if (still_frames_ < kFramesUntilRefined + slices) return draw_film(game, quality, 1.0f / kLightSlices, ui);
  return draw_best(game, quality, ui);
}

bool LevelPainter::draw(const Game& game, const Quality& quality, double frame_seconds,
                        const ImDrawData& ui) {
  if (draw_frame(game, quality, frame_seconds, ui)) return true;
  restart();  // a new image when the window shows again
  return false;
}

}  // namespace brume::viewer
