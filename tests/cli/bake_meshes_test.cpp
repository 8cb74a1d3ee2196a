// brume bake slices and brume bake occlusion.
#include <gtest/gtest.h>

#include "grids/files/grid_files.hpp"
#include "grids/files/slice_atlas.hpp"
#include "image/png.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {
using grids::SliceAtlas;

/// A closed box as an object, its faces outwards.
std::string box_obj(const std::string& name, glm::vec3 low, glm::vec3 high, int first = 1, bool lid = true) {
  std::string text = "o " + name + "\n";
  for (int corner = 0; corner < 8; ++corner)
    text += "v " + std::to_string(corner & 1 ? high.x : low.x) + " " +
            std::to_string(corner & 2 ? high.y : low.y) + " " + std::to_string(corner & 4 ? high.z : low.z) +
            "\n";
  const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                           {0, 2, 3, 1}, {4, 5, 7, 6}, {2, 6, 7, 3}};
  for (int face = 0; face < (lid ? 6 : 5); ++face) {
    text += "f";
    for (const int corner : faces[face]) text += " " + std::to_string(first + corner);
    text += "\n";
  }
  return text;
}

class BakeMeshes : public CommandTest {
 protected:
  BakeMeshes() {
    folder_.write("two.obj",
                  box_obj("ring", {-1, 0, -1}, {1, 2, 1}) + box_obj("beam", {2, 0, 0}, {3, 1, 4}, 9));
    folder_.write("open.obj", box_obj("cup", {-1, 0, -1}, {1, 2, 1}, 1, false));
  }
  SliceAtlas load(const std::string& json) const {
    return grids::load_slice_atlas(folder_.path() / json).value_or_throw();
  }
  /// What a channel holds in all [m^3].
  static double volume_of(const grids::DenseGrid& grid) {
    const glm::dvec3 voxel = grid.voxel_size();
    double sum = 0;
    for (const float value : grid.values) sum += double{value} * voxel.x * voxel.y * voxel.z;
    return sum;
  }
};

TEST_F(BakeMeshes, ObjectsGoToChannelsByName) {
  const Json json =
      json_of({"bake", "slices", "two.obj", "-o", "a.png", "--channels", "ring:r,beam:g", "--bits", "16"});
  EXPECT_EQ(json["image_size"], (Json{2048, 64}));
  EXPECT_EQ(json["tiles"], 32);
  EXPECT_EQ(json["channels"], (Json{"ring", "beam"}));
  EXPECT_EQ(folder_.files(), (Arguments{"a.json", "a.png", "open.obj", "two.obj"}));
  const SliceAtlas atlas = load("a.json");
  // Each texel is off by at most half a step of 16 bits, of a box of 4.3 x 2.2 x 5.3 m.
  EXPECT_NEAR(volume_of(atlas.channels[0]), 8, 52 * 0.5 / 65535);
  EXPECT_NEAR(volume_of(atlas.channels[1]), 4, 52 * 0.5 / 65535);
  // A voxel around everything.
  const grids::DenseGrid& grid = atlas.channels[0];
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(grid.box.low[axis] + grid.voxel_size()[axis], axis == 1 ? 0 : -1, 1e-6);
    EXPECT_NEAR(grid.box.high[axis] - grid.voxel_size()[axis], axis == 0 ? 3 : axis == 1 ? 2 : 4, 1e-6);
  }
}

// Only shapes are baked; voxels have roles, which images with alpha decide.
TEST_F(BakeMeshes, ImagesThatAreNotUsedAreNotMissed) {
  folder_.write("m.mtl", "newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd leaf.png\nmap_d leaf.png\n");
  folder_.write("textured.obj", "mtllib m.mtl\nusemtl a\n" + box_obj("ring", {-1, 0, -1}, {1, 2, 1}) +
                                    "usemtl b\n" + box_obj("beam", {2, 0, 0}, {3, 1, 4}, 9));
  const std::string size = "8x8x8";
  EXPECT_EQ(run({"bake", "slices", "textured.obj", "-o", "a.png", "--size", size}).error, "");
  EXPECT_EQ(run({"bake", "occlusion", "textured.obj", "-o", "b.png", "--size", size}).error, "");
  const Outcome voxels = run({"voxelize", "textured.obj", "-o", "a.vxl"});
  EXPECT_NE(voxels.error.find("leaf.png"), std::string::npos) << voxels.error;
  EXPECT_EQ(voxels.error.find("gone.png"), std::string::npos) << voxels.error;
}

