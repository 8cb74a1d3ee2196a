// Decals in a host's frames, on the surfaces that the renderer draws with the same decals itself.
#include <array>

#include "tests/host/decal_pair.hpp"

namespace brume::host {
namespace {

using DecalsTest = DecalPair;

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
  const gpu::Buffer after = gpu::readback_buffer(*gpu_, before.size() * sizeof(glm::vec4));
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
  const auto drawn = gpu::values_of<glm::vec4>(after);
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
    params.continues_previous = continues ? 1 : 0;
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

// A tank becomes a surface, which smoke ends at; decals stay on the host's own surfaces behind it.
TEST_F(DecalsTest, StayBehindATank) {
  add_three_decals();
  for (scene::DecalOptions& decal : scenario_.timeline.decals) decal.scatter = 0;
  make_sides(1, 1);
  draw_both(1.0, 1);
  const std::array<float, 4> ball{8, 8, 8, 8};
  const std::uint32_t color = 0xff8080ffu;
  brume_tank_params params = brume_tank_defaults();
  for (std::uint32_t& along : params.size) along = 16;
  params.voxel = 0.1f;
  params.spheres = ball.data();
  params.colors = &color;
  params.sphere_count = 1;
  brume_tank* tank = nullptr;
  ASSERT_OK(brume_tank_create(context_.get(), &params, &tank));
  brume_shown_tank shown = brume_shown_tank_defaults(tank);
  shown.position = {-1.5f, 1, 3.5f};
  change_params_ = [&](brume_frame_params& frame) {
    show(frame);
    frame.tanks = &shown;
    frame.tank_count = 1;
  };
  draw_both(1.0, 1);
  host_->wait();
  EXPECT_GT(most_apart(texels_of(copies_[1]), texels_of(copies_[3])), 0.5) << "the tank is in view";
  const Pixels before = pixels_of(occlusions_[1]), behind = pixels_of(occlusions_[3]);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_EQ(behind[i].r, before[i].r) << i;
  EXPECT_OK(brume_tank_destroy(tank));
}

}  // namespace
}  // namespace brume::host
