#include "apps/viewer/shader_reload.hpp"

#include <fstream>

#include "brume_shaders.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/gpu/gpu_test.hpp"

namespace brume::viewer {
namespace {

const std::filesystem::path kShaders = BRUME_SOURCE_DIR "/shaders";

class ShaderReloadTest : public gpu::GpuTest {
 protected:
  struct Change {
    std::string file, from, to;
  };

  /// Compiles display.comp with a substring of it, or of a file that it includes, replaced.
  static Result<std::vector<std::uint32_t>> compile(const cli::WorkFolder& folder, const Change& change) {
    std::filesystem::copy(kShaders, folder.path() / "shaders", std::filesystem::copy_options::recursive);
    const auto path = folder.path() / "shaders" / change.file;
    std::ifstream in(path);
    std::string text(std::istreambuf_iterator<char>(in), {});
    text.replace(text.find(change.from), change.from.size(), change.to);
    std::ofstream(path, std::ios::trunc) << text;
    return compile_shader(folder.path() / "shaders", "display.comp");
  }
};

TEST_F(ShaderReloadTest, CompilesAllShadersOfTheBuild) {
  for (const gpu::ShaderCode* built : {&shaders::display_comp, &shaders::march_comp, &shaders::ui_vert}) {
    const auto words = compile_shader(kShaders, built->name);
    ASSERT_TRUE(words) << words.failure().message;
    EXPECT_TRUE(std::equal(words->begin(), words->end(), built->words.begin(), built->words.end()))
        << built->name;
  }
}

TEST_F(ShaderReloadTest, ErrorsNameFileAndLine) {
  const cli::WorkFolder folder;
  const auto words = compile(folder, {"display.comp", "displayed(px", "no_such_function(px"});
  ASSERT_FALSE(words);
  EXPECT_NE(words.failure().message.find("display.comp:"), std::string::npos) << words.failure().message;
  EXPECT_NE(words.failure().message.find("no_such_function"), std::string::npos);
}

TEST_F(ShaderReloadTest, RefusesAnotherInterface) {
  const gpu::ComputePipeline pipeline(context(), shaders::display_comp);
  const std::vector<Change> changes{
      {"display.comp", "binding = kBindDisplay", "binding = 46"},
      {"display.comp", "local_size_x = 8", "local_size_x = 16"},
      {"lib/displayed.glsl", "binding = kBindBlueNoise", "binding = kBindFrame"}};
  for (const Change& change : changes) {
    const cli::WorkFolder folder;
    const auto words = compile(folder, change);
    ASSERT_TRUE(words) << words.failure().message;
    EXPECT_FALSE(check_fit(*words, pipeline, "display.comp")) << change.to;
  }
  const auto same = compile_shader(kShaders, "display.comp");
  ASSERT_TRUE(same);
  EXPECT_TRUE(check_fit(*same, pipeline, "display.comp"));
}

TEST_F(ShaderReloadTest, LaterPipelinesGetTheChangedShader) {
  const cli::WorkFolder folder;
  const auto copy = folder.path() / "shaders";
  std::filesystem::copy(kShaders, copy, std::filesystem::copy_options::recursive);
  ShaderReload reload(copy);
  gpu::Context device(gpu::ContextOptions{"", true});  // its pipelines end before the shaders of `reload`
  EXPECT_FALSE(reload.update(device));
  // A different time than that of the copy, whatever the resolution of the file system.
  std::filesystem::last_write_time(
      copy / "display.comp",
      std::filesystem::last_write_time(copy / "display.comp") + std::chrono::seconds(2));
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(10);  // only ends a hang
  while (reload.reloads() == 0 && std::chrono::steady_clock::now() < end) reload.update(device);
  ASSERT_EQ(reload.reloads(), 1u);
  const gpu::ComputePipeline made(device, shaders::display_comp);
  const gpu::Pipeline& pipeline = made;
  ASSERT_EQ(pipeline.shaders()[0].words.data(), shaders::display_comp.words.data());
  reload.update(device);
  EXPECT_NE(pipeline.shaders()[0].words.data(), shaders::display_comp.words.data());
  EXPECT_TRUE(reload.errors().empty());
  for (const std::string& message : device.take_validation_messages()) ADD_FAILURE() << message;
}

}  // namespace
}  // namespace brume::viewer
