// The C# layer of integrations/unity over libbrume-sim: its declarations are those of the header, and a match
// gives what it does in C.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <regex>
#include <sstream>
#include <vector>

#include "core/file.hpp"
#include "tests/api/run_shell.hpp"
#include "tests/work_folder.hpp"

namespace brume {
namespace {

using Strings = std::vector<std::string>;

Strings lines_of(const std::string& text) {
  Strings lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

/// Compiles the layer and the program that calls it, once for all tests.
class Mono : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (api::run_shell("command -v mcs && command -v mono").status != 0) return;
    folder_ = std::make_unique<cli::WorkFolder>();
    // Unity's compilers know C# 7.3. Nothing but the core library is referenced, which .NET Standard 2.0
    // contains.
    const api::ShellRun run =
        api::run_shell("mcs -langversion:7.2 -warn:4 -warnaserror -noconfig -out:'" + program() +
                       "' '" BRUME_SOURCE_DIR "'/integrations/unity/Runtime/*.cs '" BRUME_SOURCE_DIR
                       "'/tests/mono/*.cs 2>&1");
    ASSERT_EQ(run.status, 0) << run.output;
  }
  static void TearDownTestSuite() { folder_.reset(); }
  void SetUp() override {
    if (!folder_) GTEST_SKIP() << "Mono is not installed; script/bootstrap test installs it";
  }

  static std::string program() { return (folder_->path() / "checks.exe").string(); }
  /// Runs it; error messages are part of the output.
  static api::ShellRun checks(const std::string& arguments) {
    return api::run_shell("LD_LIBRARY_PATH=\"$(dirname '" BRUME_LIBRARY "')\" mono --debug '" + program() +
                          "' " + arguments + " 2>&1");
  }
  /// The match of tests/api/long_match.c, with its results in C.
  static std::string match_in_c() {
    const api::ShellRun run = api::run_shell("'" BRUME_LONG_MATCH "'");
    EXPECT_EQ(run.status, 0);
    folder_->write("match.txt", run.output);
    return run.output;
  }
  static std::string match_file() { return "'" + (folder_->path() / "match.txt").string() + "'"; }

