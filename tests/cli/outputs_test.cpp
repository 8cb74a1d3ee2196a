// No command overwrites an input, another output, or a file of another kind.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>

#include "image/png.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

namespace fs = std::filesystem;
constexpr const char* kTimeline =
    "version = 1\nscene = \"room.obj\"\nduration = 0.5\n"
    "[[event]]\ntype = \"smoke\"\ntime = 0.0\nfrom = [0.0, 1.5, 1.0]\nat = [0.0, 0.5, -1.0]\n"
    "[[event]]\ntype = \"shot\"\ntime = 0.1\nfrom = [0.0, 1.5, 1.0]\ntoward = [0.0, 0.5, -1.0]\n"
    "shape = \"mask\"\nmask = \"mask.png\"\n";

class OutputFiles : public CommandTest {
 protected:
  OutputFiles() {
    folder_.write("room.obj", "mtllib room.mtl\nusemtl wall\n" + room_obj());
    folder_.write("room.mtl", "newmtl wall\nmap_Kd brick.png\n");
    folder_.write("room.toml", kTimeline);
    folder_.write("notes.txt", "my notes\n");
    for (const char* name : {"brick.png", "mask.png", "a.png", "b.png"}) save_picture(name);
  }
  void save_picture(const std::string& name) const {
    const image::Image8 picture{8, 8, std::vector<std::uint8_t>(4 * 8 * 8, 200)};
    image::save_png(folder_.path() / name, picture).value_or_throw();
  }
  // The command is refused, and no file changes.
  void refused(const Arguments& arguments, const std::vector<std::string>& parts, int exit_code = 2) const {
    const auto contents = [&] {
      std::vector<std::string> all;
      for (const std::string& name : folder_.files())
        all.push_back(fs::is_regular_file(folder_.path() / name) ? bytes(name) : "");
      return all;
    };
    const std::vector<std::string> before = contents();
    expect_failure(folder_, arguments, exit_code, parts);
    EXPECT_EQ(before, contents()) << testing::PrintToString(arguments);
  }
  // Also with --force.
  void never(const Arguments& arguments, const std::string& part) const {
    refused(arguments, {part, "is the input", "name another file"});
    refused(joined(arguments, {"--force"}), {part, "is the input"});
  }
};

TEST_F(OutputFiles, AreNeverAnInput) {
  never({"voxelize", "room.obj", "-o", "room.obj"}, "-o room.obj");
  never({"voxelize", "room.obj", "--obj", "room.obj"}, "--obj room.obj");
  never({"voxelize", "room.obj", "--json", "./room.obj"}, "--json ./room.obj");
  never({"sim", "room.toml", "--record", "room.toml"}, "--record room.toml");
  never({"diff", "a.png", "b.png", "-o", "a.png"}, "-o a.png");
  never({"diff", "a.png", "b.png", "--json", "b.png"}, "--json b.png");
  never({"info", "room.obj", "--json", "room.obj"}, "--json room.obj");
  never({"query", "room.toml", "--from", "0,1,1", "--to", "0,1,-1", "--time", "0.1", "--json", "room.toml"},
        "--json room.toml");
  never({"render", "room.obj", "--timeline", "room.toml", "-o", "r.png", "--json", "room.toml"},
        "--json room.toml");
#ifdef BRUME_VIEWER
  never({"view", "--play", "room.toml", "--record", "room.toml"}, "--record room.toml");
  never({"view", "--play", "room.toml", "--frame-log", "room.toml"}, "--frame-log room.toml");
  // A screenshot saves its timeline beside it.
  never({"view", "--play", "room.toml", "--screenshot", "room.png", "--exit-after", "1"}, "room.toml");
#endif
}

TEST_F(OutputFiles, AreNeverAFileThatTheSceneRefersTo) {
  never({"render", "room.toml", "-o", "brick.png"}, "-o brick.png");
  never({"render", "room.toml", "-o", "mask.png"}, "-o mask.png");
  never({"render", "room.obj", "-o", "brick.png"}, "-o brick.png");
  refused({"voxelize", "room.obj", "--json", "room.mtl", "--force"}, {"--json room.mtl", "is the input"});
  refused({"info", "room.obj", "--json", "brick.png", "--force"}, {"--json brick.png", "is the input"});
  refused({"sim", "room.toml", "--record", "room.obj", "--force"}, {"--record room.obj", "is the input"});
}

