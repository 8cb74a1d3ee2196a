// Volumes that overlap smoke on a surface, whose voxels are marked as solid.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/packing.hpp>

#include "tests/render/volume_fixture.hpp"
#include "voxel/voxelize.hpp"

namespace brume::render {
namespace {

/// A box of 4 x 1 x 4 m that ends at faces of voxels, where cells beside it have no plane.
std::vector<voxel::Triangle> table() {
  scene::Mesh mesh;
  add_box(mesh, {-2, -2, -2}, {2, -1, 2});
  std::vector<voxel::Triangle> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
    triangles.push_back({mesh.vertices[mesh.indices[i]].position, mesh.vertices[mesh.indices[i + 1]].position,
                         mesh.vertices[mesh.indices[i + 2]].position});
  return triangles;
}

class VolumesOnWallsTest : public VolumePictures<VolumesOnWallsTest> {
 public:
  static constexpr glm::uvec2 kSize{61, 37};

 protected:
  VolumesOnWallsTest() {
    smoke_.show_in(input_);
    input_.smoke.look.albedo = glm::vec3(0);
    input_.view.camera = {{0, 1.5f, 9}, {0, -0.5f, 0}, 0.9f};
  }

  std::vector<glm::vec4> draw(float smoke, const std::vector<planning::VolumeInput>& volumes) {
    input_.smoke.look.extinction = smoke;
    input_.volumes = volumes;
    return VolumePictures::draw();
  }
  /// 4 m around the table's middle.
  planning::VolumeInput placed(const volume::SparseVolume& cube, float extinction) const {
    planning::VolumeInput volume;
    volume.volume = &cube;
    volume.look.extinction = extinction;
    volume.look.albedo = glm::vec3(0);
    volume.world_from_voxel = glm::scale(glm::translate(glm::mat4(1), glm::vec3(-2)), glm::vec3(0.25f));
    return volume;
  }

  const RestingSmoke smoke_{
      voxel::voxelize(table(), {{40, 24, 40}, 0.5f, glm::vec3(-10, -6, -10)}).value_or_throw(), table(),
      glm::dvec3(0, -0.9, 0), 200};
};

TEST_F(VolumesOnWallsTest, AGlowIsNeverBrighterThanWithoutSmoke) {
  const volume::SparseVolume cube = block({2, 2, 2});
  const volume::SparseVolume masks =
      field<std::uint32_t>({2, 2, 2}, [](glm::vec3) { return glm::packHalf2x16(glm::vec2(1, 0)); });
  planning::VolumeInput glow = placed(cube, 0);
  glow.colors = &masks;
  glow.tints = {glm::vec3(1)};
  const auto alone = draw(0, {glow}), both = draw(2, {glow});
  int dimmed = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    EXPECT_LE(both[i].x, alone[i].x * (1 + 1.0f / 1024)) << i;
    dimmed += both[i].x < 0.5f * alone[i].x;
  }
  EXPECT_GT(dimmed, 100);
}

TEST_F(VolumesOnWallsTest, TransmittancesMultiply) {
  const volume::SparseVolume cube = block({2, 2, 2});
  const auto smoke = draw(1.5f, {placed(cube, 0)}), volume = draw(0, {placed(cube, 0.4f)}),
             both = draw(1.5f, {placed(cube, 0.4f)});
  int overlaps = 0;
  for (std::size_t i = 0; i < both.size(); ++i) {
    const float product = smoke[i].w * volume[i].w;
    EXPECT_NEAR(both[i].w, product, 3 * product / 2048 + 1e-6f) << i;
    overlaps += smoke[i].w < 0.8f && volume[i].w < 0.8f;
  }
  EXPECT_GT(overlaps, 100);
}

}  // namespace
}  // namespace brume::render
