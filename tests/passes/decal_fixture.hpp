// Decals over surfaces that tests choose, beside the same in double precision.
#pragma once

#include <array>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "passes/decals.hpp"
#include "planning/decal_plan.hpp"
#include "planning/device_camera.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"
#include "tests/reference/decal.hpp"

namespace brume::passes {

class DecalFixture : public gpu::GpuTest {
 protected:
  static constexpr double kUnit = 1.0 / (1 << 24);  ///< Half a unit in the last place of 1.

  explicit DecalFixture(glm::uvec2 size = {33, 17}) : gbuffer_(context(), {1, 1}) {
    // Uniform: each shift of a pixel's samples is as likely as any other.
    std::vector<glm::vec4> noise(64 * 64);
    for (glm::vec4& texel : noise) texel = {unit(), unit(), unit(), unit()};
    noise_texels_ = noise;
    noise_ = upload_image(context(), runner(), {64, 64}, VK_FORMAT_R32G32B32A32_SFLOAT, noise);
    resize(size);
  }

  float unit() { return std::uniform_real_distribution<float>(0, 1)(random_); }
  glm::vec3 random_vector() { return {2 * unit() - 1, 2 * unit() - 1, 2 * unit() - 1}; }
  std::size_t pixels() const { return depth_.size(); }

  /// Sky everywhere.
  void resize(glm::uvec2 size) {
    size_ = size;
    const std::size_t count = std::size_t{size.x} * size.y;
    depth_.assign(count, 0);
    normal_.assign(count, to_half({0, 1, 0, 0}));
    pass_.emplace(context(), size);
    set_camera(view_);
  }
  void set_camera(const scene::Camera& view) {
    view_ = view;
    camera_ = planning::device_camera(view, size_);
  }
  glm::dvec3 ray(std::size_t i) const {
    const glm::dvec2 ndc = (glm::dvec2(i % size_.x, i / size_.x) + 0.5) / glm::dvec2(size_) * 2.0 - 1.0;
    return glm::dvec3(camera_.forward) + ndc.x * glm::dvec3(camera_.right) - ndc.y * glm::dvec3(camera_.up);
  }
  glm::dvec3 p_world(std::size_t i) const {
    return glm::dvec3(camera_.eye_world) + double{camera_.near_z} / double{depth_[i]} * ray(i);
  }
  glm::dvec3 normal(std::size_t i) const { return glm::normalize(glm::dvec3(from_half(normal_[i]))); }
  glm::dvec2 weights(const reference::Decal& model, std::size_t i) const {
    return model.weights(p_world(i), normal(i));
  }
  bool moves(std::size_t i) const { return shared::moves_of(from_half(normal_[i]).a); }

  /// A plane that faces along +axis, as far as it is in view.
  void set_plane(int axis, double at) {
    for (std::size_t i = 0; i < pixels(); ++i) {
      const double z = (at - double{camera_.eye_world[axis]}) / ray(i)[axis];
      depth_[i] = z > 0.1 && z < 1000 ? static_cast<float>(double{camera_.near_z} / z) : 0.0f;
      glm::vec4 normal(0);
      normal[axis] = 1;
      normal_[i] = to_half(normal);
    }
  }
  /// Surfaces 3 to 7 m away that face anywhere; a fifth is sky, a fifth moves.
  void set_random_surfaces() {
    for (std::size_t i = 0; i < pixels(); ++i) {
      depth_[i] = unit() < 0.2f ? 0.0f : camera_.near_z / (3 + 4 * unit());
      const float metallic = shared::metallic_and_moves(unit(), unit() < 0.2f ? 1.0f : 0.0f);
      normal_[i] = to_half(glm::vec4(glm::normalize(random_vector()), metallic));
    }
  }

