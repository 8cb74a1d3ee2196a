// Decals in a host's frames, on the surfaces that the renderer draws with the same decals itself.
#include <bit>
#include <glm/gtc/matrix_transform.hpp>

#include "grids/files.hpp"
#include "scenario/slice_volumes.hpp"
#include "tests/host/hosted_pair.hpp"
#include "tests/passes/half.hpp"
#include "tests/render/boxes.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

using Pixels = std::vector<glm::dvec4>;

Pixels pixels_of(const gpu::Buffer& halves) {
  Pixels pixels;
  for (const std::uint64_t texel : texels_of(halves))
    pixels.emplace_back(passes::from_half(std::bit_cast<passes::Half4>(texel)));
  return pixels;
}

/// Of an object in the middle of a box: less the further away, more of what faces up.
grids::DenseVolume occlusion_volume(glm::uvec3 size, double radius) {
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
class DecalsTest : public HostedPair {
 protected:
  DecalsTest() {
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
  ~DecalsTest() override {
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
    scene.objects.push_back({"box " + std::to_string(scene.objects.size()), 1, 0, placed, true});
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

// Both store a normal as halves: the host's follows from those of the renderer, and is stored again, so that
// they are 2^-11 apart or less along each axis. The weights of the planes change by less than three times the
// normal's change, as the middle of what hides is no further from these surfaces than three of its radii: 0.6
// of 1/255.
TEST_F(DecalsTest, AreThoseOfTheRendererInEachEncodingOfNormals) {
  add_three_decals();
  make_sides(2, 1);
  draw_both(1.0, 1);
  const Pixels own = own_normals();
  std::size_t frame = 0;
  for (const std::uint32_t encoding : {BRUME_NORMALS_SIGNED, BRUME_NORMALS_UNSIGNED, BRUME_NORMALS_OCTAHEDRAL,
                                       BRUME_NORMALS_OCTAHEDRAL_UNSIGNED})
    for (const std::uint32_t of_view : {0u, 1u}) {
      SCOPED_TRACE(std::to_string(encoding) + (of_view ? " of the view" : " of the world"));
      encoding_ = encoding;
      of_view_ = of_view;
      upload_normals(own);
      draw_both(1.0, 1);
      host_->wait();
      EXPECT_GT(expect_same_occlusion(++frame), 300);
      if (HasFailure()) return;
    }
}

// On a plane the normal of the depth is that of the plane but for what floats round: at 64 x 36 pixels less
// than 64 / 2 * 3 * 2^-24 of a depth of 1 or less, of surfaces no flatter than 1 : 50, far below what halves
// round.
TEST_F(DecalsTest, OfDepthAreThoseOfTheRendererAwayFromEdges) {
  add_three_decals();
  make_sides(2, 1);
  draw_both(1.0, 1);
  host_->wait();
  const Pixels own = own_normals();
  constexpr int kWidth = kSize.x, kHeight = kSize.y;
  const auto is_plane = [&](std::size_t i) {
    const int x = static_cast<int>(i % kSize.x), y = static_cast<int>(i / kSize.x);
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const int u = x + dx, v = y + dy;
        if (u < 0 || v < 0 || u >= kWidth || v >= kHeight) continue;
        if (own[static_cast<std::size_t>(u + v * kWidth)] != own[i]) return false;
      }
    return true;
  };
  EXPECT_GT(expect_same_occlusion(0, is_plane), 200);
}

TEST_F(DecalsTest, OfArraysAreThoseOfFiles) {
  const grids::DenseVolume volume = occlusion_volume({16, 12, 20}, 0.8);
  add_decal(save(volume, "both.brv"), {-4, 0.5f, 2.5f});
  add_decal(save(volume, "both.brv"), {2.5f, 0.5f, 2.5f}).grid = "up";
  scenario_.slices = scenario::load_slice_volumes(scenario_.timeline).value_or_throw();
  brume_decal_params params = brume_decal_defaults();
  params.up = volume[0].values.data();
  params.down = volume[1].values.data();
  for (int axis = 0; axis < 3; ++axis) params.size[axis] = volume[0].size[axis];
  params.low = point_of(glm::vec3(volume[0].box.low));
  params.high = point_of(glm::vec3(volume[0].box.high));
  decals_.resize(2);
  ASSERT_OK(brume_decal_create(context_.get(), &params, &decals_[0]));
  params.down = nullptr;
  ASSERT_OK(brume_decal_create(context_.get(), &params, &decals_[1]));
  make_sides(1, 1);
  draw_both(1.0, 1);
  upload_normals(own_normals());
  draw_both(1.0, 1);
  host_->wait();
  EXPECT_GT(expect_same_occlusion(1), 300);
}

// p becomes exposure * radiance + transmittance * (1 - occlusion) * p. Radiance, transmittance and occlusion
// are those of the images, exactly; the picture holds floats, which a device blends with 2^-10 at worst.
TEST_F(DecalsTest, DarkenThePictureInThePassOfTheMedia) {
  add_three_decals();
  // In smoke that the ground is seen through.
  scenario_.timeline.smoke.extinction = 0.4f;
  add_decal(scenario_.timeline.decals[0].file, {-5.5f, 0.4f, 0}).scale = 2.5f;
  load_decals();
  make_sides(1, 1);
  draw_both(2.0, 1);
  constexpr float kExposure = 1.5f;
  std::vector<glm::vec4> before;
  for (std::size_t i = 0; i < std::size_t{kSize.x} * kSize.y; ++i)
    before.emplace_back(0.1f + 0.01f * static_cast<float>(i % 97), 0.5f,
                        2 - 0.01f * static_cast<float>(i % 31), 1);
  picture_ = uploaded(before, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  const gpu::Buffer after(*gpu_, before.size() * sizeof(glm::vec4), VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          gpu::MemoryUse::readback);
  host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
    // Into the layout for attachments.
    gpu::Recorder::Attachments attachments;
    attachments.colours = {&picture_};
    attachments.keep = 1;
    recording_->begin(commands, frame, completed);
    recording_->recorder().begin_rendering(attachments, kSize);
    recording_->recorder().end_rendering();
    recording_->end();
  });
  host_->wait();
  host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
    change_params_ = [&](brume_frame_params& params) {
      show(params);
      params.picture = {picture_.view(), VK_FORMAT_R32G32B32A32_SFLOAT, kExposure};
    };
    record_interface(commands, frame, completed, 2.0);
  });
  host_->frame([&](VkCommandBuffer commands, std::uint64_t frame, std::uint64_t completed) {
    recording_->begin(commands, frame, completed);
    recording_->recorder().read_back(picture_, after);
    recording_->end();
  });
  host_->wait();
  const Pixels media = pixels_of(copies_.back()), occlusion = pixels_of(occlusions_.back());
  const auto* const drawn = reinterpret_cast<const glm::vec4*>(after.mapped());
  int in_both = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double remaining = media[i].a * (1 - occlusion[i].r);
    for (int c = 0; c < 3; ++c) {
      const double expected = double{kExposure} * media[i][c] + remaining * double{before[i][c]};
      EXPECT_NEAR(double{drawn[i][c]}, expected, std::ldexp(expected, -10) + 1e-6) << i;
    }
    in_both += media[i].a < 0.9 && occlusion[i].r > 0.1;
  }
  EXPECT_GT(in_both, 20);
}

