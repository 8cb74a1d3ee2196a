// Roles that files give to surfaces.
#include "scene/roles.hpp"

#include "scene/files/obj.hpp"
#include "scene/files/scene_txt.hpp"
#include "scene/files/timeline_reader.hpp"
#include "scene/timeline.hpp"
#include "tests/scene/gltf_maker.hpp"

namespace brume::scene {
namespace {

std::vector<Role> roles_of(const Scene& scene) {
  std::vector<Role> roles;
  for (const Object& object : scene.objects) roles.push_back(object.role);
  return roles;
}

/// An image with these alphas.
Image image_of(std::initializer_list<int> alphas) {
  Image image{"alphas", {static_cast<std::uint32_t>(alphas.size()), 1, {}}};
  for (const int alpha : alphas)
    image.pixels.rgba.insert(image.pixels.rgba.end(), {200, 100, 50, static_cast<std::uint8_t>(alpha)});
  return image;
}

TEST(Roles, HaveNamesAndPrefixes) {
  for (const Role role : {Role::wall, Role::glass, Role::grille, Role::ghost})
    EXPECT_EQ(role_of_name(name_of(role)), role);
  EXPECT_FALSE(role_of_name("Glass"));
  EXPECT_EQ(role_of_prefix("IGNORE_cable"), Role::ghost);
  EXPECT_EQ(role_of_prefix("GLASS_pane"), Role::glass);
  EXPECT_EQ(role_of_prefix("GRILLE_fence"), Role::grille);
  EXPECT_FALSE(role_of_prefix("glass_pane"));
  EXPECT_FALSE(role_of_prefix("MY_GLASS_"));
}

/// A square of two triangles that shows a part of an image, of vertices with an alpha.
Mesh square(glm::vec2 low = glm::vec2(0), glm::vec2 high = glm::vec2(1), float alpha = 1) {
  Mesh mesh;
  for (const glm::vec2 at : {glm::vec2(0), glm::vec2(1, 0), glm::vec2(1), glm::vec2(0, 1)}) {
    Vertex& vertex = mesh.vertices.emplace_back();
    vertex.uv = glm::mix(low, high, at);
    vertex.color.a = alpha;
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  return mesh;
}

TEST(Roles, OfAlphaWithoutAnImage) {
  const auto role = [](double factor, double cutoff, float vertices = 1) {
    return role_of_alpha(square({}, glm::vec2(1), vertices), {nullptr, factor, cutoff});
  };
  EXPECT_EQ(role(1, 0.5), Role::wall);
  EXPECT_EQ(role(0.5, 0.5), Role::wall);
  EXPECT_EQ(role(0.49, 0.5), Role::glass);
  EXPECT_EQ(role(0, 0.5), Role::glass);
  EXPECT_EQ(role(0.3, 0.1), Role::glass) << "drawn, and below a half";
  EXPECT_EQ(role(0.8, 0.9), Role::glass) << "all of it cut out";
  EXPECT_EQ(role(1, 0.5, 0.25f), Role::glass) << "by its vertices";
  EXPECT_EQ(role(1, 0.5, 0.5f), Role::wall);
  EXPECT_EQ(role_of_alpha(Mesh(), {nullptr, 0.1, 0.5}), Role::wall) << "no triangle";
}

TEST(Roles, OfAlphaWithAnImage) {
  // Eight texels in a row: opaque, a hole, a pane.
  Image image = image_of({255, 255, 255, 255, 0, 0, 100, 100});
  const auto role = [&](float from, float to, double factor = 1, double cutoff = 0.5) {
    return role_of_alpha(square({from / 8, 0}, {to / 8, 1}), {&image, factor, cutoff});
  };
  EXPECT_EQ(role(0, 4), Role::wall) << "what no triangle shows does not count";
  EXPECT_EQ(role(0, 6), Role::grille) << "opaque with holes";
  EXPECT_EQ(role(4, 6), Role::glass) << "all of it cut out";
  EXPECT_EQ(role(6, 8), Role::glass);
  EXPECT_EQ(role(8, 12), Role::wall) << "images repeat";
  EXPECT_EQ(role(-8, -4), Role::wall);
  EXPECT_EQ(role(0, 8), Role::grille);
  EXPECT_EQ(role(0, 8, 0.4), Role::glass) << "nothing above a half";
  EXPECT_EQ(role(0, 4, 0.6), Role::wall);
  image.wraps.u = Wrap::clamp;
  EXPECT_EQ(role(8, 12), Role::glass) << "its last texel";
  EXPECT_EQ(role(-8, 4), Role::wall) << "its first texel";
  image.wraps.u = Wrap::mirror;
  EXPECT_EQ(role(8, 12), Role::glass) << "from its right edge back";
  EXPECT_EQ(role(12, 16), Role::wall);
  // A frame around panes is no hole.
  const Image window = image_of({255, 100, 100, 255});
  EXPECT_EQ(role_of_alpha(square(), {&window}), Role::glass);
  EXPECT_EQ(role_of_alpha(square(), {&window, 1, 0.2}), Role::wall) << "all of it is drawn";
  // Fewer than 1/64 of all places: one of 256 texels.
  Image speck{"speck", {16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 255)}};
  speck.pixels.rgba[3] = 0;
  EXPECT_EQ(role_of_alpha(square(), {&speck}), Role::wall);
}

TEST(Roles, WrappedTexelsFollowTheirDefinition) {
  for (const std::uint32_t size : {1u, 2u, 7u}) {
    const auto count = static_cast<std::int64_t>(size);
    for (std::int64_t texel = 0; texel < count; ++texel)
      for (const Wrap wrap : {Wrap::repeat, Wrap::mirror, Wrap::clamp})
        EXPECT_EQ(wrapped_texel(texel, size, wrap), static_cast<std::uint32_t>(texel)) << "inside";
    for (std::int64_t texel = -3 * count; texel <= 3 * count; ++texel) {
      EXPECT_EQ(wrapped_texel(texel, size, Wrap::repeat), wrapped_texel(texel + count, size, Wrap::repeat));
      EXPECT_EQ(wrapped_texel(texel, size, Wrap::mirror), wrapped_texel(-1 - texel, size, Wrap::mirror));
      EXPECT_EQ(wrapped_texel(texel, size, Wrap::mirror),
                wrapped_texel(texel + 2 * count, size, Wrap::mirror));
      EXPECT_EQ(wrapped_texel(texel, size, Wrap::clamp), texel < 0 ? 0 : std::min(texel, count - 1));
    }
  }
  EXPECT_EQ(wrapped_coordinate(-0.25, Wrap::repeat), 0.75);
  EXPECT_EQ(wrapped_coordinate(-0.25, Wrap::mirror), 1.75);
  EXPECT_EQ(wrapped_coordinate(-9.0, Wrap::clamp), -1);
  EXPECT_EQ(wrapped_coordinate(1e30, Wrap::mirror), 0) << "near the image, whatever it was";
}

TEST(Roles, OfAlphaAtPlacesThatAreNoNumbers) {
  const Image image = image_of({255, 0});
  for (const float bad : {INFINITY, -INFINITY, NAN, 1e38f, -1e38f})
    role_of_alpha(square({bad, bad}, {1, bad}), {&image});
}

TEST(Roles, OfNodesReachTheirChildren) {
  Document document;
  document.nodes = R"([{"mesh": 0, "extras": {"brume_role": "glass"}, "children": [1, 2, 3, 4]},
    {"mesh": 0}, {"mesh": 0, "name": "GRILLE_x"}, {"mesh": 0, "extras": {"brume_ignore": 1}},
    {"mesh": 0, "name": "IGNORE_y", "extras": {"brume_role": "wall"}}])";
  const auto scene = document.load().value_or_throw();
  EXPECT_EQ(roles_of(scene),
            (std::vector<Role>{Role::glass, Role::glass, Role::grille, Role::ghost, Role::wall}));
}

