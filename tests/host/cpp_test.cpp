// The renderer's interface for C++.
#include <brume/brume_vulkan.hpp>

#include "spheres/file.hpp"
#include "tests/host/hosted_smoke.hpp"
#include "tests/work_folder.hpp"

namespace brume::host {
namespace {

TEST(CppInterface, IsTheCInterface) {
  gpu::HostApplication application(1);
  const api::Context context;
  api::Device device(context, params_of(application.device()));
  api::Renderer renderer(device, brume_renderer_defaults());

  // What has no frame.
  EXPECT_THROW(renderer.smoke(), api::Error);
  EXPECT_THROW(renderer.shadows(), api::Error);
  EXPECT_THROW(renderer.occlusion(), api::Error);
  EXPECT_THROW(renderer.coarseness(), api::Error);
  EXPECT_TRUE(renderer.timings().empty());
  EXPECT_THROW(renderer.record(nullptr, brume_frame_defaults()), api::Error);
  EXPECT_EQ(device.memory(), 0u);
  EXPECT_EQ(device.allocated_memory(), 0u);

  // What changes.
  renderer.resize(16, 9);
  EXPECT_THROW(renderer.resize(0, 9), api::Error);
  renderer.set_march_scale(2);
  renderer.set_lights({});
  try {
    renderer.set_march_scale(3);
    FAIL();
  } catch (const api::Error& error) {
    EXPECT_EQ(error.result(), BRUME_ERROR_ARGUMENT);
    EXPECT_EQ(std::string(error.what()), brume_last_error());
  }
  device.set_memory_limit(1 << 20);
  brume_frame_params refused = brume_frame_defaults();
  refused.picture.format = VK_FORMAT_R32_UINT;
  EXPECT_THROW(device.compile(brume_renderer_defaults(), refused), api::Error);

  // Assets.
  const cli::WorkFolder folder;
  const std::string file = (folder.path() / "tank.spheres").string();
  spheres::save_tank(file, {{4, 4, 4}, 0.1f, {{{2, 2, 2}, 1}}, {0xffffffff}}).value_or_throw();
  brume_tank_params tank_params = brume_tank_defaults();
  tank_params.file = file.c_str();
  api::Tank tank(context, tank_params);
  tank.set_lighting(brume_tank_lighting_defaults());
  EXPECT_EQ(tank.shown().tank, tank.get());
  const float occluded = 1;
  brume_decal_params decal_params = brume_decal_defaults();
  EXPECT_THROW(api::Decal(context, decal_params), api::Error);
  decal_params.up = &occluded;
  for (std::uint32_t& along : decal_params.size) along = 1;
  const api::Decal decal(context, decal_params);
  EXPECT_EQ(decal.shown().decal, decal.get());
  brume_volume_params volume_params = brume_volume_defaults();
  volume_params.file = "nowhere.brv";
  EXPECT_THROW(api::Volume(context, volume_params), api::Error);
  for (const std::string& message : application.take_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace brume::host
