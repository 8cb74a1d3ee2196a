// What the interface refuses of decals.
#include "tests/host/decal_pair.hpp"

namespace brume::host {
namespace {

using DecalArgumentsTest = DecalPair;

TEST_F(DecalArgumentsTest, AreRefusedWhereTheHeaderForbidsThem) {
  std::vector<float> values(8, 0.5f);
  brume_decal_params params = brume_decal_defaults();
  brume_decal* decal = nullptr;
  const auto refused = [&](brume_result expected, const char* words) {
    expect_refused(brume_decal_create(context_.get(), &params, &decal), expected, words);
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

TEST_F(DecalArgumentsTest, OfAFrameAreRefusedWhereTheHeaderForbidsThem) {
  add_decal(save(occlusion_volume({4, 4, 4}, 0.8), "one.brv"), {-3, 0.5f, 2.5f});
  load_decals();
  make_sides(1, 1);
  brume_frame_params params = frame_of(scenario_, 1);
  params.frame_number = 1;
  params.depth.view = reinterpret_cast<VkImageView>(1);
  const auto refused = [&](const char* words) {
    expect_refused(brume_renderer_record(smoke_->renderer, nullptr, &params), BRUME_ERROR_ARGUMENT, words);
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
    const auto refused_with = [&](const char* words, auto change) {
      shown[1] = shown[0];
      change(shown[1]);
      refused(words);
    };
    refused_with("decal 1: its axes", [](auto& decal) { decal.x_axis.y = NAN; });
    refused_with("decal 1: its axes", [](auto& decal) { decal.x_axis = decal.y_axis; });
    refused_with("decal 1: its box", [](auto& decal) { decal.position.z = 2e6f; });
    refused_with("decal 1: its box", [](auto& decal) { decal.x_axis = {1e-7f, 0, 0}; });
    refused_with("decal 1: `gamma`", [](auto& decal) { decal.gamma = 0; });
    shown[1] = shown[0];
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