TEST(Roles, AnUnknownOneIsOneWarning) {
  Document document;
  document.nodes =
      R"([{"mesh": 0, "extras": {"brume_role": "fence"}}, {"mesh": 0, "extras": {"brume_role": 3}}])";
  const LogLines warnings;
  const auto scene = document.load();
  ASSERT_TRUE(scene);
  EXPECT_EQ(roles_of(*scene), (std::vector<Role>{Role::wall, Role::wall}));
  ASSERT_EQ(warnings.lines.size(), 1u);
  EXPECT_EQ(warnings.lines[0],
            "a.gltf: nodes[0].extras.brume_role: is none of \"wall\", \"glass\", \"grille\", \"ghost\"");
}

TEST(Roles, OfMaterials) {
  const auto role = [](const std::string& material, const std::string& node = "") {
    Document document;
    document.primitive = R"({"attributes": {"POSITION": 0}, "material": 0})";
    document.more = ", \"materials\": [" + material + "]";
    document.nodes = "[{\"mesh\": 0" + node + "}]";
    return document.load().value_or_throw().objects.at(0).role;
  };
  const auto with_alpha = [](const char* mode, const char* alpha) {
    return std::string(R"({"alphaMode": ")") + mode +
           R"(", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, )" + alpha + "]}}";
  };
  EXPECT_EQ(role(with_alpha("OPAQUE", "0.1")), Role::wall);
  EXPECT_EQ(role(with_alpha("BLEND", "0.1")), Role::glass);
  EXPECT_EQ(role(with_alpha("MASK", "0.1")), Role::glass);
  EXPECT_EQ(role(with_alpha("BLEND", "0.6")), Role::wall);
  EXPECT_EQ(role(R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}})"),
            Role::glass);
  EXPECT_EQ(role(R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.4}}})"),
            Role::wall);
  EXPECT_EQ(role(R"({"extensions": {"KHR_materials_transmission": {}}})"), Role::wall);
  EXPECT_EQ(role(with_alpha("BLEND", "0.1"), R"(, "extras": {"brume_role": "wall"})"), Role::wall);
  EXPECT_EQ(role(R"({"alphaMode": "BLEND", "extras": {"brume_role": "grille"}})"), Role::grille);
  EXPECT_EQ(role(R"({"extras": {"brume_role": "ghost"}})", R"(, "name": "GLASS_x")"), Role::glass);
  EXPECT_EQ(role(with_alpha("BLEND", "0.1"), R"(, "name": "IGNORE_x")"), Role::ghost);
}