  /// A volume in a box; its place among the volumes.
  std::size_t add_volume(glm::uvec3 size, const Box<double>& box,
                         const std::function<glm::vec2(glm::uvec3)>& value) {
    grids::DenseVolume volume(2);
    for (std::size_t c = 0; c < 2; ++c) {
      volume[c].name = c == 0 ? "up" : "down";
      volume[c].size = size;
      volume[c].box = box;
      volume[c].values.resize(std::size_t{size.x} * size.y * size.z);
      for (std::size_t i = 0; i < volume[c].values.size(); ++i)
        volume[c].values[i] =
            value({i % size.x, i / size.x % size.y, i / size.x / size.y})[static_cast<int>(c)];
    }
    volumes_.push_back(std::move(volume));
    slices_.reset();
    return volumes_.size() - 1;
  }
  std::size_t add_random_volume(glm::uvec3 size, const Box<double>& box) {
    return add_volume(size, box, [&](glm::uvec3) { return glm::vec2(unit(), unit()); });
  }

  std::vector<planning::PlacedDecal> plan(const std::vector<planning::DecalInput>& decals) const {
    planning::FrameInput input;
    grids::DenseVolumes slices;
    for (const grids::DenseVolume& volume : volumes_)
      slices.push_back(std::make_shared<const grids::DenseVolume>(volume));
    input.slices = std::make_shared<const grids::DenseVolumes>(std::move(slices));
    input.decals = decals;
    const auto placed = planning::plan_decals(input, planning::ViewFrustum(camera_), {});
    return {placed.begin(), placed.end()};
  }

  /// The next frame has no past.
  void restart() { pass_.emplace(context(), size_); }
  /// What the pass stores: occlusion, number of samples, distance, spread.
  std::vector<glm::vec4> draw(const std::vector<planning::DecalInput>& inputs, bool continues = false,
                              std::uint32_t frame_index = 0) {
    // Upload.
    gbuffer_.depth = upload_image(context(), runner(), size_, VK_FORMAT_R32_SFLOAT, depth_);
    gbuffer_.normal_metallic =
        upload_image(context(), runner(), size_, VK_FORMAT_R16G16B16A16_SFLOAT, normal_);
    if (!slices_) {
      const std::vector<std::span<const grids::DenseGrid>> lists(volumes_.begin(), volumes_.end());
      slices_.emplace(SliceTextures::create(context(), runner(), lists).value_or_throw());
    }
    std::vector<shared::Decal> decals;
    for (const planning::PlacedDecal& placed : plan(inputs)) {
      decals.push_back(placed.decal);
      decals.back().occlusion = (*slices_)[placed.volume];
    }
    shared::FrameConstants frame{};
    frame.camera = camera_;
    frame.size_px = size_;
    frame.frame_index = frame_index;
    const gpu::Buffer frame_buffer = upload(std::vector{frame});

    // Draw.
    runner().run([&](gpu::Recorder& recorder) {
      pass_->upload(recorder, decals);
      pass_->record(recorder, frame_buffer, frame.size_px, gbuffer_, noise_, slices_->image(),
                    continues ? past_ : std::nullopt);
    });
    past_ = {planning::seen_from_world(camera_), glm::mat4(1), size_};
    return from_half(read_back<Half4>(pass_->occlusion()));
  }

  /// The same in double precision: where it is follows from the input alone.
  reference::Decal model_of(const planning::DecalInput& in) const {
    const grids::DenseVolume& volume = volumes_[in.volume];
    const grids::DenseGrid& grid = volume.front();
    reference::Decal model;
    model.occlusion.size = glm::ivec3(grid.size);
    for (std::size_t i = 0; i < grid.values.size(); ++i)
      model.occlusion.texels.emplace_back(
          from_half(to_half({volume[0].values[i], volume[1].values[i], 0, 0})));
    const glm::dmat4 box_from_world = glm::inverse(glm::dmat4(in.world_from_box));
    model.uvw_from_world = glm::scale(glm::dmat4(1), 1.0 / (grid.box.high - grid.box.low)) *
                           glm::translate(glm::dmat4(1), -grid.box.low) * box_from_world;
    // The plane y = 0 of the box stays orthogonal to it.
    model.up_world =
        glm::normalize(glm::cross(glm::dvec3(in.world_from_box[2]), glm::dvec3(in.world_from_box[0])) *
                       (glm::determinant(glm::dmat3(glm::dmat4(in.world_from_box))) < 0 ? -1.0 : 1.0));
    model.scatter = double{in.scatter} / glm::dvec3(grid.size);
    model.middle_world = glm::dvec3(glm::dmat4(in.world_from_box) * glm::dvec4(in.middle, 1));
    model.radius =
        double{in.radius} * std::cbrt(std::abs(glm::determinant(glm::dmat3(glm::dmat4(in.world_from_box)))));
    model.strength = in.strength;
    model.gamma_off = (double{in.gamma} - 1) * double{in.correction};
    model.falloff = in.falloff;
    model.fade = in.fade;
    return model;
  }

