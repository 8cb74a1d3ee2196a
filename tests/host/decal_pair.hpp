// The renderer and the interface, which draw the same decals.
#pragma once

#include <glm/gtc/matrix_transform.hpp>

#include "grids/files/grid_files.hpp"
#include "scenario/slice_volumes.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {

/// Of an object in the middle of a box: less the further away, more of what faces up.
inline grids::DenseVolume occlusion_volume(glm::uvec3 size, double radius) {
  grids::DenseVolume volume(2);
  for (std::size_t c = 0; c < 2; ++c) {
    grids::DenseGrid& grid = volume[c];
    grid.name = c == 0 ? "up" : "down";
    grid.size = size;
    grid.box = {glm::dvec3(-1, -0.75, -1.25), glm::dvec3(1, 0.75, 1.25)};
    for (std::size_t i = 0; i < std::size_t{size.x} * size.y * size.z; ++i) {
      const glm::dvec3 voxel(i % size.x, i / size.x % size.y, i / size.x / size.y);
      const double away = glm::length(grid.box.low + grid.voxel_size() * (voxel + 0.5)) / radius;
      grid.values.push_back(static_cast<float>((c == 0 ? 1 : 0.6) / (1 + away * away)));
    }
  }
  return volume;
}

/// Decals on a ground, on walls and on oblique boxes.
class DecalPair : public HostedPair {
 protected:
  DecalPair() {
    scenario_.camera = {{-1.5f, 2.8f, 6.5f}, {-1.5f, 0.3f, 1}, 1};
    scene::Scene& scene = scenario_.scene;
    add_box(scene, {-5, 0.6f, 3}, 30, {1, 0.2f, 0.5f});
    add_box(scene, {-2.5f, 0.8f, 1}, 50, {-0.3f, 1, 0.4f});
    add_box(scene, {2, 0.7f, 3.5f}, 40, {1, 0.3f, -0.6f});
    add_box(scene, {4.5f, 0.5f, 0.5f}, -35, {1, 0, 0.2f});
    const voxel::GridLayout layout = scenario_.voxels.grid.layout();
    scenario_.voxels = scenario::load_or_voxelize(scene, layout, {}).value_or_throw();
    reads_occlusion_ = true;
    change_params_ = [&](brume_frame_params& params) { show(params); };
  }
  ~DecalPair() override {
    for (brume_decal* decal : decals_) EXPECT_OK(brume_decal_destroy(decal));
  }
  void TearDown() override {
    if (host_) host_->wait();
    normals_ = {};
    picture_ = {};
    HostedPair::TearDown();
    HostedSmoke::is_temporal = false;
  }
  static void add_box(scene::Scene& scene, glm::vec3 at, float degrees, glm::vec3 axis) {
    const glm::mat4 placed =
        glm::scale(glm::rotate(glm::translate(glm::mat4(1), at), glm::radians(degrees), glm::normalize(axis)),
                   glm::vec3(4));
    scene.objects.push_back({"box " + std::to_string(scene.objects.size()), 1, 0, placed});
  }

  std::filesystem::path save(const grids::DenseVolume& volume, const std::string& name) {
    grids::GridFile file;
    for (const grids::DenseGrid& grid : volume) file.grids.push_back(to_grid(grid));
    for (std::size_t i = 0; i < volume.size(); ++i) file.grids[i].name = volume[i].name;
    const std::filesystem::path path = folder_.path() / name;
    grids::save_grid_file(path, file).value_or_throw();
    return path;
  }
  /// Adds a decal of a file to both.
  scene::DecalOptions& add_decal(const std::filesystem::path& file, glm::vec3 at) {
    scene::DecalOptions options;
    options.file = file;
    options.position_world = at;
    options.scale = 1.6f;
    options.rotation = {10, 40, -20};
    scenario_.timeline.decals.push_back(options);
    return scenario_.timeline.decals.back();
  }
  /// Loads what was added.
  void load_decals() {
    scenario_.slices = scenario::load_slice_volumes(scenario_.timeline).value_or_throw();
    for (std::size_t i = decals_.size(); i < scenario_.timeline.decals.size(); ++i) {
      const std::string file = scenario_.timeline.decals[i].file.string();
      brume_decal_params params = brume_decal_defaults();
      params.file = file.c_str();
      params.grid = scenario_.timeline.decals[i].grid.c_str();
      decals_.push_back(nullptr);
      ASSERT_OK(brume_decal_create(context_.get(), &params, &decals_.back()));
    }
  }
  void add_three_decals() {
    const auto file = save(occlusion_volume({16, 12, 20}, 0.8), "one.brv");
    add_decal(file, {-4, 0.5f, 2.5f}).gamma = 0.6f;
    add_decal(file, {-1, 1, 2}).strength = 0.8f;
    scene::DecalOptions& other = add_decal(save(occlusion_volume({9, 8, 7}, 0.5), "two.brv"), {3, 0.8f, 2});
    other.scale = 2.4f;
    other.falloff = 2;
    other.correction = 0.5f;
    other.gamma = 2;
    other.fade = 0.2f;
    load_decals();
  }
  /// The decals of the timeline as the interface shows them.
  void show(brume_frame_params& params) {
    shown_.clear();
    for (std::size_t i = 0; i < decals_.size(); ++i) {
      const scene::DecalOptions& options = scenario_.timeline.decals[i];
      brume_shown_decal shown = brume_shown_decal_defaults(decals_[i]);
      const glm::mat4 world = scenario::world_from_file({}, options, 0);
      shown.x_axis = point_of(glm::vec3(world[0]));
      shown.y_axis = point_of(glm::vec3(world[1]));
      shown.z_axis = point_of(glm::vec3(world[2]));
      shown.position = point_of(glm::vec3(world[3]));
      shown.strength = options.strength;
      shown.gamma = options.gamma;
      shown.correction = options.correction;
      shown.falloff = options.falloff;
      shown.fade = options.fade;
      shown.scatter = options.scatter;
      shown_.push_back(shown);
    }
    params.decals = shown_.data();
    params.decal_count = shown_.size();
    if (normals_) params.normals = {normals_.view(), VK_IMAGE_LAYOUT_GENERAL, encoding_, of_view_, 0};
  }

