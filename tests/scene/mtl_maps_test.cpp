// Images that MTL files name: where they lie on a surface, and what they cut out of it.
#include "scene/files/obj.hpp"
#include "tests/scene/scene_test_tools.hpp"

namespace brume::scene {
namespace {

constexpr const char* kTexturedSquare =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "usemtl a\nf 1/1 2/2 3/3 4/4\n";

/// A square whose material has these lines.
Scene square_with(const std::string& lines, MemoryFiles files) {
  files.add_text("m.mtl", "newmtl a\n" + lines);
  return parse_obj_scene(kTexturedSquare, "s.obj", files).value_or_throw();
}

image::Image8 grey(std::initializer_list<int> values) {
  image::Image8 image{static_cast<std::uint32_t>(values.size()), 1, {}};
  for (const int value : values) {
    const auto byte = static_cast<std::uint8_t>(value);
    image.rgba.insert(image.rgba.end(), {byte, byte, byte, 255});
  }
  return image;
}

const image::Image8& color_image(const Scene& scene) {
  return scene.images.at(scene.materials.at(0).base_color_image).pixels;
}

TEST(MtlMaps, ScaleAndOffsetMoveTheTexture) {
  MemoryFiles files;
  files.files["t.png"] = png_of(grey({0, 255}));
  const LogLines warnings;
  const Scene scene = square_with("map_Kd -s 2 -3 1 -o .25 0.5 t.png\n", files);
  EXPECT_TRUE(warnings.lines.empty());
  expect_sound(scene);
  const std::vector<Vertex>& vertices = scene.meshes.at(0).vertices;
  ASSERT_EQ(vertices.size(), 4u);
  // u' = 2 u + 0.25, and upwards v' = 0.5 - 3 v; here v runs down.
  EXPECT_EQ(vertices[0].uv, glm::vec2(0.25f, 0.5f));
  EXPECT_EQ(vertices[1].uv, glm::vec2(2.25f, 0.5f));
  EXPECT_EQ(vertices[2].uv, glm::vec2(2.25f, 3.5f));
  EXPECT_EQ(vertices[0].tangent, glm::vec4(1, 0, 0, -1)) << "mirrored";
  EXPECT_EQ(square_with("map_Kd -s 2 t.png\n", files).meshes[0].vertices[2].uv, glm::vec2(2, 0));
  expect_sound(square_with("map_Kd -s 3e38 3e38 -o 3e38 3e38 t.png\n", files));

  // There is one set of coordinates.
  EXPECT_TRUE(warnings.lines.empty());
  square_with("map_Kd -s 2 2 t.png\nbump -s 3 3 t.png\n", files);
  ASSERT_EQ(warnings.lines.size(), 1u);
  EXPECT_EQ(warnings.lines[0], "m.mtl:3: the scale and offset of m.mtl:2 apply to this map, too");
}

TEST(MtlMaps, AnOpacityMapBecomesTheAlphaOfTheColours) {
  MemoryFiles files;
  files.files["color.png"] = png_of({2, 1, {10, 20, 30, 255, 40, 50, 60, 255}});
  files.files["mask.png"] = png_of(grey({0, 255, 255, 0}));
  files.files["alpha.png"] = png_of({2, 1, {255, 255, 255, 200, 255, 255, 255, 100}});
  const LogLines warnings;
  const Scene both = square_with("map_Kd color.png\nmap_d mask.png\n", files);
  EXPECT_EQ(color_image(both).rgba,
            (std::vector<std::uint8_t>{10, 20, 30, 0, 10, 20, 30, 255, 40, 50, 60, 255, 40, 50, 60, 0}));
  EXPECT_EQ(both.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(both.objects.at(0).role, Role::grille);
  EXPECT_EQ(cutoff_of(both.objects[0], both.materials[0]), 0.5f) << "in pictures as in roles";

  const Scene alone = square_with("Kd 0 0 0\nmap_d alpha.png\n", files);
  EXPECT_EQ(color_image(alone).rgba, (std::vector<std::uint8_t>{255, 255, 255, 200, 255, 255, 255, 100}));
  EXPECT_EQ(alone.materials[0].base_color, glm::vec3(0)) << "black by its colour";

  // Materials without the map keep the image as it is.
  files.files["holes.png"] = png_of({2, 1, {1, 2, 3, 0, 4, 5, 6, 255}});
  EXPECT_EQ(square_with("map_Kd holes.png\n", files).materials[0].alpha_cutoff, 0);
  const Scene same = square_with("map_Kd holes.png\nmap_d holes.png\n", files);
  EXPECT_EQ(same.images.size(), 1u);
  EXPECT_EQ(same.materials[0].alpha_cutoff, 0.5f);
  EXPECT_EQ(same.objects[0].role, Role::grille);
  EXPECT_TRUE(warnings.lines.empty());
}

TEST(MtlMaps, WithoutItsOpacityMapAMaterialIsOpaque) {
  MemoryFiles files;
  files.add_text("text.png", "no image");
  const LogLines warnings;
  for (const char* map : {"text.png", "gone.png"}) {
    const Scene scene = square_with(std::string("map_d ") + map + "\n", files);
    EXPECT_EQ(scene.objects.at(0).role, Role::wall) << map;
    EXPECT_EQ(scene.materials[0].alpha_cutoff, 0) << map;
    EXPECT_EQ(scene.materials[0].base_color_image, kNone) << map;
  }
  ASSERT_EQ(warnings.lines.size(), 2u);
  for (const std::string& line : warnings.lines)
    EXPECT_TRUE(line.starts_with("m.mtl:2: ") && line.ends_with("; the material counts as opaque")) << line;
}

TEST(MtlMaps, WhatIsNotUsedIsNotMissed) {
  MemoryFiles files;
  files.add_text("m.mtl", "newmtl a\nmap_Kd gone.png\nbump gone.png\nmap_d mask.png\n");
  const auto warnings_of = [&](ImageUse use) {
    const LogLines warnings;
    parse_obj_scene(kTexturedSquare, "s.obj", files, use).value_or_throw();
    return warnings.lines.size();
  };
  EXPECT_EQ(warnings_of(ImageUse::pictures), 2u);
  EXPECT_EQ(warnings_of(ImageUse::roles), 1u);
  EXPECT_EQ(warnings_of(ImageUse::none), 0u);
}

}  // namespace
}  // namespace brume::scene