  /// How far floats may be off a model at a pixel. The ray of a pixel has relative errors of 12 units from
  /// its position in the image and 3 from its sums, the distance 5 from a division, their product and sum one
  /// each: 24 of them hold all. The matrix and the product with it round 6 times. Values: the bounds of
  /// slice_textures_test.cpp for the weights of texels in [0, 1]. Weights of the channels: 24 units for the
  /// angle to `up`; with a radius they are a quotient, at most 2.5, of sums of products with the vector to
  /// the middle, and its divisor is at least that vector's length or the radius: 4 times the vector's error,
  /// and 16 units more.
  reference::DecalErrors errors_of(const reference::Decal& model, std::size_t i) const {
    const double z = double{camera_.near_z} / double{depth_[i]};
    const double lengths = glm::length(glm::dvec3(camera_.forward)) + glm::length(glm::dvec3(camera_.right)) +
                           glm::length(glm::dvec3(camera_.up));
    const double off_world = 24 * kUnit * (glm::length(glm::dvec3(camera_.eye_world)) + z * lengths);
    const glm::dvec3 p = glm::abs(p_world(i));
    reference::DecalErrors errors;
    for (int axis = 0; axis < 3; ++axis) {
      double rounded = std::abs(model.uvw_from_world[3][axis]);
      for (int k = 0; k < 3; ++k) {
        const double entry = std::abs(model.uvw_from_world[k][axis]);
        errors.uvw[axis] += entry * off_world;
        rounded += entry * p[k];
      }
      errors.uvw[axis] += 6 * kUnit * rounded;
    }
    const double step = std::ldexp(1.0, -static_cast<int>(context().limits().subTexelPrecisionBits));
    const glm::dvec2 image(glm::uvec2(slices_->image().info().size));
    errors.value =
        2 * step + 17.5 * kUnit * (image.x + image.y) + 6.5 * kUnit * model.occlusion.size.z + 1e-6;
    const double distance = glm::length(model.middle_world - p_world(i));
    errors.weight = 24 * kUnit;
    if (model.radius > 0)
      errors.weight += 4 * (off_world + 8 * kUnit * (glm::length(p_world(i)) + distance)) /
                           std::min(model.radius, distance) +
                       16 * kUnit;
    errors.relative = 24 * kUnit;
    return errors;
  }

  /// What an image of half floats may hold of an occlusion that remains after `factors` of them.
  static reference::Interval stored(reference::Interval occlusion, std::size_t factors) {
    if (occlusion.low == 0 && occlusion.high == 0) return {};
    const double off = 4 * kUnit * static_cast<double>(factors + 2) + std::ldexp(1.0, -24);
    reference::Interval result = occlusion;
    result.low -= off;
    result.high += off;
    return reference::widened(result, std::ldexp(1.0, -10));
  }

  glm::uvec2 size_{1};
  std::vector<float> depth_;
  std::vector<Half4> normal_;
  scene::Camera view_{{0, 1, 5}, {0, 0.4f, 0}, 1.1f};
  shared::Camera camera_{};
  std::vector<grids::DenseVolume> volumes_;
  std::vector<glm::vec4> noise_texels_;
  std::mt19937 random_{5};

 private:
  GBuffer gbuffer_;
  gpu::Image noise_;
  std::optional<SliceTextures> slices_;
  std::optional<DecalPass> pass_;
  std::optional<planning::PastView> past_;
};

}  // namespace brume::passes