  static inline std::unique_ptr<cli::WorkFolder> folder_;
};

TEST_F(Mono, DeclaresTheFunctionsOfTheLibrary) {
  const api::ShellRun run = checks("functions");
  ASSERT_EQ(run.status, 0) << run.output;
  Strings declared = lines_of(run.output);
  std::sort(declared.begin(), declared.end());
  const api::ShellRun exported = api::run_shell("nm --dynamic --defined-only '" BRUME_LIBRARY
                                                "' | sed -n 's/.* T \\(brume_[a-z0-9_]*\\).*/\\1/p'");
  Strings expected = lines_of(exported.output);
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(declared, expected);
}

// Sizes, offsets, constants and defaults: a C program finds the same values.
TEST_F(Mono, DeclaresWhatTheHeaderDoes) {
  const api::ShellRun run = checks("facts");
  ASSERT_EQ(run.status, 0) << run.output;
  const Strings facts = lines_of(run.output);
  std::string source = "#include <brume/brume_textures.h>\n#include <stdio.h>\nint main(void) {\n";
  for (const std::string& fact : facts) {
    const std::string expression = fact.substr(0, fact.find(" = "));
    source += "  printf(\"" + expression + " = %lld\\n\", (long long)(" + expression + "));\n";
  }
  folder_->write("facts.c", source + "  return 0;\n}\n");
  const std::string path = (folder_->path() / "facts").string();
  const api::ShellRun compared =
      api::run_shell(BRUME_C_COMPILER " -std=c11 -I'" BRUME_SOURCE_DIR "/include' '" + path +
                     ".c' '" BRUME_LIBRARY "' -Wl,-rpath,\"$(dirname '" BRUME_LIBRARY "')\" -o '" + path +
                     "' 2>&1 && '" + path + "'");
  ASSERT_EQ(compared.status, 0) << compared.output;
  EXPECT_EQ(lines_of(compared.output), facts);

  std::size_t count = 0;
  for (const char* name : {"brume.h", "brume_textures.h"}) {
    const std::string header = *read_text_file(BRUME_SOURCE_DIR "/include/brume/" + std::string(name));
    const std::regex structs(R"re(typedef struct (brume_\w+) \{)re");
    for (std::sregex_iterator at(header.begin(), header.end(), structs), end; at != end; ++at, ++count)
      EXPECT_NE(run.output.find("sizeof(" + (*at)[1].str() + ") = "), run.output.npos) << (*at)[1];
  }
  EXPECT_GT(count, 29u);
}

TEST_F(Mono, PlaysAMatchAsCDoes) {
  const std::string expected = match_in_c();
  const api::ShellRun run = checks("match " + match_file());
  ASSERT_EQ(run.status, 0) << run.output;
  EXPECT_GT(lines_of(run.output).size(), 150u);
  EXPECT_TRUE(expected.ends_with(run.output)) << run.output;
}

/// The block of C# in the page.
std::string example_of_the_page() {
  const std::string page = *read_text_file(BRUME_SOURCE_DIR "/docs/guides/unity.md");
  const std::size_t begin = page.find("```csharp\n"), end = page.find("\n```\n", begin);
  return begin == page.npos ? "" : page.substr(begin + 10, end - begin - 10);
}

// In a room of 16 m x 4 m x 18 m, whose middle the smoke fills.
TEST_F(Mono, TheExampleOfThePageRuns) {
  folder_->write("Example.cs", example_of_the_page() + R"(
public static class Example {
  public static void Main() {
    var points = new Point[8];
    for (int i = 0; i < 8; ++i)
      points[i] = new Point { X = (i & 1) != 0 ? 10 : -6, Y = (i & 2) != 0 ? 4 : 0,
                              Z = (i & 4) != 0 ? 10 : -8 };
    uint[] indices = { 0, 1, 4, 1, 4, 5, 2, 3, 6, 3, 6, 7, 0, 1, 2, 1, 2, 3, 4, 5, 6, 5, 6, 7, 0, 2, 4, 2,
                       4, 6, 1, 3, 5, 3, 5, 7 };
    using (var match = new SmokeMatch(points, indices)) {
      Point eye = new Point { X = 2, Y = 1.6f, Z = -6 }, target = new Point { X = 2, Y = 1.6f, Z = 8 };
      match.Step();
      Console.Write(match.Sees(eye, target));
      match.Throw(Units.Position(2, 1.5, 8), Units.Position(2, 0.5, 2));
      for (int i = 0; i < 128; ++i) match.Step();
      Console.Write(match.Sees(eye, target));
    }
  }
})");
  const std::string example = (folder_->path() / "example.exe").string();
  const api::ShellRun run = api::run_shell(
      "mcs -langversion:7.2 -noconfig -out:'" + example +
      "' '" BRUME_SOURCE_DIR "'/integrations/unity/Runtime/*.cs '" +
      (folder_->path() / "Example.cs").string() +
      "' 2>&1 && LD_LIBRARY_PATH=\"$(dirname '" BRUME_LIBRARY "')\" mono '" + example + "' 2>&1");
  EXPECT_EQ(run.output, "TrueFalse");
}

// The component of Samples~ against declarations of what it calls of Unity: a throw, with a light and a sun.
TEST_F(Mono, TheComponentGivesShadersTheSmoke) {
  folder_->write("View.cs", R"(using System;
using Brume;
using UnityEngine;
public static class View {
  public static void Main() {
    VoxelsParams settings = Defaults.Voxels();
    settings.Layout.Size = new Voxel { X = 16, Y = 8, Z = 16 };
    using (var context = new Context())
    using (Level level = Level.FromVoxels(context, settings, new byte[16 * 8 * 16 / 8], null))
    using (var world = new World(level))
    using (var field = new Field(level)) {
      WorldEvent grenade = Defaults.Event(EventKind.Smoke, 1);
      grenade.U.Smoke.From = grenade.U.Smoke.At = Units.Position(4, 2, 4);
      grenade.U.Smoke.Voxels = 200;
      world.Append(grenade);
      var view = new SmokeView();
      view.Lights = new[] { new Light { type = LightType.Point }, new Light { type = LightType.Directional } };
      view.Lights[1].transform.forward = new Vector3 { y = -1 };
      view.Follow(field);
      for (uint tick = 30; tick < 34; ++tick) {
        world.AdvanceTo(tick);
        using (State state = world.Snapshot()) field.Update(state);
        view.Show(field, tick / 64.0);
      }
      var sun = ((Vector4[])Shader.Globals["brume_light_positions"])[1];
      Console.Write(Shader.Globals.Count + " " + sun.y + " " + sun.w + " " + Shader.Globals["brume_light_volume"]);
    }
  }
})");
  const std::string view = (folder_->path() / "view.exe").string();
  const api::ShellRun run = api::run_shell(
      "mcs -langversion:7.2 -warn:4 -warnaserror -noconfig -out:'" + view +
      "' '" BRUME_SOURCE_DIR "'/integrations/unity/Runtime/*.cs '" BRUME_SOURCE_DIR
      "/integrations/unity/Samples~/SmokeView.cs' '" BRUME_SOURCE_DIR "/tests/mono/unity/Stubs.cs' '" +
      (folder_->path() / "View.cs").string() +
      "' 2>&1 && LD_LIBRARY_PATH=\"$(dirname '" BRUME_LIBRARY "')\" mono '" + view + "' 2>&1");
  EXPECT_EQ(run.status, 0) << run.output;
  EXPECT_EQ(run.output.substr(0, 7), "15 1 0 ") << run.output;
  EXPECT_TRUE(run.output.ends_with("UnityEngine.Texture3D")) << run.output;
}

TEST_F(Mono, CallsFailAndSucceedAsTheyShould) {
  match_in_c();
  const api::ShellRun run = checks("calls " + match_file());
  EXPECT_EQ(run.status, 0) << run.output;
}

// What a shader graph of Unity would include, by the compiler of shaders here.
TEST(UnityShader, Compiles) {
  const cli::WorkFolder folder;
  folder.write("graph.hlsl",
               "#include \"BrumeSmoke.hlsl\"\nfloat4 main(float4 at : TEXCOORD0) : SV_Target {\n"
               "  float3 color; float alpha;\n"
               "  BrumeSmoke_float(at.xyz, normalize(at.yzx), at.w, 0.5, 0.001, color, alpha);\n"
               "  return float4(color, alpha);\n}\n");
  const std::string path = folder.path().string();
  const api::ShellRun run = api::run_shell(
      "glslc -x hlsl -fshader-stage=fragment -fauto-bind-uniforms -fauto-map-locations -I '" BRUME_SOURCE_DIR
      "/integrations/unity/Shaders' -I '" BRUME_SOURCE_DIR "/shaders/export' '" +
      path + "/graph.hlsl' -o '" + path + "/graph.spv' 2>&1 && spirv-val '" + path + "/graph.spv' 2>&1");
  EXPECT_EQ(run.status, 0) << run.output;
}

}  // namespace
}  // namespace brume
