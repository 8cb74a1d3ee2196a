// The march at a reduced resolution shows nothing that the full one hides, and draws no outlines: the
// comparison.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

#include "film/playback.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/render/truth_scenes.hpp"

namespace brume::render {

constexpr glm::uvec2 kSize{160, 90};
constexpr double kSeconds = 3;
/// Half of a crop of 90 rows out of 720 that are 60 degrees high, over its distance.
constexpr float kHalfCrop = 0.57735f * 90 / 720;

/// Somebody who looks, and a bright sign that faces them.
struct Pair {
  glm::vec3 eye, target;
  float sign_px;  // edge of the sign in the image
};

struct Shot {
  std::vector<std::array<std::uint8_t, 4>> display;
  std::vector<float> depth;  // reverse
};

/// A sign's place: the unit cube around it becomes the sign.
inline glm::mat4 sign_of(const Pair& pair) {
  const glm::vec3 back = glm::normalize(pair.eye - pair.target);
  const glm::vec3 right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back)), up = glm::cross(back, right);
  const float edge = pair.sign_px / 45 * kHalfCrop * glm::length(pair.eye - pair.target);
  return {glm::vec4(edge * right, 0), glm::vec4(edge * up, 0), glm::vec4(0.01f * back, 0),
          glm::vec4(pair.target, 1)};
}

/// Renders one time from many places.
class Eye {
 public:
  Eye(gpu::Context& context, gpu::CommandRunner& runner, const scenario::Scenario& scenario,
      const scenario::Simulation& simulation)
      : renderer_(context, runner, scenario.scene, options(scenario)) {
    input_ = frame_input(scenario, simulation, kSeconds, holes_);
  }
  const Renderer& look(const Pair& pair, std::uint32_t scale) {
    input_.view.camera = {pair.eye, pair.target, 2 * std::atan(kHalfCrop)};
    input_.level.grenades = {sign_of(pair)};
    renderer_.set_march_scale(scale);
    renderer_.draw(input_);
    return renderer_;
  }
  /// The last picture without its sign.
  const Renderer& look_past() {
    input_.level.grenades.clear();
    renderer_.draw(input_);
    return renderer_;
  }
  const Renderer& renderer() const { return renderer_; }

 private:
  static RendererOptions options(const scenario::Scenario& scenario) {
    RendererOptions options;
    options.size_px = kSize;
    options.smoke.masks = &scenario.masks;
    return options;
  }
  Renderer renderer_;
  std::vector<shared::Hole> holes_;
  FrameInput input_;
};

/// How reduced marches differ from full ones over many pairs, in steps of the display.
struct Findings {
  int hidden = 0, clear = 0;  // pairs by whether the full march shows the sign
  double excess = -1e9;       // most that a reduced march shows more of a sign
  // At pixels beside which the depth jumps: how much brighter the reduced march is on average, and how many
  // are off by more than 8.
  double outline = 0;
  std::size_t edge_pixels = 0, off_pixels = 0;
};

class FairnessTest : public gpu::GpuTest {
 protected:
  Shot shot(Eye& eye, const Pair& pair, std::uint32_t scale) {
    const Renderer& renderer = eye.look(pair, scale);
    return {read_back<std::array<std::uint8_t, 4>>(renderer.targets().display),
            read_back<float>(renderer.targets().gbuffer.depth)};
  }

