#include "apps/viewer/level_refiner.hpp"

#include <chrono>

#include "film/exposure.hpp"
#include "planning/device_camera.hpp"
#include "render/volume_room.hpp"

namespace brume::viewer {
namespace {

// Before a still is refined, the light of the smoke is updated in as many slices, each in a frame that ends
// soon after an input.
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

LevelRefiner::LevelRefiner(Screen& screen, Window& window, const scenario::Scenario& scenario,
                           std::uint64_t volume_bytes, const std::optional<Game>& game,
                           const QualityControl& quality)
    : screen_(screen),
      window_(window),
      game_(game),
      quality_(quality),
      renderer_(screen.context(), screen.runner(), limited(screen.context(), scenario, volume_bytes).scene,
                renderer_options(scenario, glm::max(window.size_px(), glm::uvec2(1)))) {}

void LevelRefiner::set_resolution(glm::uvec2 picture_px, std::uint32_t march_scale) {
  if (picture_px != renderer_.targets().size_px) {
    renderer_.resize(picture_px);
    history_lost_ = true;
  }
  if (march_scale != march_scale_) renderer_.set_march_scale(march_scale);
  march_scale_ = march_scale;
}

/// Prepares for the image that `brume render` renders of `input`.
void LevelRefiner::begin_still(render::FrameInput& input, glm::uvec2 size_px) {
  set_resolution(size_px, 1);
  history_lost_ = true;
  input.view.continues = false;
  input.quality = {};
}

float LevelRefiner::measure_exposure(const render::FrameInput& input) {
  return film::measure_exposure(screen_.context(), renderer_, input);
}

image::Image8 LevelRefiner::picture(glm::uvec2 size_px, bool /*complete*/,
                                    const std::function<void()>& check) {
  const StillFrame frame(*game_);
  plan_.reset();
  for (std::uint32_t i = 0; i < frame.samples(); ++i) {
    render::FrameInput input = frame.sample(i);
    begin_still(input, size_px);
    renderer_.draw(input);
    if (check) check();
  }
  continues_ = false;
  rendered_ = {};
  return screen_.read(renderer_.targets().display);
}

bool LevelRefiner::changes(glm::uvec2 window_px) {
  const Session& session = game_->session();
  const scene::Camera camera = game_->player().camera();
  const Key now{session.seconds(), camera.position_world, camera.target_world, optics_of(camera),
                window_px,         game_->changes()};
  const bool is_new = now != rendered_;
  rendered_ = now;
  // Volumes are shown at another time or resolution than they will be.
  const auto& volumes = session.live().scenario().volumes;
  return is_new || !session.paused() || renderer_.streams_volumes() || (volumes && volumes->is_behind());
}

void LevelRefiner::prepare_film(glm::uvec2 window_px, float light_update_fraction) {
  const Quality& quality = quality_.quality();
  input_ = frame_input(*game_, holes_, volumes::VolumeWait::never);
  input_.quality.volume_upload_bytes = kVolumeUploadBytes;
  input_.view.frame_index = ++frame_index_;
  for (planning::TankInput& tank : input_.tanks) tank.index = frame_index_;
  const bool continues = continues_ && game_->choices().temporal;
  if (continues) input_.view.sample = planning::film_sample(frame_index_);
  input_.quality.step_scale = quality.step_scale;
  input_.quality.resolve_error_scale = quality.resolve_error_scale;
  input_.quality.light_update_fraction = light_update_fraction;
  input_.quality.indirect_update_fraction = quality.indirect_update_fraction;
  input_.quality.fine_shadows = quality.fine_shadows;
  input_.quality.detail = quality.detail;

  const auto begin = std::chrono::steady_clock::now();
  set_resolution(scaled(window_px, quality.picture_scale), quality.march_scale);
  input_.view.continues = continues && !history_lost_;
  plan_.emplace(renderer_.plan(input_));
  history_lost_ = false;
  continues_ = true;
  plan_seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Renders a sample of the best image in parts, to be shown next; false as soon as there is an input between
/// two parts.
bool LevelRefiner::draw_sample(render::FrameInput input, glm::uvec2 size_px) {
  begin_still(input, size_px);
  continues_ = false;
  const std::uint64_t events = window_.events();
  const render::FramePlan plan = renderer_.plan(input);
  for (int part = 0; part < render::Renderer::kParts; ++part) {
    if (part > 0) window_.poll(0);
    if (window_.events() != events) return false;
    screen_.runner().run([&](gpu::Recorder& recorder) { renderer_.record_part(recorder, plan, part); });
  }
  return true;
}

void LevelRefiner::restart_still() {
  slices_ = 0;
  samples_ = 0;
  is_best_ = false;
}

bool LevelRefiner::prepare(glm::uvec2 window_px, Stage stage, double frame_seconds) {
  const float fraction = quality_.quality().light_update_fraction;
  plan_.reset();
  plan_seconds_ = 0;
  // A frame of the film.
  if (stage == Stage::changed) {
    restart_still();
    prepare_film(window_px, light_update_fraction(fraction, frame_seconds));
    return true;
  }
  if (stage == Stage::waiting || is_best_) return true;
  // The image at rest: its light, then its samples.
  if (fraction < 1 && slices_ < kLightSlices) {
    ++slices_;
    prepare_film(window_px, 1.0f / kLightSlices);
    return true;
  }
  StillFrame still(*game_);
  if (draw_sample(still.last_sample(samples_), window_px)) {
    is_best_ = ++samples_ == still.samples();
    return true;
  }
  restart_still();
  prepare_film(window_px, 1.0f / kLightSlices);
  return false;
}

void LevelRefiner::record(gpu::Recorder& recorder) {
  if (plan_) renderer_.record_frame(recorder, *plan_);
}

}  // namespace brume::viewer