TEST_F(DecalsTest, AreThoseOfTheRendererInAFilm) {
  HostedSmoke::is_temporal = true;
  const auto file = save(occlusion_volume({4, 4, 5}, 0.8), "coarse.brv");
  add_decal(file, {-3, 0.5f, 2.5f}).scatter = 2;
  load_decals();
  make_sides(2, 1);
  bool continues = false, shows = true;
  change_input_ = [&](planning::FrameInput& input) {
    input.view.continues = continues;
    if (!shows) input.decals.clear();
  };
  change_params_ = [&](brume_frame_params& params) {
    show(params);
    params.continues = continues ? 1 : 0;
    if (!shows) params.decal_count = 0;
  };
  draw_both(1.0, 1);
  upload_normals(own_normals());
  // A frame without decals ends what the film gathers.
  const std::vector<bool> with_decals{true, true, true, false, true, true};
  for (const bool with : with_decals) {
    shows = with;
    draw_both(1.0, 1);
    continues = true;
  }
  host_->wait();
  ASSERT_EQ(occlusions_.size(), 12u);
  for (std::size_t frame = 1; frame < 6; ++frame) EXPECT_GT(expect_same_occlusion(frame), 50) << frame;
  EXPECT_GT(most_apart(texels_of(occlusions_[3]), texels_of(occlusions_[5])), 1e-3) << "a sample a frame";
}

// Decals that come and go, and whose handles end.
TEST_F(DecalsTest, MayChangeFromFrameToFrame) {
  const auto one = save(occlusion_volume({16, 12, 20}, 0.8), "one.brv"),
             two = save(occlusion_volume({5, 5, 5}, 0.4), "two.brv");
  make_sides(3, 1);
  std::size_t frame = 0;
  const auto draw_with = [&](const std::filesystem::path& file) {
    scenario_.timeline.decals.clear();
    add_decal(file, {-3, 0.5f, 2.5f});
    for (brume_decal* decal : decals_) EXPECT_OK(brume_decal_destroy(decal));
    decals_.clear();
    load_decals();
    draw_both(1.0, 1);
  };
  draw_with(one);
  upload_normals(own_normals());
  for (const auto& file : {one, two, one, one, two}) draw_with(file);
  host_->wait();
  for (frame = 1; frame < 6; ++frame) EXPECT_GT(expect_same_occlusion(frame), 50) << frame;
  EXPECT_GT(most_apart(texels_of(occlusions_[3]), texels_of(occlusions_[5])), 0.05);
}

