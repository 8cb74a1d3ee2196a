// Volumes by particles on the device, and the same quads on the processor in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <optional>
#include <vector>

#include "passes/particles.hpp"
#include "passes/slice_textures.hpp"
#include "planning/device_camera.hpp"
#include "planning/particle_plan.hpp"
#include "shared/gbuffer.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/reference/slice_atlas.hpp"

namespace brume::passes {

using planning::ParticleInput;
using shared::ParticleSystem;

/// A volume of up to four channels, and what a device makes of it.
struct MaskVolume {
  std::vector<grids::DenseGrid> channels;
  reference::TexelVolume model;  ///< Rounded to halves.

  /// Of value(uvw), a vec4 of which the first `count` channels are stored.
  template <typename Value>
  MaskVolume(glm::uvec3 size, std::size_t count, Value value) : channels(count), model{glm::ivec3(size), {}} {
    for (grids::DenseGrid& channel : channels) channel.size = size;
    for (std::uint32_t i = 0; i < size.x * size.y * size.z; ++i) {
      const glm::uvec3 voxel(i % size.x, i / size.x % size.y, i / size.x / size.y);
      glm::vec4 texel = value((glm::vec3(voxel) + 0.5f) / glm::vec3(size));
      for (std::size_t c = 0; c < 4; ++c)
        if (c >= count) texel[static_cast<int>(c)] = 0;
      for (std::size_t c = 0; c < count; ++c) channels[c].values.push_back(texel[static_cast<int>(c)]);
      model.texels.emplace_back(from_half(to_half(texel)));
    }
  }
  glm::dvec4 sample(glm::dvec3 uvw) const {
    const bool inside = glm::all(glm::greaterThanEqual(uvw, glm::dvec3(0))) &&
                        glm::all(glm::lessThanEqual(uvw, glm::dvec3(1)));
    return inside ? model.sample(uvw) : glm::dvec4(0);
  }
};

/// A ring and a beam that fade towards the faces, where they are 0.
inline MaskVolume thruster(glm::uvec3 size) {
  return {size, 2, [&](glm::vec3 uvw) {
            const glm::vec3 to_face = glm::min(uvw, 1.0f - uvw) - 0.5f / glm::vec3(size);
            const float fade = glm::smoothstep(0.0f, 0.15f, std::min({to_face.x, to_face.y, to_face.z}));
            const float r = glm::length(glm::vec2(uvw) - 0.5f);
            const float ring = std::exp(-std::pow((r - 0.3f) / 0.08f, 2.0f) - 2 * uvw.z);
            const float beam = std::exp(-std::pow(r / (0.1f + 0.06f * uvw.z), 2.0f) - uvw.z);
            return fade * glm::vec4(ring, beam, 0, 0);
          }};
}

struct Scene {
  glm::uvec2 size_px{48, 40};
  shared::Camera camera{};
  std::vector<ParticleSystem> systems;
  std::vector<const MaskVolume*> volumes;  ///< Of each system.
  float surface_m = 0;                     ///< Distance of a wall across the view [m]; 0: none.
  glm::vec4 background{0, 0, 0, 1};

  glm::dvec3 ray(std::size_t pixel) const {
    const glm::dvec2 at(static_cast<double>(pixel % size_px.x) + 0.5,
                        static_cast<double>(pixel / size_px.x) + 0.5);
    const glm::dvec2 ndc = at / glm::dvec2(size_px) * 2.0 - 1.0;
    return glm::dvec3(camera.forward) + ndc.x * glm::dvec3(camera.right) - ndc.y * glm::dvec3(camera.up);
  }
  glm::dvec3 at(std::size_t pixel, double view_m) const {
    return glm::dvec3(camera.eye_world) + view_m * ray(pixel);
  }
  std::size_t pixels() const { return std::size_t{size_px.x} * size_px.y; }
};

/// What one scene drew.
struct Drawn {
  std::vector<glm::vec4> pixels;  ///< The image.
  std::vector<glm::vec4> layer;   ///< The particles alone.
  std::vector<shared::Particle> particles;
  std::vector<glm::uvec2> order;
};

class ParticlesFixture : public gpu::GpuTest {
 protected:
  void SetUp() override {
    pass().reserve({}, {1, 1});
    if (pass().layer().info().format != VK_FORMAT_R32G32B32A32_SFLOAT)
      GTEST_SKIP() << "the device cannot blend floats";
  }

