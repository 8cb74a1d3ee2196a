#include "reference/picture.hpp"

#include <algorithm>
#include <cmath>

#include "core/tasks.hpp"
#include "planning/device_camera.hpp"
#include "planning/exposure.hpp"
#include "shared/tone.h"

namespace brume::reference {

image::Image8 make_picture(const Render& render, glm::uvec2 size_px, const planning::View& view) {
  const std::uint32_t tone =
      view.tone == scene::ToneCurve::standard ? shared::kToneStandard : shared::kToneNeutral;
  const std::vector<glm::vec4> radiance = render.radiance();
  image::Image8 image{size_px.x, size_px.y, std::vector<std::uint8_t>(4 * radiance.size(), 255)};
  parallel_for(radiance.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const glm::vec3 shown = shared::srgb_from_linear(
          shared::tone_curve(tone, glm::min(glm::vec3(radiance[i]), 65504.0f) * view.exposure));
      // The first dimension is blue noise over the pixels.
      Sampler dither({i % size_px.x, i / size_px.x}, 0);
      for (int c = 0; c < 3; ++c) {
        const float value = 255 * shown[c] + dither.next_1d();
        image.rgba[4 * i + static_cast<std::size_t>(c)] =
            static_cast<std::uint8_t>(std::clamp(std::floor(value), 0.0f, 255.0f));
      }
    }
  });
  return image;
}

float measure_exposure(const scene::Scene& scene, planning::FrameInput frame, const smoke::MaskAtlas* masks,
                       float aspect, const std::function<bool()>& stopped) {
  // Few samples of a small image: the mean over it is exact enough.
  constexpr float kHeight = 72;
  frame.smoke.volume = nullptr;
  const auto small = make_scene(scene, frame, masks);
  RenderSettings settings;
  settings.size_px = {static_cast<std::uint32_t>(std::clamp(kHeight * aspect, 8.0f, 512.0f)),
                      static_cast<std::uint32_t>(kHeight)};
  settings.eyes = {{planning::device_camera(frame.view.camera, settings.size_px)}};
  settings.samples = 8;
  Render render(*small, settings);
  while (!render.advance(1, stopped) && !stopped())
    ;
  return planning::exposure_of(render.radiance());
}

}  // namespace brume::reference