TEST_F(DecalsTest, AreNothingOutOfViewAndWithoutAFrame) {
  add_decal(save(occlusion_volume({4, 4, 4}, 0.8), "one.brv"), {-3, 0.5f, 2.5f});
  load_decals();
  make_sides(1, 1);
  const auto occlusion = [&] {
    VkImageView view = VK_NULL_HANDLE;
    return brume_renderer_occlusion(smoke_->renderer, nullptr, &view);
  };
  EXPECT_EQ(occlusion(), BRUME_ERROR_ORDER);
  draw_both(1.0, 1);
  EXPECT_OK(occlusion());
  scenario_.timeline.decals[0].position_world = {0, 0, 100};
  draw_both(1.0, 1);
  host_->wait();
  ASSERT_EQ(occlusions_.size(), 3u) << "the renderer has none";
  for (const glm::dvec4& pixel : pixels_of(occlusions_.back())) EXPECT_EQ(pixel.r, 0);
  EXPECT_OK(occlusion());
  EXPECT_OK(brume_renderer_resize(smoke_->renderer, kSize.x, kSize.y));
  EXPECT_EQ(occlusion(), BRUME_ERROR_ORDER);
  change_params_ = {};
  draw_both(1.0, 1);
  EXPECT_EQ(occlusion(), BRUME_ERROR_ORDER);
}

TEST_F(DecalsTest, AreRefusedWhereTheHeaderForbidsThem) {
  std::vector<float> values(8, 0.5f);
  brume_decal_params params = brume_decal_defaults();
  brume_decal* decal = nullptr;
  const auto refused = [&](brume_result expected, const char* words) {
    EXPECT_EQ(brume_decal_create(context_.get(), &params, &decal), expected);
    EXPECT_NE(std::string(brume_last_error()).find(words), std::string::npos) << brume_last_error();
    EXPECT_EQ(decal, nullptr);
  };
  refused(BRUME_ERROR_ARGUMENT, "up");
  params.up = values.data();
  refused(BRUME_ERROR_ARGUMENT, "size");
  for (std::uint32_t& along : params.size) along = 1u << 31;
  refused(BRUME_ERROR_LIMIT, "2^26");
  for (std::uint32_t& along : params.size) along = 2;
  values[7] = NAN;
  refused(BRUME_ERROR_ARGUMENT, "`up` must be finite");
  values[7] = 0;
  params.high.y = params.low.y;
  refused(BRUME_ERROR_ARGUMENT, "below `high`");
  params.low.x = NAN;
  refused(BRUME_ERROR_ARGUMENT, "low");
  params = brume_decal_defaults();
  params.file = "/nowhere/decal.brv";
  refused(BRUME_ERROR_DATA, "/nowhere/decal.brv");
  const std::string file = save(occlusion_volume({4, 4, 4}, 0.8), "one.brv").string();
  params.file = file.c_str();
  params.grid = "upp";
  refused(BRUME_ERROR_DATA, "up");
  params.up = values.data();
  refused(BRUME_ERROR_ARGUMENT, "null where `file`");
}

TEST_F(DecalsTest, OfAFrameAreRefusedWhereTheHeaderForbidsThem) {
  add_decal(save(occlusion_volume({4, 4, 4}, 0.8), "one.brv"), {-3, 0.5f, 2.5f});
  load_decals();
  make_sides(1, 1);
  brume_frame_params params = frame_of(scenario_, 1);
  params.frame = 1;
  params.depth.view = reinterpret_cast<VkImageView>(1);
  const auto refused = [&](const char* words) {
    EXPECT_EQ(brume_renderer_record(smoke_->renderer, nullptr, &params), BRUME_ERROR_ARGUMENT);
    EXPECT_NE(std::string(brume_last_error()).find(words), std::string::npos) << brume_last_error();
  };
  host_->frame([&](VkCommandBuffer commands, std::uint64_t, std::uint64_t) {
    params.commands = commands;
    params.decal_count = 1;
    refused("decals");
    std::vector<brume_shown_decal> shown(33, brume_shown_decal_defaults(decals_[0]));
    params.decals = shown.data();
    params.decal_count = 33;
    refused("at most 32 decals");
    params.decal_count = 2;
    shown[1].x_axis.y = NAN;
    refused("decal 1: its axes");
    shown[1].x_axis = shown[1].y_axis;
    refused("decal 1: its axes");
    shown[1].x_axis = {1, 0, 0};
    shown[1].position.z = 2e6f;
    refused("decal 1: its box");
    shown[1].position.z = 0;
    shown[1].x_axis = {1e-7f, 0, 0};
    refused("decal 1: its box");
    shown[1].x_axis = {1, 0, 0};
    shown[1].gamma = 0;
    refused("decal 1: `gamma`");
    shown[1].gamma = 1;
    params.normals.encoding = 4;
    refused("normals.encoding");
    params.normals.encoding = 0;
    params.normals.view = reinterpret_cast<VkImageView>(1);
    params.normals.layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    refused("normals.layout");
    params.normals.view = VK_NULL_HANDLE;
    shown[1].decal = nullptr;
    EXPECT_EQ(brume_renderer_record(smoke_->renderer, nullptr, &params), BRUME_ERROR_HANDLE);
  });
}

}  // namespace
}  // namespace brume::host