  /// One for all tests: compiling its pipelines takes longer than most of them.
  static ParticlePass& pass() {
    static ParticlePass pass(context());
    return pass;
  }

  static gpu::Image target_image(glm::uvec2 size) {
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    info.size = {size, 1};
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return gpu::Image(context(), info);
  }

  static shared::Camera camera_of(glm::vec3 eye, glm::vec3 target, float fov, glm::uvec2 size) {
    return planning::device_camera({eye, target, fov}, size);
  }

  static SliceTextures slices_of(const std::vector<const MaskVolume*>& volumes) {
    std::vector<std::span<const grids::DenseGrid>> lists;
    for (const MaskVolume* volume : volumes) lists.emplace_back(volume->channels);
    return SliceTextures::create(context(), runner(), lists).value_or_throw();
  }

  /// Systems that display a volume each, with the places of their slices and particles.
  static void add(Scene& scene, const MaskVolume& volume, const ParticleInput& input) {
    const std::uint32_t first =
        scene.systems.empty() ? 0 : scene.systems.back().first + scene.systems.back().count;
    scene.volumes.push_back(&volume);
    scene.systems.push_back(planning::particle_system(input, {}));
    scene.systems.back().first = first;
  }

  /// Draws over the background, or with `overdraw` counts quads, as `pixels` of the result.
  Drawn draw(Scene scene, bool overdraw = false) {
    // What the pass reads.
    const SliceTextures slices = slices_of(scene.volumes);
    for (std::size_t i = 0; i < scene.systems.size(); ++i) scene.systems[i].slices = slices[i];
    shared::FrameConstants constants{};
    constants.camera = scene.camera;
    constants.size_px = scene.size_px;
    const gpu::Buffer frame = upload(std::vector{constants});
    const float depth = scene.surface_m > 0 ? scene.camera.near_z / scene.surface_m : 0.0f;
    const gpu::Image depths = upload_image(context(), runner(), scene.size_px, VK_FORMAT_R32_SFLOAT,
                                           std::vector<float>(scene.pixels(), depth));
    const gpu::Image target = target_image(scene.size_px);

    // The frame.
    pass().reserve(scene.systems, scene.size_px, overdraw);
    runner().run([&](gpu::Recorder& recorder) {
      const glm::vec4 b = overdraw ? glm::vec4(0) : scene.background;
      recorder.clear(target, {{b.x, b.y, b.z, b.w}});
      const ParticlePass::Inputs in{frame, slices.image(), depths};
      if (overdraw)
        pass().record_overdraw(recorder, in, scene.systems, target);
      else
        pass().record(recorder, in, scene.systems, target);
    });
    return read(scene, target);
  }

  Drawn read(const Scene& scene, const gpu::Image& target) {
    Drawn drawn;
    drawn.pixels = from_half(read_back<Half4>(target));
    std::size_t count = 0;
    for (const ParticleSystem& system : scene.systems) count += system.count;
    if (count == 0) return drawn;
    if (pass().layer().info().format == VK_FORMAT_R32G32B32A32_SFLOAT)
      drawn.layer = read_back<glm::vec4>(pass().layer());
    drawn.particles = read_back<shared::Particle>(pass().particles(), count);
    drawn.order = read_back<glm::uvec2>(pass().order(), count);
    return drawn;
  }

