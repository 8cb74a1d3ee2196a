// The renderer's pictures against what they should be, pixel by pixel (tests/reference/truth.hpp).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "image/metrics.hpp"
#include "image/png.hpp"
#include "passes/noise.hpp"
#include "passes/scene_upload.hpp"
#include "render/device_camera.hpp"
#include "render/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/reference/truth.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::render {
namespace {

constexpr glm::uvec2 kSize{64, 36};
constexpr double kLeastPsnr = 36.5;  // [dB] of what is shown; the least of the eight cases is 37.1

/// What the device made of a case.
struct Drawn {
  std::vector<glm::dvec4> smoke;  ///< Premultiplied radiance, transmittance.
  std::vector<glm::dvec3> picture;
};

class TruthTest : public gpu::GpuTest {
 protected:
  static std::vector<glm::dvec4> texels(const gpu::Image& image) {
    std::vector<glm::dvec4> out;
    for (const passes::Half4& texel : read_back<passes::Half4>(image))
      out.emplace_back(passes::from_half(texel));
    return out;
  }
  static FrameInput input_of(const TruthCase& one, const stage::Simulation& simulation,
                             std::vector<shared::Hole>& holes) {
    FrameInput input = frame_input(one.stage, simulation, one.seconds, holes);
    input.look.many_scatterings = 0;
    if (!one.noisy) input.look.hole_rim = 0;
    return input;
  }
  static Drawn draw(const TruthCase& one, const FrameInput& input) {
    Renderer renderer(context(), runner(), one.stage.scene, {.size_px = kSize, .masks = &one.stage.masks});
    renderer.prepare(input);
    runner().run([&](gpu::Recorder& recorder) { renderer.record_frame(recorder, input); });
    Drawn drawn{texels(renderer.smoke()), {}};
    for (const glm::dvec4& texel : texels(renderer.picture())) drawn.picture.emplace_back(texel);
    return drawn;
  }
  static reference::NoiseTile noise_tile() {
    const passes::NoisePass pass(context());
    const gpu::Image tile = passes::make_noise_tile(context(), passes::kSmokeNoise.size);
    runner().run([&](gpu::Recorder& recorder) { pass.record(recorder, tile, passes::kSmokeNoise); });
    return {passes::kSmokeNoise.size, read_back<glm::u8vec4>(tile)};
  }
};

/// Khronos PBR Neutral (shaders/lib/tone.glsl).
glm::dvec3 tone(glm::dvec3 c) {
  const double x = std::min({c.r, c.g, c.b});
  c -= x < 0.08 ? x - 6.25 * x * x : 0.04;
  const double peak = std::max({c.r, c.g, c.b}), start = 0.76, d = 1 - start;
  if (peak < start) return c;
  const double new_peak = 1 - d * d / (peak + d - start), bleach = 1 - 1 / (0.15 * (peak - new_peak) + 1);
  return glm::mix(c * (new_peak / peak), glm::dvec3(new_peak), bleach);
}

/// Tone curve and sRGB, 8 bits, without dither.
image::Image8 shown(const std::vector<glm::dvec3>& picture, double exposure) {
  image::Image8 out{kSize.x, kSize.y, {}};
  for (const glm::dvec3& radiance : picture) {
    const glm::dvec3 c = glm::clamp(tone(exposure * radiance), 0.0, 1.0);
    for (int i = 0; i < 3; ++i) {
      const double v = c[i] <= 0.0031308 ? 12.92 * c[i] : 1.055 * std::pow(c[i], 1 / 2.4) - 0.055;
      out.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * v)));
    }
    out.rgba.push_back(255);
  }
  return out;
}

double psnr_of(const image::Image8& a, const image::Image8& b) {
  return image::psnr(image::difference(image::encoded_colours(a), image::encoded_colours(b)).rmse, 1);
}

/// Of radiance after exposure; 1 is white.
double psnr_of(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b, double exposure) {
  std::vector<float> x, y;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      x.push_back(static_cast<float>(std::min(exposure * a[i][c], 1.0)));
      y.push_back(static_cast<float>(std::min(exposure * b[i][c], 1.0)));
    }
  return image::psnr(image::difference(x, y).rmse, 1);
}

/// Pictures go there, if it is named: the truth, what was drawn, where one would notice.
void keep(const std::string& name, const image::Image8& truth, const image::Image8& drawn) {
  const char* folder = std::getenv("BRUME_TRUTH");
  if (folder == nullptr) return;
  std::string file = name;
  std::replace(file.begin(), file.end(), ' ', '_');
  const std::string base = std::string(folder) + "/" + file;
  image::save_png(base + "_truth.png", truth).value_or_throw();
  image::save_png(base + "_drawn.png", drawn).value_or_throw();
  image::save_png(base + "_flip.png", image::heat_map(image::flip(truth, drawn))).value_or_throw();
}

TEST_F(TruthTest, SingleScatteringIsWhatItShouldBe) {
  const reference::NoiseTile noise = noise_tile();
  for (const TruthCase& one : truth_cases()) {
    SCOPED_TRACE(one.name);
    const auto simulation = stage::Simulation::create(one.stage).value_or_throw();
    simulation->advance_to(one.seconds);
    std::vector<shared::Hole> holes;
    const FrameInput input = input_of(one, *simulation, holes);
    const Drawn drawn = draw(one, input);

    reference::TruthScene truth;
    truth.camera = device_camera(input.camera, kSize);
    truth.size_px = kSize;
    truth.look = input.look;
    truth.time = one.seconds;
    truth.volume = input.volume;
    truth.holes = holes;
    const auto lights = passes::device_lights(one.stage.scene.lights, 64);
    truth.lights = lights;
    const auto triangles = reference::truth_triangles(one.stage.scene);
    truth.triangles = triangles;
    if (one.noisy) truth.noise = &noise;
    const auto pixels = reference::trace_truth(truth);

    std::vector<glm::dvec3> expected, over_truth;
    double transmittance = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      expected.push_back(pixels[i].picture());
      // The drawn smoke over the true surface.
      over_truth.push_back(glm::dvec3(drawn.smoke[i]) + drawn.smoke[i].w * pixels[i].surface);
      transmittance += std::abs(drawn.smoke[i].w - pixels[i].transmittance) / double(pixels.size());
    }
    const double exposure = double{input.exposure};
    const auto truth_shown = shown(expected, exposure);
    const auto smoke_shown = shown(over_truth, exposure), picture_shown = shown(drawn.picture, exposure);
    const double linear = psnr_of(expected, over_truth, exposure), toned = psnr_of(truth_shown, smoke_shown);
    std::printf(
        "%-20s smoke %.1f dB linear, %.1f dB shown; whole picture %.1f, %.1f; transmittance off by %.4f\n",
        one.name.c_str(), linear, toned, psnr_of(expected, drawn.picture, exposure),
        psnr_of(truth_shown, picture_shown), transmittance);
    keep(one.name + " smoke", truth_shown, smoke_shown);
    keep(one.name + " picture", truth_shown, picture_shown);
    EXPECT_GE(toned, kLeastPsnr);
    // A ray that is let through by less than look.stop is taken as shut: its mean is off by less than that.
    EXPECT_LT(transmittance, double{input.look.stop});
  }
}

}  // namespace
}  // namespace brume::render