TEST_F(OutputFiles, AreNeverWhatATankIsMadeOf) {
  folder_.write("pal.json", "[\"#ff0000\", \"#0000ff\"]\n");
  const auto baked = [&](const Arguments& more) {
    return joined(words("bake spheres --size 20x20x20 --count 5 --palette"), more);
  };
  run_well(baked({"pal.json", "-o", "t.spheres"}));
  never(baked({"pal.json", "-o", "new.spheres", "--json", "pal.json"}), "--json pal.json: is the input;");
  never(baked({"pal.json:0.2-0.6", "-o", "new.spheres", "--json", "./pal.json"}), "is the input pal.json");

  const std::string tank =
      "version = 1\n[[camera]]\ntime = 0\nposition = [0, 0, 9]\ntarget = [0, 0, 0]\nopening = \"a.png\"\n"
      "[tank]\n";
  folder_.write("packed.toml", tank + "palette = \"pal.json:0-0.5\"\n");
  folder_.write("loaded.toml", tank + "file = \"t.spheres\"\n");
  // Faults of a scene hide no input, so that their report does not replace one either.
  folder_.write("bad.json", "{\"colours\": [\"#ff0000\"]}\n");
  folder_.write("faulty.toml", tank + "samples = 0\npalette = \"bad.json\"\n");
  struct Case {
    const char *scene, *input;
  };
  for (const auto& [scene, input] :
       {Case{"packed.toml", "pal.json"}, {"loaded.toml", "t.spheres"}, {"faulty.toml", "bad.json"}}) {
    for (const char* output : {input, "a.png"}) {
      const std::string text = std::string("--json ") + output;
      never({"render", scene, "-o", "new.png", "--size", "16x16", "--json", output}, text);
      never({"query", scene, "--sense", "0,0,2 0,0,0", "--json", output}, text);
      never({"info", scene, "--json", output}, text);
#ifdef BRUME_VIEWER
      never({"view", scene, "--json", output}, text);
      never({"view", scene, "--frame-log", output}, std::string("--frame-log ") + output);
#endif
    }
    never({"render", scene, "-o", "a.png"}, "-o a.png");
    never({"query", scene, "--sense", "0,0,2 0,0,0", "-o", "a.png"}, "-o a.png");
#ifdef BRUME_VIEWER
    never({"view", scene, "--screenshot", "a.png", "--exit-after", "1"}, "--screenshot a.png");
#endif
  }
}

// Which files a scene reads is not known when its text cannot be read.
TEST_F(OutputFiles, ThatAScenesMayReadAreNotReplacedByAnError) {
  folder_.write("pal.json", "{\"colors\": [\"#ff0000\", \"#0000ff\"]}\n");
  folder_.write("old.json", "{\"error\": {}}\n");
  folder_.write("broken.toml", "version = 1\n[tank]\npalette = \"pal.json\"\nsize =\n");
  refused({"render", "broken.toml", "-o", "new.png", "--json", "pal.json"}, {"broken.toml:4"}, 3);
  run_brume(folder_.path(), {"render", "broken.toml", "-o", "new.png", "--json", "old.json"});
  EXPECT_NE(bytes("old.json").find("broken.toml:4"), std::string::npos);
}

TEST_F(OutputFiles, AreComparedByFileAndNotByName) {
  fs::create_symlink("a.png", folder_.path() / "soft.png");
  fs::create_hard_link(folder_.path() / "a.png", folder_.path() / "hard.png");
  fs::create_symlink(".", folder_.path() / "here");
  never({"diff", "a.png", "b.png", "-o", "soft.png"}, "soft.png: is the input a.png");
  never({"diff", "a.png", "b.png", "-o", "hard.png"}, "hard.png: is the input a.png");
  never({"diff", "a.png", "b.png", "-o", "here/a.png"}, "here/a.png: is the input a.png");
  never({"diff", "soft.png", "b.png", "-o", "a.png"}, "a.png: is the input soft.png");
  refused({"diff", "a.png", "b.png", "-o", "map.png", "--json", "here/map.png"}, {"also the output of -o"});
  fs::create_symlink("map.png", folder_.path() / "later.png");
  refused({"diff", "a.png", "b.png", "-o", "map.png", "--json", "later.png"}, {"also the output of -o"});
}

TEST_F(OutputFiles, AreNotNamedTwice) {
  refused({"render", "room.obj", "-o", "q.png", "--json", "q.png"}, {"q.png", "is also the output of"});
  refused({"voxelize", "room.obj", "-o", "z.vxl", "--obj", "z.vxl"}, {"--obj z.vxl", "of -o"});
  refused({"voxelize", "room.obj", "--obj", "z", "--json", "z"}, {"--json z", "of --obj"});
  refused({"sim", "room.toml", "--record", "z", "--json", "z"}, {"--json z", "of --record"});
  // Nor does the error itself go into the file that was to be an image, from where expect_failure would take
  // it.
  run_brume(folder_.path(), {"render", "room.obj", "-o", "q.png", "--json", "q.png"});
  EXPECT_FALSE(fs::exists(folder_.path() / "q.png"));
}