  /// What a pixel of the layer is, by the particles of the device in the order of their distances, and
  /// how many metres of slabs lie on it.
  struct Composed {
    glm::dvec4 value;
    double metres = 0;
  };
  static Composed compose(const Scene& scene, const Drawn& drawn, std::size_t pixel,
                          bool back_to_front = true) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < drawn.particles.size(); ++i)
      if (drawn.particles[i].view_m > 0) order.push_back(i);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
      return back_to_front == (drawn.particles[a].view_m > drawn.particles[b].view_m);
    });
    Composed composed{glm::dvec4(0, 0, 0, 1)};
    for (const std::size_t i : order) {
      const shared::Particle& particle = drawn.particles[i];
      const ParticleSystem& system = scene.systems[particle.system];
      const double view_m = double{particle.view_m};
      const glm::dvec3 p = scene.at(pixel, view_m);
      const double relative = glm::length(p - glm::dvec3(particle.centre_world)) / double{system.radius};
      if (relative >= 1) continue;
      const double surface = scene.surface_m > 0 ? double{scene.surface_m} : 1e9;
      const double soft = double{system.softness};
      const double fade =
          soft > 0 ? std::clamp((surface - view_m) / soft, 0.0, 1.0) * std::clamp(view_m / soft, 0.0, 1.0)
                   : (view_m < surface ? 1.0 : 0.0);
      const double metres =
          double{system.weight} * glm::length(scene.ray(pixel)) * std::pow(1 - relative * relative, 2) * fade;
      const glm::dvec3 uvw = glm::dmat4x3(matrix_of(system.uvw_from_world)) * glm::dvec4(p, 1);
      const glm::dvec4 value = scene.volumes[particle.system]->sample(uvw);
      const double depth =
          double{system.extinction} * std::max({value.x, value.y, value.z, value.w}) * metres;
      const double mean = depth > 1e-9 ? -std::expm1(-depth) / depth : 1;
      const glm::dvec3 emitted = glm::dmat4x3(matrix_of(system.tints)) * value * metres * mean;
      composed.value = glm::dvec4(emitted, 0) + std::exp(-depth) * composed.value;
      composed.metres += metres;
    }
    return composed;
  }

  /// Integrals of a system's channels, and of the square of their weighted sum, along the ray of a pixel [m].
  struct Line {
    glm::dvec4 values{0};
    double squares = 0, metres = 0;
  };
  static Line integrate(const Scene& scene, std::size_t pixel, glm::dvec4 weights, int steps = 2000) {
    const ParticleSystem& system = scene.systems[0];
    const glm::dmat4x3 uvw_from_world(matrix_of(system.uvw_from_world));
    const glm::dvec3 ray = scene.ray(pixel);
    const glm::dvec3 origin = uvw_from_world * glm::dvec4(glm::dvec3(scene.camera.eye_world), 1);
    const glm::dvec3 direction = uvw_from_world * glm::dvec4(ray, 0);
    double enter = 0, leave = 1e30;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = -origin[axis] / direction[axis], b = (1 - origin[axis]) / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    Line line;
    if (enter >= leave) return line;
    const double step = (leave - enter) / steps * glm::length(ray);
    line.metres = (leave - enter) * glm::length(ray);
    for (int i = 0; i < steps; ++i) {
      const glm::dvec4 value =
          scene.volumes[0]->sample(origin + (enter + (leave - enter) * (i + 0.5) / steps) * direction);
      line.values += value * step;
      line.squares += std::pow(glm::dot(value, weights), 2) * step;
    }
    return line;
  }

  /// Standard deviation of a pixel over independent centres, by shared/particles.h. Centres are drawn from
  /// the region, whose volume follows from the weight.
  static double deviation(const ParticleSystem& system, double squares) {
    const double area = std::numbers::pi * double{system.radius} * double{system.radius};
    const double region = double{system.weight} * system.count * area / 3;
    return std::sqrt(9 * region * squares / (5 * area * system.count));
  }
};

}  // namespace brume::passes