TEST_F(BakeMeshes, ABoxChoosesWhatIsBaked) {
  const Json json =
      json_of({"bake", "slices", "two.obj", "-o", "a.png", "--box", "-2,-1,-2 0,1,2", "--size", "16x8x24"});
  EXPECT_EQ(json["box"]["low"], (Json{-2.0, -1.0, -2.0}));
  EXPECT_EQ(json["tiles"], 24);
  const SliceAtlas atlas = load("a.json");
  EXPECT_EQ(atlas.channels[0].name, "density");
  // A quarter of the ring; each of 3,072 texels within half a step of 16 m^3.
  EXPECT_NEAR(volume_of(atlas.channels[0]), 2, 16 * 0.5 / 255);
}

TEST_F(BakeMeshes, AnotherFilesDescriptionIsNotReplaced) {
  const std::string package = R"({"name": "mine", "version": 3})";
  folder_.write("a.json", package);
  expect_failure(folder_, {"bake", "slices", "two.obj", "-o", "a.png"}, 2, {"a.json", "--force"});
  EXPECT_EQ(read_text_file(folder_.path() / "a.json").value_or_throw(), package);
  run_well({"bake", "slices", "two.obj", "-o", "a.png", "--force"});
  EXPECT_EQ(run({"bake", "slices", "two.obj", "-o", "a.png"}).exit_code, 0) << "its own it is";
}

TEST_F(BakeMeshes, AnImageIsReadOnlyIfTheDescriptionNamesIt) {
  run_well({"bake", "slices", "two.obj", "-o", "a.png", "--size", "8x8x8"});
  run_well({"bake", "slices", "two.obj", "-o", "a.exr", "--size", "9x9x9"});
  expect_failure(folder_, {"convert", "a.png", "b.brv"}, 3, {"a.png", "a.json", "a.exr"});
  expect_failure(folder_, {"render", "a.png", "-o", "b.png"}, 3, {"a.png", "a.json", "a.exr"});
  expect_failure(folder_, {"info", "a.png"}, 3, {"a.png", "a.json", "a.exr"});
  run_well({"info", "a.exr"});
}

TEST_F(BakeMeshes, EveryPresetComesBackAsTheSameVolume) {
  run_well({"bake", "slices", "two.obj", "-o", "plain.png", "--size", "12x8x20"});
  const grids::DenseGrid plain = load("plain.json").channels[0];
  for (const char* preset : {"unreal", "unity", "godot", "houdini"}) {
    run_well({"bake", "slices", "two.obj", "-o", "a.png", "--size", "12x8x20", "--preset", preset,
              "--padding", "2"});
    const SliceAtlas atlas = load("a.json");
    EXPECT_EQ(atlas.channels[0].values, plain.values) << preset;
    EXPECT_EQ(atlas.layout.tiles() % atlas.layout.columns, 0u) << "importers make a slice of each place";
  }
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "a.png.import"));
}

TEST_F(BakeMeshes, WarnsOfAMeshThatIsNotClosed) {
  const Outcome baked =
      run_well({"bake", "slices", "open.obj", "-o", "a.png", "--channels", "cup:r", "--size", "16x16x16"});
  EXPECT_NE(baked.error.find("open.obj: cup has 4 open edges"), std::string::npos) << baked.error;
  const double volume = volume_of(load("a.json").channels[0]);
  EXPECT_GT(volume, 4);
  EXPECT_LT(volume, 8.5);
}

TEST_F(BakeMeshes, VolumesKeepTheirVoxels) {
  run_well({"bake", "sphere", "-o", "ball.brv", "--edge", "24"});
  run_well({"bake", "slices", "ball.brv", "-o", "a.exr", "--bits", "32", "--layout", "5"});
  run_well({"convert", "a.json", "back.brv"});
  const auto values = [&](const char* file) {
    const grids::GridFile grids = grids::load_grid_file(folder_.path() / file).value_or_throw();
    const grids::Grid* const only = grids.grids.data();
    return grids::resample(*only, {glm::dmat4(1), {glm::dvec3(-0.6), glm::dvec3(0.6)}, glm::uvec3(24)})
        .value_or_throw()
        .values;
  };
  EXPECT_EQ(values("back.brv"), values("ball.brv"));
}

