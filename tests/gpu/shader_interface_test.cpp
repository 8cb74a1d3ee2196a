#include "gpu/shader_interface.hpp"

#include <array>

#include "brume_gpu_test_shaders.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace brume::gpu {
namespace {

constexpr shared::BindingIndex kConstants{0, "kConstants"}, kImage{2, "kImage"}, kOut{5, "kOut"},
    kValues{9, "kValues"};

ShaderInterface probe() {
  return reflect(shaders::interface_probe_comp).value_or_throw();
}

TEST(ShaderInterface, IsReadFromTheShader) {
  const ShaderInterface interface = probe();
  const std::vector<ShaderInterface::Binding> expected{
      {0, kUniform}, {2, kSampled}, {5, kStored}, {9, kBuffer}};
  EXPECT_EQ(interface.bindings, expected);
  EXPECT_EQ(interface.push_bytes, 80u);
  EXPECT_EQ(interface.group, (std::array<std::uint32_t, 3>{4, 3, 2}));
}

TEST(ShaderInterface, RefusesArraysOfResources) {
  const auto interface = reflect(shaders::array_probe_comp);
  ASSERT_FALSE(interface);
  EXPECT_NE(interface.failure().message.find("array_probe.comp: binding 0"), std::string::npos)
      << interface.failure().message;
}

TEST(ShaderInterface, FitsWhereNothingIsMissing) {
  const ShaderInterface offered = probe();
  ShaderInterface shader = offered;
  EXPECT_TRUE(check_fit(shader, offered));
  shader.bindings.pop_back();
  shader.push_bytes = 16;
  EXPECT_TRUE(check_fit(shader, offered));
  for (const auto& change : std::vector<std::function<void(ShaderInterface&)>>{
           [](ShaderInterface& s) {
             s.bindings.push_back({3, kBuffer});
           },
           [](ShaderInterface& s) { s.bindings[1].type = kStored; },
           [](ShaderInterface& s) { s.push_bytes = 84; }, [](ShaderInterface& s) { s.group[0] = 8; }}) {
    shader = offered;
    change(shader);
    EXPECT_FALSE(check_fit(shader, offered));
  }
}

/// One resource per binding of the probe.
class BindingsTest : public GpuTest {
 protected:
  static Image image() {
    ImageInfo info;
    info.format = VK_FORMAT_R8G8B8A8_UNORM;
    info.size = {24, 1, 1};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return Image(context(), info);
  }
  Buffer constants_ = upload(std::vector<float>{1, 2, 3, 0}),
         values_ = upload(std::vector<std::uint32_t>(24));
  Image in_ = image(), out_ = image();
  Sampler nearest_{context(), {VK_FILTER_NEAREST}};
  std::vector<BoundResource> all_{{kValues, write(values_)},
                                  {kImage, sampled(in_, nearest_)},
                                  {kConstants, uniform(constants_)},
                                  {kOut, stored(out_)}};
};

TEST_F(BindingsTest, AreMatchedByNumberInAnyOrder) {
  EXPECT_EQ(binding_fault(probe(), all_), "");
  const ComputePipeline pipeline(context(), shaders::interface_probe_comp);
  struct {
    glm::vec3 direction{10, 20, 30};
    std::uint32_t count = 24;
    glm::mat4 matrix{1};
  } push;
  runner().run([&](Recorder& recorder) {
    recorder.clear(in_, {});
    recorder.bind(pipeline, {all_[0], all_[1], all_[2], all_[3]}, push);
    recorder.dispatch_threads(pipeline, 1);
  });
  // 11 + 22 + 33 + 1
  EXPECT_EQ(read_back<std::uint32_t>(values_, 24), std::vector<std::uint32_t>(24, 67));
}

TEST_F(BindingsTest, OfBundlesAreWhatTheShaderHasAndTheListDoesNotBind) {
  const std::array<BoundResource, 3> bundle{
      {{kValues, read(values_)}, {{7, "kOther"}, read(values_)}, {kOut, stored(out_)}}};
  const std::array<BoundResource, 1> other{{{kImage, sampled(in_, nearest_)}}};
  const std::vector<BoundResource> own{{kConstants, uniform(constants_)}, {kValues, write(values_)}};
  const auto bound = with_bundles(probe(), {bundle, other}, own);
  EXPECT_EQ(binding_fault(probe(), bound), "");
  EXPECT_TRUE(bound[1].resource.writes) << "the list comes before bundles";
  EXPECT_EQ(binding_fault(probe(), with_bundles(probe(), {bundle}, own)),
            "binding 2, a sampled image, has no resource");
  EXPECT_EQ(binding_fault(probe(), with_bundles(probe(), {bundle, other, other}, own)),
            "binding 2, a sampled image, has more than one resource");
}

TEST_F(BindingsTest, FaultsNameTheBinding) {
  const std::pair<std::vector<BoundResource>, std::string> cases[] = {
      {{all_[0], all_[1], all_[2]}, "binding 5, a storage image, has no resource"},
      {{all_[0], all_[0], all_[1], all_[2], all_[3]},
       "binding 9, a storage buffer, has more than one resource"},
      {{{{7, "kOther"}, write(values_)}}, "has no kOther (binding 7)"},
      {{{kValues, uniform(constants_)}}, "kValues (binding 9) is a storage buffer, not a uniform buffer"},
  };
  for (const auto& [resources, message] : cases) EXPECT_EQ(binding_fault(probe(), resources), message);
}

}  // namespace
}  // namespace brume::gpu