  /// Mean of the display over the sign less that over a rim of 3 pixels around it, 0..255.
  static double contrast(const Shot& shot, const std::vector<float>& depth, const Pair& pair) {
    const float z = glm::length(pair.eye - pair.target), half = 0.5f * pair.sign_px;
    double sign = 0, rim = 0;
    int sign_count = 0, rim_count = 0;
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
      const glm::vec2 off = glm::abs(glm::vec2(i % kSize.x, i / kSize.x) + 0.5f - 0.5f * glm::vec2(kSize));
      const float from_edge = std::max(off.x, off.y) - half;
      if (from_edge > 3) continue;
      const auto& p = shot.display[i];
      const double value = (p[0] + p[1] + p[2]) / 3.0;
      if (from_edge < 0 && std::abs(0.05f / depth[i] - z) < 0.05f) {
        sign += value;
        ++sign_count;
      } else if (from_edge > 0) {
        rim += value;
        ++rim_count;
      }
    }
    return sign_count == 0 || rim_count == 0 ? 0 : sign / sign_count - rim / rim_count;
  }

  /// Adds what a pixel beside a jump of the depth shows.
  static void add_edges(const Shot& truth, const Shot& reduced, Findings& found) {
    const auto z = [&](std::uint32_t i) { return 1 / std::max(truth.depth[i], 1e-6f); };
    for (std::uint32_t i = kSize.x; i + kSize.x < kSize.x * kSize.y; ++i) {
      const float far = std::max({z(i - 1), z(i), z(i + 1), z(i - kSize.x), z(i + kSize.x)});
      const float near = std::min({z(i - 1), z(i), z(i + 1), z(i - kSize.x), z(i + kSize.x)});
      if (far < 1.1f * near) continue;
      int worst = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const int difference = reduced.display[i][c] - truth.display[i][c];
        found.outline += difference / 3.0;
        worst = std::max(worst, std::abs(difference));
      }
      ++found.edge_pixels;
      found.off_pixels += worst > 8;
    }
  }

  void expect_fair(const scenario::Scenario& scenario, const std::vector<Pair>& pairs) {
    const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
    simulation->advance_to(kSeconds);
    Eye eye(context(), runner(), scenario, *simulation);
    std::array<Findings, 2> at_scale;
    for (const Pair& pair : pairs) {
      const Shot truth = shot(eye, pair, 1);
      const double shown = contrast(truth, truth.depth, pair);
      for (const std::uint32_t scale : {2u, 4u}) {
        Findings& found = at_scale[scale / 4];
        const Shot reduced = shot(eye, pair, scale);
        ++(shown < 2 ? found.hidden : found.clear);
        found.excess = std::max(found.excess, contrast(reduced, truth.depth, pair) - shown);
        add_edges(truth, reduced, found);
      }
    }
    for (const std::uint32_t scale : {2u, 4u}) {
      const Findings& found = at_scale[scale / 4];
      const double outline = found.outline / static_cast<double>(found.edge_pixels);
      const double off = static_cast<double>(found.off_pixels) / static_cast<double>(found.edge_pixels);
      std::printf(
          "scale %u: %d hidden, %d not; at most %.2f more of a sign; %zu pixels at edges: %.3f brighter, "
          "%.3f %% off\n",
          scale, found.hidden, found.clear, found.excess, found.edge_pixels, outline, 100 * off);
      EXPECT_GT(found.hidden, static_cast<int>(pairs.size() / 10));
      EXPECT_GT(found.clear, static_cast<int>(pairs.size() / 10));
      // Two steps of 255: one that the display's dither makes, one that an eye does not see beside it.
      EXPECT_LT(found.excess, 2) << scale;
      EXPECT_LT(std::abs(outline), 0.1) << scale;
      EXPECT_LT(off, 0.005) << scale;
    }
  }

  /// Eyes and targets in free voxels between 2 and `reach` metres apart, with no wall between.
  static std::vector<Pair> random_pairs(const scenario::Scenario& scenario, glm::vec3 low, glm::vec3 high,
                                        float reach, std::size_t count) {
    std::mt19937 random(11);
    const auto between = [&](float a, float b) {
      return std::uniform_real_distribution<float>(a, b)(random);
    };
    const auto place = [&] {
      // One after the other: compilers differ in the order of arguments.
      const float z = between(low.z, high.z), y = between(low.y, high.y), x = between(low.x, high.x);
      return glm::vec3(x, y, z);
    };
    const auto free = [&](glm::vec3 p) {
      return scenario.voxels.grid.free(
          glm::ivec3(glm::floor(voxel::voxel_from_world(scenario.voxels.grid.layout(), p))));
    };
    std::vector<Pair> pairs;
    while (pairs.size() < count) {
      const Pair pair{place(), place(), between(4, 24)};
      const float apart = glm::length(pair.target - pair.eye);
      bool open = apart > 2 && apart < reach;
      for (float t = 0; open && t <= 1; t += 0.02f) open = free(glm::mix(pair.eye, pair.target, t));
      if (open) pairs.push_back(pair);
    }
    return pairs;
  }
};

}  // namespace brume::render
