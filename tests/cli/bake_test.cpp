#include <gtest/gtest.h>

#include "core/box.hpp"
#include "grids/files/grid_files.hpp"
#include "grids/files/slice_atlas.hpp"
#include "grids/generate.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

class Bake : public CommandTest {};

TEST_F(Bake, WritesTheGridOfItsOptions) {
  const Outcome done = run_well(
      words("bake pyroclastic -o a.brv --edge 33 --voxel 0.25 --seed 7 --octaves 3 --radius 2 "
            "--edge-softness 0.5 --amplitude 0.4 --gain 0.6 --lacunarity 2.5 --frequency 1 --json -"));
  const grids::Grid expected =
      grids::generate_cloud({grids::CloudKind::pyroclastic, 33, 0.25, 2, 0.5, 0.4, 1, 0.6, 2.5, 3, 7});
  const grids::GridFile file = grids::load_grid_file(folder_.path() / "a.brv").value_or_throw();
  ASSERT_EQ(file.grids.size(), 1u);
  EXPECT_EQ(file.grids[0].values, expected.values);
  EXPECT_EQ(file.grids[0].world_from_index, expected.world_from_index);
  EXPECT_EQ(file.grids[0].grid_class, grids::GridClass::fog_volume);
  const Json json = Json::parse(done.out);
  EXPECT_EQ(json["active_voxels"], grids::count_active(expected));
  EXPECT_EQ(json["bricks"], expected.bricks.size());
  EXPECT_EQ(json["radius"], 2);
}

TEST_F(Bake, LaysSlicesOutInRows) {
  run_well({"bake", "sphere", "-o", "a.png", "--edge", "40", "--voxel", "1", "--radius", "12.5", "--binary"});
  const image::Image8 image = png("a.png");
  // As near to a square as 40 tiles can be.
  ASSERT_EQ(image.width, 6u * 40);
  ASSERT_EQ(image.height, 7u * 40);
  for (std::uint32_t slice = 0; slice < 40; ++slice) {
    const double z = slice - 19.5;
    int white = 0, expected = 0;
    for (std::uint32_t y = 0; y < 40; ++y)
      for (std::uint32_t x = 0; x < 40; ++x) {
        const std::size_t texel = (slice % 6 * 40 + x) + image.width * (slice / 6 * 40 + y);
        const double r2 = (x - 19.5) * (x - 19.5) + (y - 19.5) * (y - 19.5) + z * z;
        white += image.rgba[4 * texel] == 255;
        expected += r2 < 12.5 * 12.5;
      }
    EXPECT_EQ(white, expected) << slice;
  }
}

TEST_F(Bake, SlicesComeBackAsTheVolume) {
  grids::CloudSettings settings;
  settings.edge = 7;
  settings.radius = 0.28 * 7 * settings.voxel_size;
  settings.edge_width = 0;
  const shared::CloudParams params = grids::cloud_params(settings);
  run_well({"bake", "pyroclastic", "-o", "a.png", "--edge", "7", "--binary", "-q"});
  const grids::SliceAtlas atlas = grids::load_slice_atlas(folder_.path() / "a.json").value_or_throw();
  ASSERT_EQ(atlas.layout.size, glm::uvec3(7)) << "what is empty included";
  for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(7)}, [&](glm::ivec3 at) {
    EXPECT_EQ(atlas.channels[0].values[atlas.channels[0].index(glm::uvec3(at))],
              shared::cloud_voxel(params, at) > 0 ? 1 : 0);
  });
  EXPECT_NEAR(atlas.channels[0].box.low.x, -3.5 * settings.voxel_size, 1e-9) << "around the origin";
}

TEST_F(Bake, WarnsOfACutAndOfAnEmptyShape) {
  const auto warning = [&](Arguments more) {
    more.insert(more.end(), {"-o", "a.brv", "--edge", "16"});
    return run_well({"bake"}, more).error;
  };
  EXPECT_EQ(warning({"sphere"}), "");
  EXPECT_NE(warning({"sphere", "--radius", "2"}).find("may be cut"), std::string::npos);
  EXPECT_NE(warning({"torus", "--radius", "0.0001"}).find("no voxel has density"), std::string::npos);
}

TEST_F(Bake, RefusesOptionsThatWouldDoNothing) {
  const auto refusal = [&](const Arguments& more) {
    const Outcome done = run({"bake"}, more);
    EXPECT_EQ(done.exit_code, 2);
    return done.error;
  };
  EXPECT_EQ(refusal({"sphere", "-o", "a.brv", "--seed", "1"}),
            "brume: --seed is for the shape pyroclastic\n");
  EXPECT_EQ(refusal({"sphere", "-o", "a.brv", "--binary", "--edge-softness", "1"}),
            "brume: --edge-softness would do nothing with --binary\n");
  EXPECT_EQ(refusal({"sphere", "-o", "a.brv", "--device", "1"}), "brume: --device requires --gpu\n");
  EXPECT_NE(refusal({"sphere", "-o", "a.vxl"}).find("expected .brv, .vdb, .nvdb or .png"), std::string::npos);
  EXPECT_EQ(folder_.files(), Arguments{});
}

TEST_F(Bake, TheDeviceGivesTheSameVoxelsUpToRounding) {
  for (const Arguments& where : {Arguments{}, Arguments{"--gpu"}}) {
    run_well({"bake", "pyroclastic", "--edge", "24", "-o", where.empty() ? "cpu.brv" : "gpu.brv"}, where);
  }
  const auto count = [&](const char* file) {
    return grids::count_active(grids::load_grid_file(folder_.path() / file).value_or_throw().grids[0]);
  };
  const auto cpu = static_cast<double>(count("cpu.brv"));
  EXPECT_NEAR(static_cast<double>(count("gpu.brv")), cpu, 0.01 * cpu);
}

}  // namespace
}  // namespace brume::cli
