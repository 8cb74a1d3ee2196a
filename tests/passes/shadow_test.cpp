#include "passes/shadow.hpp"

#include "tests/gpu/gpu_test.hpp"
#include "tests/render/boxes.hpp"

namespace brume::passes {
namespace {

/// Counts what is submitted.
class CountingStream : public gpu::CommandStream {
 public:
  explicit CountingStream(gpu::CommandStream& stream) : stream_(stream) {}
  void run(const std::function<void(gpu::Recorder&)>& record) override {
    ++count;
    stream_.run(record);
  }
  int count = 0;

 private:
  gpu::CommandStream& stream_;
};

class ShadowTest : public gpu::GpuTest {};

/// Waiting for the device once a layer, of which each light has six, was most of the time of loading a scene.
TEST_F(ShadowTest, LayersShareSubmissions) {
  // A row of lights, with a box between the first two.
  constexpr int kLights = 51;
  scene::Scene scene;
  render::add_box(scene.meshes.emplace_back(), {0.9f, -0.1f, -0.1f}, {1.1f, 0.1f, 0.1f});
  scene.materials.resize(1);
  scene.objects = {{"box", 0, 0, glm::mat4(1)}};
  for (int i = 0; i < kLights; ++i) {
    scene::Light& light = scene.lights.emplace_back();
    light.position_world = {2 * i, 0, 0};
    light.intensity = glm::vec3(1.5f * 1.5f * light.least);  // ends after 1.5 m
  }
  CountingStream stream(runner());
  const SceneResources resources = upload_scene(context(), stream, scene);
  const ShadowPass pass(context());
  const ShadowMaps maps = pass.make_maps(context(), resources);
  ASSERT_EQ(maps.layers.info().layers, 6u * kLights);

  stream.count = 0;
  pass.record(context(), stream, resources, {}, maps);
  EXPECT_LE(stream.count, 11);

  const std::uint32_t box = 0;
  stream.count = 0;
  pass.record_changed(context(), stream, resources, {}, {&box, 1}, maps);
  EXPECT_EQ(stream.count, 1) << "two lights see it";
}

TEST_F(ShadowTest, ASunWithoutSurfacesTakesNoMap) {
  scene::Scene scene;
  scene.lights.emplace_back().kind = scene::LightKind::directional;
  const SceneResources resources = upload_scene(context(), runner(), scene);
  const ShadowPass pass(context());
  const ShadowMaps maps = pass.make_maps(context(), resources);
  EXPECT_EQ(maps.sun_map.info().size, glm::uvec3(1));
  pass.record(context(), runner(), resources, {}, maps);
  const glm::vec4 place = maps.sun_clip_from_world * glm::vec4(3, -5, 7, 1);
  EXPECT_EQ(place, glm::vec4(0, 0, 0, 1)) << "in the middle of the map, at its far side";
}

}  // namespace
}  // namespace brume::passes