TEST_F(OutputFiles, ReplaceNoFileOfAnotherKindWithoutForce) {
  const auto other = [&](const Arguments& arguments, const std::string& kind) {
    refused(arguments, {"exists and is no " + kind, "--force"});
  };
  other({"voxelize", "room.obj", "-o", "notes.txt"}, ".vxl file");
  other({"voxelize", "room.obj", "--obj", "notes.txt"}, ".obj file");
  other({"voxelize", "room.obj", "--json", "notes.txt"}, "JSON file");
  other({"sim", "room.toml", "--record", "a.png"}, ".brp file");
  other({"diff", "a.png", "b.png", "-o", folder_.write("map.png", "no map")}, ".png file");
  other({"render", "room.toml", "-o", folder_.write("film.mp4", "no film at all")}, ".mp4 file");
  other({"render", "room.toml", "-o", folder_.write("text.png", "text")}, ".png file");
  other({"render", "room.toml", "-o", folder_.write("text.exr", "text")}, ".exr file");
  other({"sim", "room.toml", "--volumes", folder_.write("text.vdb", "text")}, ".vdb file");
  folder_.write("text_1.brv", "text");
  other({"sim", "room.toml", "--volumes", "text_%d.brv"}, ".brv file");
  other({"info", "room.obj", "--json", folder_.write("room.gltf", "{\"asset\": {}}")}, "JSON file");
  other({"devices", "--json", "notes.txt"}, "JSON file");
#ifdef BRUME_VIEWER
  other({"view", "--play", "room.toml", "--record", "notes.txt"}, "timeline");
  other({"view", "--play", "room.toml", "--frame-log", "notes.txt"}, "frame log");
#endif

  folder_.write("empty", "");
  folder_.write("old.json", "  [1, 2]\n");
  for (const Arguments& to : {Arguments{"notes.txt", "--force"}, Arguments{"empty"}, Arguments{"old.json"}}) {
    run_well({"info", "room.obj", "--json"}, to);
    EXPECT_EQ(bytes(to[0]).front(), '{');
  }
}

TEST_F(OutputFiles, ThatAreNumberedFramesFollowTheSameRules) {
  const auto with = [&](const Arguments& more) {
    return joined(words("render room.toml --size 16x16 --frames 0-3"), more);
  };
  save_picture("wall_2.png");
  folder_.write("room.mtl", "newmtl wall\nmap_Kd wall_2.png\n");
  never(with({"-o", "wall_%d.png"}), "wall_2.png");
  refused(with({"-o", "f_%d.png", "--json", "f_3.png"}), {"f_3.png", "also the output"});
  folder_.write("g_1.png", "not a picture");
  refused(with({"-o", "g_%d.png"}), {"g_1.png: exists and is no .png file"});
  save_picture("h_0.png");
  fs::create_symlink("h_0.png", folder_.path() / "h_3.png");
  refused(with({"-o", "h_%d.png"}), {"h_3.png: is also the output"});
  // Without --frames the timeline says how many frames there are.
  refused({"render", "room.toml", "--size", "16x16", "--fps", "8", "-o", "h_%d.png"}, {"h_3.png"});
}

TEST_F(OutputFiles, ThatAreNoRegularFilesAreRefused) {
  ASSERT_EQ(::mkfifo((folder_.path() / "pipe").c_str(), 0600), 0);
  refused({"info", "room.obj", "--json", "pipe"}, {"pipe: is not a regular file"});
  refused({"info", "room.obj", "--json", "pipe", "--force"}, {"pipe: is not a regular file"});
  refused({"info", "room.obj", "--json", "/dev/null"}, {"/dev/null: is not a regular file"});
  refused({"diff", "pipe", "a.png"}, {"pipe: not a regular file"}, 3);
}

TEST_F(OutputFiles, AreWrittenThroughLinksWithTheirPermissions) {
  folder_.write("old.json", "{}");
  ASSERT_EQ(::chmod((folder_.path() / "old.json").c_str(), 0600), 0);
  fs::create_symlink("old.json", folder_.path() / "link.json");
  run_well({"info", "room.obj", "--json", "link.json"});
  EXPECT_TRUE(fs::is_symlink(folder_.path() / "link.json"));
  EXPECT_NE(bytes("old.json"), "{}");
  EXPECT_EQ(fs::status(folder_.path() / "old.json").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

// What is printed would otherwise end up in the file that gets the number of the closed descriptor.
TEST_F(OutputFiles, AreWholeWhenTheStandardDescriptorsAreClosed) {
  const Arguments arguments{"voxelize", "room.obj", "--voxel", "0.5", "--obj"};
  const auto to = [&](const std::string& name, bool closed) {
    Arguments all = arguments;
    all.push_back(name);
    RunOptions options;
    options.close_standard_descriptors = closed;
    return run_brume(folder_.path(), all, options).exit_code;
  };
  ASSERT_EQ(to("open.obj", false), 0);
  EXPECT_EQ(to("closed.obj", true), 4) << "its text cannot be printed";
  EXPECT_EQ(bytes("closed.obj"), bytes("open.obj"));
}

TEST_F(OutputFiles, HelpFailsOnAFullDevice) {
  RunOptions full;
  full.out_file = "/dev/full";
  EXPECT_EQ(run_brume(folder_.path(), {"--help"}, full).exit_code, 4);
}

}  // namespace
}  // namespace brume::cli