TEST(Roles, OfObjFiles) {
  MemoryFiles files;
  files.add_text(
      "a.mtl",
      "newmtl clear\nd 0.2\nnewmtl halo\nd -halo 0.2\nnewmtl see\nTr 0.8\nnewmtl full\nd 1\nTr 0\n"
      "newmtl odd\nd none\nnewmtl leaf\nmap_d -imfchan m leaf.png\nnewmtl GLASS_x\n"
      "newmtl bare\nmap_d gone.png\nnewmtl bald\nmap_d gone.png\nnewmtl blank\nmap_Kd none.png\nmap_d "
      "none.png\n");
  files.files["leaf.png"] = png_of({1, 1, {200, 100, 50, 100}});
  std::string text = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const char* material :
       {"clear", "halo", "see", "full", "odd", "leaf", "GLASS_x", "bare", "bald", "blank"})
    text += std::string("usemtl ") + material + "\nf 1 2 3\n";
  text += "o GRILLE_gate\nusemtl clear\nf 1 2 3\n";
  const LogLines warnings;
  const Scene scene = parse_obj_scene(text, "a.obj", files).value_or_throw();
  EXPECT_EQ(roles_of(scene),
            (std::vector<Role>{Role::glass, Role::glass, Role::glass, Role::wall, Role::wall, Role::glass,
                               Role::glass, Role::wall, Role::wall, Role::wall, Role::grille}));
  // Each missing image is named once.
  EXPECT_TRUE(warnings.has("the image \"gone.png\" does not exist; the material counts as opaque"));
  EXPECT_EQ(warnings.lines.size(), 2u);
}

/// The failure of a timeline with these lines.
std::string timeline_error(const std::string& lines) {
  const auto read = parse_timeline("version = 1\nscene = \"a.glb\"\n" + lines, "t.toml");
  return read ? "no error" : read.failure().message;
}

TEST(Roles, OfTimelines) {
  const auto timeline =
      parse_timeline(
          "version = 1\nscene = \"a.glb\"\n[[role]]\nobject = \"fence\"\nrole = \"grille\"\n"
          "[[role]]\nobject = \"pane\"\nrole = \"glass\"\n",
          "t.toml")
          .value_or_throw();
  ASSERT_EQ(timeline.roles.size(), 2u);
  EXPECT_EQ(timeline.roles[0].object, "fence");
  EXPECT_EQ(timeline.roles[0].role, Role::grille);
  EXPECT_EQ(timeline.roles[1].role, Role::glass);
  EXPECT_HAS(timeline_error("[[role]]\nobject = \"a\"\nrole = \"fence\"\n"),
             "t.toml:5:8: \"role\": expected \"wall\", \"glass\", \"grille\" or \"ghost\"");
  EXPECT_HAS(timeline_error("[[role]]\nobject = \"a\"\n"), "role");
  EXPECT_HAS(timeline_error("[[role]]\nrole = \"wall\"\n"), "object");
  EXPECT_HAS(timeline_error("[[role]]\nobject = \"\"\nrole = \"wall\"\n"), "expected the name of an object");
  EXPECT_HAS(timeline_error(
                 "[[role]]\nobject = \"a\"\nrole = \"wall\"\n[[role]]\nobject = \"a\"\nrole = \"glass\"\n"),
             "t.toml:7:10: \"object\": there is another [[role]] of \"a\"");

  // The scene has these objects.
  Scene scene;
  scene.objects.resize(2);
  scene.objects[0].name = "fence";
  EXPECT_HAS(check_objects(timeline, scene).failure().message,
             "t.toml:7:10: the scene has no object \"pane\"");
  scene.objects[1].name = "pane";
  EXPECT_TRUE(check_objects(timeline, scene));
}

TEST(Roles, OfSceneTxt) {
  MemoryFiles files;
  const char* const names[] = {"IGNORE_a", "GLASS_a", "GRILLE_a", "a"};
  std::string text;
  for (const char* name : names) {
    files.add_text(std::string("Meshes/") + name + ".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    text += std::string(name) + " 0 0 0 0 0 0 1 1 1\n";
  }
  EXPECT_EQ(roles_of(parse_scene_txt(text, "Scene.txt", files).value_or_throw()),
            (std::vector<Role>{Role::ghost, Role::glass, Role::grille, Role::wall}));
}

}  // namespace
}  // namespace brume::scene