// "brume info" and "brume convert" open the image as well as its description.
TEST_F(BakeMeshes, AnAtlasIsAVolume) {
  run_well({"bake", "slices", "two.obj", "-o", "a.png", "--size", "12x8x20"});
  for (const char* file : {"a.png", "a.json"}) {
    const Json info = json_of({"info", file});
    EXPECT_EQ(info["kind"], "volumes");
    EXPECT_EQ(info["axes"], "+x -y +z");
    EXPECT_EQ(info["grids"][0]["active_voxels"], 12 * 8 * 20);
    run_well({"convert", file, "b.vdb"});
  }
  expect_failure(folder_, {"convert", "a.png", "a.json"}, 2, {"a.json", "input"});
}

TEST_F(BakeMeshes, RefuseBadOptions) {
  const auto refuse = [&](const Arguments& more, int code, const std::vector<std::string>& parts) {
    expect_failure(folder_, joined({"bake", "slices"}, more), code, parts);
  };
  refuse({"two.obj", "-o", "a.jpg"}, 2, {"a.jpg", ".png or .exr"});
  refuse({"two.obj", "-o", "a.png", "--channels", "rong:r"}, 2, {"rong", "did you mean ring"});
  refuse({"two.obj", "-o", "a.png", "--channels", "ring:g"}, 2, {"channel r is empty"});
  refuse({"two.obj", "-o", "a.png", "--channels", "ring"}, 2, {"expected names and channels"});
  refuse({"two.obj", "-o", "a.png", "--size", "0x4x4"}, 2, {"--size"});
  refuse({"two.obj", "-o", "a.png", "--size", "99999x4x4"}, 2, {"--size"});
  refuse({"two.obj", "-o", "a.png", "--size", "16384x16384x16384"}, 4, {"too large"});
  refuse({"two.obj", "-o", "a.png", "--box", "nan,0,0 1,1,1"}, 2, {"--box"});
  refuse({"two.obj", "-o", "a.png", "--box", "1,1,1 0,0,0"}, 2, {"--box", "empty"});
  refuse({"two.obj", "-o", "a.png", "--layout", "0"}, 2, {"--layout"});
  refuse({"two.obj", "-o", "a.png", "--layout", "33"}, 4, {"33"});
  refuse({"two.obj", "-o", "a.png", "--bits", "32"}, 2, {"--bits 32", ".exr"});
  refuse({"two.obj", "-o", "a.png", "--bits", "9"}, 2, {"--bits 9"});
  refuse({"two.obj", "-o", "a.png", "--range", "1,0"}, 2, {"--range"});
  refuse({"two.obj", "-o", "a.png", "--axes", "+x +x +z"}, 2, {"--axes"});
  refuse({"two.obj", "-o", "a.png", "--axes", "+x -y +z", "--preset", "unity"}, 2, {"--axes"});
  refuse({"two.obj", "-o", "a.png", "--preset", "unrael"}, 2, {"unreal"});
  refuse({"two.obj", "-o", "missing/a.png"}, 2, {"missing"});
  refuse({"missing.obj", "-o", "a.png"}, 3, {"missing.obj"});
}

// The bytes of a description that lies: one line, and nothing is written.
TEST_F(BakeMeshes, RefuseAtlasesThatLie) {
  run_well({"bake", "slices", "two.obj", "-o", "a.png", "--size", "12x8x20"});
  const std::string good = *read_text_file(folder_.path() / "a.json");
  for (const auto& [from, to] :
       std::vector<std::pair<std::string, std::string>>{{"\"tiles\": 20", "\"tiles\": 0"},
                                                        {"\"tiles\": 20", "\"tiles\": 21"},
                                                        {"\"columns\": 20", "\"columns\": -1"},
                                                        {"\"padding\": 0", "\"padding\": 3"},
                                                        {"\"a.png\"", "\"../a.png\""},
                                                        {"\"unorm8\"", "\"unorm16\""},
                                                        {"\"low\": [", "\"low\": [NaN,"}}) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    folder_.write("a.json", text);
    expect_failure(folder_, {"convert", "a.json", "b.vdb"}, 3, {"a.json"});
    expect_failure(folder_, {"render", "a.json", "-o", "b.png"}, 3, {"a.json"});
  }
  folder_.write("a.json", good);
  image::NumberImage small{4, 4, 1, 8, std::vector<std::uint16_t>(16)};
  image::save_png(folder_.path() / "a.png", small).value_or_throw();
  expect_failure(folder_, {"convert", "a.json", "b.vdb"}, 3, {"a.png: has 4 x 4 texels"});
}