  /// The renderer's own normals, from the last frame on.
  Pixels own_normals() {
    const gpu::Buffer copy = readback_buffer(*gpu_);
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      recording_->recorder().read_back(whole_->targets().gbuffer.normal_metallic, copy);
      recording_->end();
    });
    host_->wait();
    return pixels_of(copy);
  }
  shared::Camera camera() const { return planning::device_camera(scenario_.camera, kSize); }
  /// As the public header says, from the world's normals.
  glm::vec4 encoded(const glm::dvec4& own) const {
    glm::dvec3 n = glm::normalize(glm::dvec3(own));
    const shared::Camera view = camera();
    if (of_view_ != 0)
      n = {glm::dot(n, glm::normalize(glm::dvec3(view.right))),
           glm::dot(n, glm::normalize(glm::dvec3(view.up))), -glm::dot(n, glm::dvec3(view.forward))};
    glm::dvec3 stored = n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    if (stored.z < 0)
      stored = {(1 - std::abs(stored.y)) * (stored.x < 0 ? -1 : 1),
                (1 - std::abs(stored.x)) * (stored.y < 0 ? -1 : 1), 0};
    if (encoding_ <= BRUME_NORMALS_UNSIGNED) stored = n;
    if (encoding_ % 2 == 1) stored = (stored + 1.0) / 2.0;
    return {glm::vec3(stored), 1};
  }
  gpu::Image uploaded(const std::vector<glm::vec4>& texels, VkImageUsageFlags usage) {
    gpu::Image image(*gpu_, {.format = VK_FORMAT_R32G32B32A32_SFLOAT,
                             .size = {kSize, 1},
                             .usage = usage | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                      VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    const gpu::Recorder::Region all{std::as_bytes(std::span(texels)), glm::ivec3(0), {kSize, 1}};
    const gpu::Sampler nearest(*gpu_, {});
    host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
      recording_->begin(commands, frame, completed);
      recording_->recorder().upload(image, {&all, 1});
      recording_->recorder().prepare_for_draws({gpu::sampled(image, nearest)});  // into its layout
      recording_->end();
      host_->wait_for_compute(commands);
    });
    return image;
  }
  void upload_normals(const Pixels& own) {
    std::vector<glm::vec4> texels;
    for (const glm::dvec4& n : own) texels.push_back(encoded(n));
    host_->wait();
    normals_ = uploaded(texels, 0);
  }

  /// Where a frame's occlusion of both may differ by no more than 1/255: how many pixels it darkens.
  int expect_same_occlusion(std::size_t frame, const std::function<bool(std::size_t)>& compares) const {
    const Pixels own = pixels_of(occlusions_[2 * frame]), drawn = pixels_of(occlusions_[2 * frame + 1]);
    int darkened = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      EXPECT_GE(drawn[i].r, 0) << i;
      EXPECT_LE(drawn[i].r, 1) << i;
      if (!compares(i)) continue;
      EXPECT_NEAR(drawn[i].r, own[i].r, 1 / 255.0) << i % kSize.x << ' ' << i / kSize.x;
      darkened += own[i].r > 0.1;
    }
    return darkened;
  }
  int expect_same_occlusion(std::size_t frame) const {
    return expect_same_occlusion(frame, [](std::size_t) { return true; });
  }

  cli::WorkFolder folder_;
  api::Context context_;
  std::vector<brume_decal*> decals_;
  std::vector<brume_shown_decal> shown_;
  gpu::Image normals_, picture_;
  std::uint32_t encoding_ = BRUME_NORMALS_SIGNED, of_view_ = 0;
};

}  // namespace brume::host
