// Tests that require a display: Blender's renderer and its window.
#include "image/decode.hpp"
#include "scene/files/load.hpp"
#include "tests/blender/blender_fixture.hpp"

namespace brume::blender {
namespace {

using Json = nlohmann::json;

// EEVEE's picture of a plane two metres below each light, against the light that Brume reads: radiance is 0.8
// / pi of the irradiance. EEVEE fits the power of area lights to Cycles' by a factor of 0.8 for pi / 4, 1.9 %
// more, and the lights have a size.
TEST_F(Blender, LightsMatchBlendersRenderer) {
  const Json measured = read_json(blender_run().folder / "lights.json");
  ASSERT_EQ(measured.size(), 4u);
  for (const auto& [kind, radiance] : measured.items()) {
    const scene::Scene scene =
        scene::load_scene(blender_run().folder / ("light_" + kind + ".glb")).value_or_throw();
    ASSERT_EQ(scene.lights.size(), 1u) << kind;
    const double falls_in = double{scene.lights[0].intensity.g} / (kind == "SUN" ? 1 : 2 * 2);
    const double expected = 0.8 / std::acos(-1.0) * falls_in;
    EXPECT_NEAR(radiance.get<double>(), expected, 0.025 * expected) << kind;
  }
}

// In a window: Blender's timers run while Brume renders, the image appears in the Image Editor, the file
// browser starts a bake, Esc stops the program, and a failing program keeps the previous image.
TEST_F(Blender, RendersWithoutBlockingTheWindow) {
  const Json window = read_json(blender_run().folder / "window.json");
  EXPECT_EQ(window["started"], Json({"RUNNING_MODAL"}));
  EXPECT_GE(window["ticks"], 10);
  EXPECT_EQ(window["shown"], "Brume Render");
  EXPECT_EQ(window["proposed"], "Ramp_slices.png");
  EXPECT_GE(window["bake_ticks"], 10);
  EXPECT_EQ(window["baked"], "Ramp_slices.png");
  EXPECT_EQ(window["ended"], true);
  EXPECT_EQ(window["stopped"], "Render with Brume: stopped");
  EXPECT_EQ(window["own_window"], Json({"Brume Render"}));
  EXPECT_EQ(window["images"], Json({"Brume Render", "Brume Render (previous)"}));
  EXPECT_EQ(window["windows_of_area"], 1);
  EXPECT_EQ(window["film_stopped"], "Render Film: stopped; 1 of 96 images are written");
  // The outline of the smoke alone is longer than that.
  EXPECT_GT(window["gizmo_pixels"], 200);
  EXPECT_EQ(window["image_after"], true);
  ASSERT_EQ(window["viewed"], true);
  expect_a_picture(image::load_image(blender_run().folder / "view.png").value_or_throw());
  // Panels that fail to draw print a traceback.
  EXPECT_EQ(blender_run().log.find("Traceback"), std::string::npos) << blender_run().log;
}

}  // namespace
}  // namespace brume::blender