// The atlases of the scenes are what scenes/bake_atlases makes of their meshes: coverage the same bytes on
// every machine.
TEST_F(BakeMeshes, ScenesHaveTheirAtlases) {
  const std::filesystem::path scenes = std::filesystem::path(BRUME_SOURCE_DIR) / "scenes/thruster";
  const auto expect_same = [&](const std::string& name, const Arguments& more) {
    run_well({"bake", "slices", scenes / (name + ".glb"), "-o", name + ".png"}, more);
    for (const char* suffix : {".png", ".json"})
      EXPECT_EQ(read_file(folder_.path() / (name + suffix)).value_or_throw(),
                read_file(scenes / (name + suffix)).value_or_throw())
          << name << suffix << ": run scenes/bake_atlases";
  };
  expect_same("thruster", {"--channels", "ring:r,beam:g"});
  expect_same("flame", {"--channels", "sheath:r,core:g", "--size", "48x48x128", "--layout", "16"});
}

TEST_F(BakeMeshes, OcclusionIsAroundTheMesh) {
  const Json json = json_of({"bake", "occlusion", "two.obj", "--object", "ring", "-o", "ao.png", "--size",
                             "12x10x14", "--rays", "64"});
  EXPECT_EQ(json["tiles"], 10) << "a tile is a plane";
  EXPECT_EQ(json["triangles"], 12);
  const SliceAtlas atlas = load("ao.json");
  ASSERT_EQ(atlas.channels.size(), 3u);
  EXPECT_EQ(atlas.channels[0].name, "combined");
  EXPECT_EQ(atlas.channels[1].name, "up");
  EXPECT_EQ(atlas.channels[2].name, "down");
  const grids::DenseGrid &up = atlas.channels[1], &down = atlas.channels[2];
  // Below the box what faces up sees it, above it what faces down; beside it is less of both.
  EXPECT_GT(up.values[up.index({6, 1, 7})], 0.2f);
  EXPECT_EQ(down.values[up.index({6, 1, 7})], 0);
  EXPECT_GT(down.values[up.index({6, 8, 7})], 0.2f);
  EXPECT_EQ(up.values[up.index({6, 8, 7})], 0);
  EXPECT_EQ(up.values[up.index({6, 5, 7})], 1) << "inside";
}

TEST_F(BakeMeshes, OcclusionInImagesOfTheirOwn) {
  run_well({"bake", "occlusion", "two.obj", "-o", "ao.png", "--size", "8x8x8", "--rays", "16", "--separate",
            "--gamma", "0.5"});
  EXPECT_EQ(folder_.files(), (Arguments{"ao.json", "ao.png", "ao_down.json", "ao_down.png", "ao_up.json",
                                        "ao_up.png", "open.obj", "two.obj"}));
  EXPECT_EQ(load("ao_up.json").channels.size(), 1u);
}

TEST_F(BakeMeshes, OcclusionRefusesBadOptions) {
  const auto refuse = [&](const Arguments& more, int code, const std::vector<std::string>& parts) {
    expect_failure(folder_, joined({"bake", "occlusion"}, more), code, parts);
  };
  refuse({"two.obj", "-o", "a.png", "--object", "wing"}, 2, {"wing", "no such object"});
  refuse({"two.obj", "-o", "a.png", "--rays", "0"}, 2, {"--rays"});
  refuse({"two.obj", "-o", "a.png", "--box", "0,0,0 1,1,1", "--margin", "1"}, 2, {"--margin"});
  refuse({"two.obj", "-o", "a.png", "--gamma", "nan"}, 2, {"--gamma"});
  refuse({"ball.vdb", "-o", "a.png"}, 2, {"ball.vdb", ".obj"});
}

}  // namespace
}  // namespace brume::cli
