// Every field of a frame's input shows in the next picture of a renderer that drew another frame before, as
// it does in that of one that remembers nothing; or the table says why it shows nothing.
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/render/truth_scenes.hpp"
#include "tests/render/volume_fixture.hpp"

namespace brume::render {
namespace {

using Change = std::function<void(FrameInput&)>;
struct FieldChange {
  const char* field;
  Change change;
  Change given = {};                    ///< What the field needs to matter.
  const char* shows_nothing = nullptr;  ///< Why the picture is the same.
};

/// A yard with a wall, a cube and an emitter, all things that a frame can show in it.
class FrameInputTest : public VolumeFixture {
 protected:
  static constexpr glm::uvec2 kSize{64, 36};

  static scene::Scene make_scene() {
    scene::Scene scene;
    scene.meshes.resize(3);
    add_box(scene.meshes[0], {-4, -0.5f, -4}, {4, 0, 4});
    add_box(scene.meshes[0], {-4, 0, -3}, {4, 3, -2.5f});
    add_box(scene.meshes[1], {-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f});
    add_box(scene.meshes[2], glm::vec3(-0.15f), glm::vec3(0.15f));
    scene.materials.resize(2);
    scene.materials[0].base_color = {0.6f, 0.5f, 0.4f};
    scene.materials[1].emission = glm::vec3(3);
    scene.objects = {{"yard", 0, 0, glm::mat4(1)},
                     {"cube", 1, 0, glm::translate(glm::mat4(1), glm::vec3(1.8f, 0, 1))},
                     {"panel", 1, 1, glm::translate(glm::mat4(1), glm::vec3(-2.5f, 0, -1.5f))}};
    scene.grenade = {"grenade", 2, 0, glm::mat4(1), Role::ghost};
    scene.lights.resize(1);
    scene.lights[0].position_world = {0.5f, 2.8f, 1.2f};
    scene.lights[0].intensity = {9, 8, 6};
    return scene;
  }
  static const scene::Scene& scene() {
    static const scene::Scene instance = make_scene();
    return instance;
  }
  static const voxel::BitGrid& level() {
    static const voxel::BitGrid instance =
        scenario_of(make_scene(), {}, {{32, 16, 32}, 0.25f, {-4, -0.5f, -4}}).voxels.grid;
    return instance;
  }
  static Renderer& renderer() {
    static Renderer instance(context(), runner(), scene(), RendererOptions{kSize});
    return instance;
  }

  FrameInputTest() {
    input_.view.camera = {{0.3f, 1.9f, 5}, {0, 0.9f, 0}, 0.9f};
    input_.environment.sky = {glm::vec3(0.2f, 0.3f, 0.5f), 0, glm::vec3(0.3f), 0.2f, glm::vec3(0.2f)};
    input_.level.voxels.grid = &level();
    smoke().show_in(input_);
    shared::SmokeLook& look = input_.smoke.look;
    look.albedo = glm::vec3(0.9f);
    look.extinction = 1.5f;
    look.opaque_transmittance = 0.01f;
    look.erosion = 0.4f;
    look.detail = look.multiple_scattering = 0.5f;
    look.rise = look.swirl = 0.2f;
    input_.smoke.time = 3;
    hole_.origin_world = {-1.2f, 1, 4};
    hole_.forward = {0, 0, -1};
    hole_.right = {1, 0, 0};
    hole_.up = {0, 1, 0};
    hole_.radius = 0.4f;
    hole_.distance_to_far = 6;
    hole_.time_start = 2.5f;
    hole_.time_to_reach_far = hole_.time_to_expand = 0.05f;
    hole_.time_to_stay_open = 2;
    hole_.time_to_fade = 1;

    planning::VolumeInput& volume = input_.volumes.emplace_back();
    volume.volume = &cloud_;
    volume.world_from_voxel =
        glm::translate(glm::mat4(1), {0.6f, 0.4f, 0.2f}) * glm::scale(glm::mat4(1), glm::vec3(0.07f));
    volume.look = {glm::vec3(0.8f), 1.5f, glm::vec3(0), 0.2f, 0.5f};

    grids::DenseGrid slices;
    slices.size = {4, 4, 4};
    for (int i = 0; i < 64; ++i) slices.values.push_back(0.3f + 0.01f * static_cast<float>(i));
    slices.box = {glm::dvec3(-1), glm::dvec3(1)};
    input_.slices =
        std::make_shared<const grids::DenseVolumes>(1, std::make_shared<const grids::DenseVolume>(2, slices));
    planning::DecalInput& decal = input_.decals.emplace_back();
    decal.world_from_box =
        glm::translate(glm::mat4(1), {-1.5f, -0.4f, 1.5f}) * glm::scale(glm::mat4(1), glm::vec3(2, 1, 2));
    planning::ParticleInput& particles = input_.particles.emplace_back();
    particles.world_from_uvw =
        glm::translate(glm::mat4(1), {-3, 1.2f, 0}) * glm::scale(glm::mat4(1), glm::vec3(1));
    particles.tints[0] = {1, 2, 4};
    particles.count = 20;
  }

  struct Picture {
    std::vector<std::uint64_t> media, radiance;
    std::vector<std::uint32_t> display;
    bool operator==(const Picture&) const = default;
  };
  static Picture draw(const FrameInput& input) {
    renderer().draw(input);
    return {read_back<std::uint64_t>(renderer().media()),
            read_back<std::uint64_t>(renderer().targets().radiance),
            read_back<std::uint32_t>(renderer().targets().display)};
  }
  /// By a renderer that remembers nothing.
  static Picture draw_first(const FrameInput& input) {
    renderer().invalidate_level();
    return draw(input);
  }
  /// By one that remembers the level alone: its cells of indirect light take longer than the frame.
  static Picture draw_rebuilt(FrameInput input) {
    input.quality.rebuild_light = true;
    return draw(input);
  }
  /// Draws each change alone, then goes back to the frame without it, whose picture is known.
  void expect_rows(const std::vector<FieldChange>& rows,
                   const std::function<Picture(const FrameInput&)>& draw_alone = draw_first) {
    const Picture plain = draw_alone(input_);
    for (const FieldChange& row : rows) {
      SCOPED_TRACE(row.field);
      FrameInput before = input_;
      if (row.given) row.given(before);
      FrameInput after = before;
      row.change(after);
      const Picture first = row.given ? draw_alone(before) : plain, second = draw_alone(after);
      EXPECT_TRUE(draw(before) == first) << "another picture than without a frame before";
      EXPECT_EQ(second == first, row.shows_nothing != nullptr)
          << (row.shows_nothing ? row.shows_nothing : "the field shows nothing");
    }
  }
  /// The same with light that surfaces and media pass on to each other, too.
  void expect_rows_of_bounced_light(const std::vector<FieldChange>& rows) {
    expect_rows(rows);
    SCOPED_TRACE("bounces = 1");
    input_.environment.bounces = 1;
    expect_rows(rows, draw_rebuilt);
  }
  /// The slices of the frame, and others of one value.
  std::shared_ptr<const grids::DenseVolumes> two_slices() const {
    grids::DenseGrid other;
    other.size = {2, 2, 2};
    other.values.assign(8, 0.9f);
    other.box = {glm::dvec3(-1), glm::dvec3(1)};
    return std::make_shared<const grids::DenseVolumes>(
        grids::DenseVolumes{(*input_.slices)[0], std::make_shared<const grids::DenseVolume>(2, other)});
  }
  static planning::VolumeInput& volume(FrameInput& input) { return input.volumes[0]; }
  static void add_heat(FrameInput& input) {
    volume(input).heat = {&warmth(), volume(input).world_from_voxel, 1500, 1, 1};
  }
  static void add_transfer(FrameInput& input) {
    planning::TransferInput& transfer = volume(input).transfer;
    transfer.opacity = {{0, 0.1f}, {1, 0.9f}};
    transfer.glow = 0.3f;
  }
  static void add_disturbance(FrameInput& input) {
    volume(input).disturbance = {glm::mat4(1), {4, 6, {1, 0, 0}, 0}, 0.5f};
  }
  static void add_detail(FrameInput& input) {
    volume(input).detail = {glm::mat4(1), {0.6f, 6, {1, 0, 0}}, 1, 0.5f};
  }
  static const volume::SparseVolume& warmth() {
    static const volume::SparseVolume instance = block({2, 2, 2}, 0.8f);
    return instance;
  }

  static const RestingSmoke& smoke() {
    static const RestingSmoke instance(level(), {}, {-1.2, 0.6, 0.4}, 200);
    return instance;
  }
  static const RestingSmoke& other_smoke() {
    static const RestingSmoke instance(level(), {}, {0.4, 0.6, 1.4}, 120);
    return instance;
  }
  const volume::SparseVolume cloud_ = values({2, 2, 2}, [](glm::vec3 p) { return p.x > 6 ? 0.9f : 0.5f; });
  const volume::SparseVolume preview_ = block({1, 1, 1}, 0.7f);
  shared::Hole hole_{};
};

// The bindings below name every field of a struct: one that is added fails to compile here, and needs a row.

TEST_F(FrameInputTest, TheView) {
  [[maybe_unused]] const auto& [camera, projection, number, size, sample, exposure, tone, frame_index,
                                continues, previous] = input_.view;
  [[maybe_unused]] const auto& [position, target, fov, up, lens, shutter, frustum] = camera;
  [[maybe_unused]] const auto& [aperture, focus, blades, opening] = lens;
  [[maybe_unused]] const auto& [pixel, on_lens, index, count] = sample;
  const auto through_lens = [](FrameInput& input) {
    input.view.camera.lens.aperture = 0.2f;
    input.view.sample.lens = {0.7f, 0.2f};
  };
  expect_rows({
      {"camera.position_world", [](FrameInput& input) { input.view.camera.position_world.x += 0.3f; }},
      {"camera.target_world", [](FrameInput& input) { input.view.camera.target_world.y += 0.2f; }},
      {"camera.vertical_fov", [](FrameInput& input) { input.view.camera.vertical_fov = 0.8f; }},
      {"camera.up_world",
       [](FrameInput& input) { input.view.camera.up_world = glm::normalize(glm::vec3(0.2f, 1, 0)); }},
      {"camera.lens.aperture", [](FrameInput& input) { input.view.camera.lens.aperture = 0.4f; },
       through_lens},
      {"camera.lens.focus", [](FrameInput& input) { input.view.camera.lens.focus = 2; }, through_lens},
      {"camera.lens.blades", [](FrameInput& input) { input.view.camera.lens.blades = 5; }, through_lens,
       "FrameSamples chooses the points on the lens by it, of which a frame shows one"},
      {"camera.lens.opening", [](FrameInput& input) { input.view.camera.lens.opening = "heart.png"; },
       through_lens, "likewise"},
      {"camera.shutter",
       [](FrameInput& input) { input.view.camera.shutter = 0.5f; },
       {},
       "FrameSamples chooses times by it, of which a frame shows one"},
      {"camera.frustum",
       [](FrameInput& input) {
         input.view.camera.frustum = {-0.5f, 0.7f, -0.4f, 0.4f};
       }},
      {"sample.pixel",
       [](FrameInput& input) {
         input.view.sample.pixel = {0.4f, -0.3f};
       }},
      {"sample.lens",
       [](FrameInput& input) {
         input.view.sample.lens = {-0.5f, 0.1f};
       },
       through_lens},
      {"sample.count",
       [](FrameInput& input) { input.view.sample.count = 4; },
       {},
       "the first of several samples is their mean so far"},
      {"exposure", [](FrameInput& input) { input.view.exposure = 2; }},
      {"tone", [](FrameInput& input) { input.view.tone = scene::ToneCurve::standard; }},
      {"frame_index", [](FrameInput& input) { input.view.frame_index = 1; }},
  });
}

TEST_F(FrameInputTest, TheViewOfAFilmOrAHost) {
  expect_rows({
      {"index", [](FrameInput& input) { input.view.index = 2; }, {}, "nothing is accumulated"},
      {"projection",
       [](FrameInput& input) { input.view.projection = planning::Projection::perspective; },
       {},
       "only pictures of a host may be parallel"},
      {"size_px",
       [](FrameInput& input) { input.view.size_px = kSize; },
       {},
       "only pictures of a host may be smaller"},
      {"continues",
       [](FrameInput& input) { input.view.continues = true; },
       {},
       "nothing is accumulated (RendererOptions::antialias, MediaOptions::temporal)"},
      {"previous", [](FrameInput& input) { input.view.previous = {input.view.camera}; }, {}, "likewise"},
  });
}

TEST_F(FrameInputTest, TheMeanOfTwoSamplesIsAnotherPictureThanTheSecond) {
  FrameInput second = input_;
  second.view.sample = {{0.4f, 0.4f}, {}, 1, 2};
  FrameInput alone = second;
  alone.view.sample.index = 0;
  FrameInput first = input_;
  first.view.sample.count = 2;
  const Picture of_second = draw_first(alone);
  draw(first);
  EXPECT_FALSE(draw(second) == of_second) << "sample.index";
}

TEST_F(FrameInputTest, TheEnvironment) {
  [[maybe_unused]] const auto& [sky, flashes, glow, bounces] = input_.environment;
  [[maybe_unused]] const auto& [zenith, stars, horizon, bounce, ambient, sky_padding] = sky;
  const auto flash = [](FrameInput& input) {
    shared::Light& light = input.environment.flashes.emplace_back();
    light.position_world = {-1, 1.5f, 2};
    light.intensity = glm::vec3(4);
    light.range = shared::light_range(4);
    light.shadow_layer = shared::kShadowByVoxels;
  };
  expect_rows({
      {"sky.zenith", [](FrameInput& input) { input.environment.sky.zenith.r = 0.9f; }},
      {"sky.horizon", [](FrameInput& input) { input.environment.sky.horizon.g = 0.9f; }},
      {"sky.ambient", [](FrameInput& input) { input.environment.sky.ambient = glm::vec3(0.5f); }},
      {"sky.stars", [](FrameInput& input) { input.environment.sky.stars = 2; },
       [](FrameInput& input) { input.view.camera.target_world.y = 8; }},
      {"sky.bounce", [](FrameInput& input) { input.environment.sky.bounce = 0.8f; }},
      {"flashes", flash},
      {"flashes[0].intensity", [](FrameInput& input) { input.environment.flashes[0].intensity.r = 1; },
       flash},
      {"flashes[0].position_world",
       [](FrameInput& input) { input.environment.flashes[0].position_world.z -= 0.5f; }, flash},
      {"glow",
       [&](FrameInput& input) {
         flash(input);
         std::swap(input.environment.glow, input.environment.flashes);
       }},
      {"bounces", [](FrameInput& input) { input.environment.bounces = 1; }},
  });
}

TEST_F(FrameInputTest, TheLevel) {
  [[maybe_unused]] const auto& [voxels, hidden, grenades, moved, next] = input_.level;
  [[maybe_unused]] const auto& [grid, edits, opaque] = voxels;
  voxel::BitGrid walled = level();
  const sim::EditBlocks edit = sim::edit_box(level().layout(), {8, 2, 20}, {24, 10, 22}, true);
  for_each_in(Box<int>{{8, 2, 20}, {24, 10, 22}}, [&](glm::ivec3 v) { walled.set(v, true); });
  voxel::BitGrid without_wall = level();
  for_each_in(Box<int>{{0, 2, 0}, {32, 16, 8}}, [&](glm::ivec3 v) { without_wall.set(v, false); });
  const FieldChange moves{
      "moved",
      [](FrameInput& input) {
        input.level.hidden_objects = {1};
        input.level.moved = {{1, glm::translate(glm::mat4(1), glm::vec3(2.2f, 0.3f, 1.5f))}};
      },
      [](FrameInput& input) {
        input.level.hidden_objects = {1};
        input.level.moved = {{1, scene().objects[1].world_from_mesh}};
      }};
  expect_rows({
      {"voxels.grid, voxels.edits",
       [&](FrameInput& input) {
         input.level.voxels = {&walled, std::make_shared<const sim::EditBlocks>(edit), nullptr};
       }},
      {"hidden_objects", [](FrameInput& input) { input.level.hidden_objects = {1}; }},
      {"grenades",
       [](FrameInput& input) { input.level.grenades = {glm::translate(glm::mat4(1), glm::vec3(0, 1, 3))}; }},
      moves,
      {"next",
       [&](FrameInput& input) {
         input.level.next = std::make_shared<const planning::NextLevel>(planning::NextLevel{walled, {}});
       },
       {},
       "it never decides what is shown"},
  });
  input_.environment.bounces = 1;
  expect_rows({moves});
  // Edits say where a level changed: other voxels elsewhere are another level.
  FrameInput other = input_;
  other.level.voxels.opaque = &without_wall;
  EXPECT_FALSE(draw_first(input_) == draw_first(other)) << "voxels.opaque";
}

TEST_F(FrameInputTest, TheSmoke) {
  [[maybe_unused]] const auto& [volume, state, holes, look, swirl_period, time] = input_.smoke;
  [[maybe_unused]] const auto& [albedo, extinction, step, opaque, erosion, frequency, detail, rise, swirl,
                                swirl_width, phase, scattering, rim, padding] = look;
  [[maybe_unused]] const auto& [g_hg, g_draine, alpha, draine_weight] = phase;
  const auto look_row = [](const char* field, float shared::SmokeLook::*member, float value) {
    return FieldChange{field, [=](FrameInput& input) { input.smoke.look.*member = value; }};
  };
  const auto phase_row = [](const char* field, float shared::Phase::*member, float value) {
    return FieldChange{field, [=](FrameInput& input) { input.smoke.look.phase.*member = value; },
                       [](FrameInput& input) {
                         input.smoke.look.phase = {0.3f, 0.5f, 1, 0.4f};
                       }};
  };
  const auto alone = [](FrameInput& input) {
    input.volumes.clear();
    input.level.hidden_objects = {2};  // a bright emitter would show behind smoke
    input.smoke.look.extinction = 4;
  };
  const auto with_hole = [this](FrameInput& input) { input.smoke.holes = {&hole_, 1}; };
  expect_rows_of_bounced_light({
      {"volume", [](FrameInput& input) { other_smoke().show_in(input); }},
      {"volume = null", [](FrameInput& input) { input.smoke.volume = nullptr; }},
      {"state", [](FrameInput& input) { input.smoke.state = nullptr; }},
      {"holes", with_hole},
      {"look.albedo",
       [](FrameInput& input) {
         input.smoke.look.albedo = {0.9f, 0.5f, 0.5f};
       }},
      look_row("look.extinction", &shared::SmokeLook::extinction, 2),
      {"look.step_length", [](FrameInput& input) { input.smoke.look.step_length = 0.35f; }, alone},
      {"look.opaque_transmittance", [](FrameInput& input) { input.smoke.look.opaque_transmittance = 0.3f; },
       alone},
      look_row("look.erosion", &shared::SmokeLook::erosion, 0.7f),
      look_row("look.noise_frequency", &shared::SmokeLook::noise_frequency, 0.4f),
      look_row("look.detail", &shared::SmokeLook::detail, 0.9f),
      look_row("look.rise", &shared::SmokeLook::rise, 0.7f),
      look_row("look.swirl", &shared::SmokeLook::swirl, 0.4f),
      look_row("look.swirl_width", &shared::SmokeLook::swirl_width, 2.5f),
      look_row("look.multiple_scattering", &shared::SmokeLook::multiple_scattering, 0.2f),
      {"look.hole_rim", [](FrameInput& input) { input.smoke.look.hole_rim = 0.3f; }, with_hole},
      phase_row("look.phase.g_hg", &shared::Phase::g_hg, -0.4f),
      phase_row("look.phase.g_draine", &shared::Phase::g_draine, -0.2f),
      phase_row("look.phase.alpha", &shared::Phase::alpha, 6),
      phase_row("look.phase.draine_weight", &shared::Phase::draine_weight, 0.9f),
      {"swirl_period", [](FrameInput& input) { input.smoke.swirl_period = 5; },
       [](FrameInput& input) { input.smoke.look.swirl = 0.4f; }},
      {"time", [](FrameInput& input) { input.smoke.time += 0.7f; }},
  });
}

TEST_F(FrameInputTest, Volumes) {
  [[maybe_unused]] const auto& [density, placement, look, heat, preview, from_preview, transfer, colors,
                                tints, disturbance, detail, index, voxel_depth] = input_.volumes[0];
  [[maybe_unused]] const auto& [albedo, extinction, emission, anisotropy, scattering, padding] = look;
  [[maybe_unused]] const auto& [warm, warm_placement, kelvin, high, gain, warm_preview, warm_from] = heat;
  [[maybe_unused]] const auto& [opacity, color_map, range, glow, strength] = transfer;
  [[maybe_unused]] const auto& [noise_from_file, noise, noise_time] = disturbance;
  [[maybe_unused]] const auto& [amount, size, drift, grow] = noise;
  [[maybe_unused]] const auto& [detail_from_file, detail_noise, densest, detail_time] = detail;
  [[maybe_unused]] const auto& [wear, billow, wind] = detail_noise;
  expect_rows_of_bounced_light({
      {"volumes", [](FrameInput& input) { input.volumes.clear(); }},
      {"volume", [this](FrameInput& input) { volume(input).volume = &preview_; }},
      {"world_from_voxel", [](FrameInput& input) { volume(input).world_from_voxel[3].y += 0.3f; }},
      {"look.albedo",
       [](FrameInput& input) {
         volume(input).look.albedo = {0.9f, 0.2f, 0.2f};
       }},
      {"look.extinction", [](FrameInput& input) { volume(input).look.extinction = 3; }},
      {"look.emission", [](FrameInput& input) { volume(input).look.emission = glm::vec3(0.3f); }},
      {"look.anisotropy", [](FrameInput& input) { volume(input).look.anisotropy = -0.5f; }},
      {"look.multiple_scattering", [](FrameInput& input) { volume(input).look.multiple_scattering = 0; }},
      // Light is found by the preview, too.
      {"preview", [this](FrameInput& input) { volume(input).preview = &preview_; }},
      {"index",
       [](FrameInput& input) { volume(input).index = 3; },
       {},
       "it names the volume to what glows in it, and nothing does"},
      {"voxel_depth", [](FrameInput& input) { volume(input).voxel_depth = 2 * shared::kDenseVoxelDepth; }},
  });
}

TEST_F(FrameInputTest, WhatGlowsInVolumes) {
  const auto tinted = field<std::uint64_t>({2, 2, 2}, [](glm::vec3 p) {
    return glm::packHalf4x16({p.x / 16, 0.5f, 0.2f, 0});
  });
  expect_rows_of_bounced_light({
      {"heat", add_heat},
      {"heat.world_from_voxel", [](FrameInput& input) { volume(input).heat.world_from_voxel[3].x += 0.4f; },
       add_heat},
      {"heat.kelvin", [](FrameInput& input) { volume(input).heat.kelvin = 1900; }, add_heat},
      {"heat.high", [](FrameInput& input) { volume(input).heat.high = 4; }, add_heat},
      {"heat.emission", [](FrameInput& input) { volume(input).heat.emission = 3; }, add_heat},
      {"transfer", add_transfer},
      {"transfer.color_map", [](FrameInput& input) { volume(input).transfer.color_map.name = "magma"; },
       add_transfer},
      {"transfer.range",
       [](FrameInput& input) {
         volume(input).transfer.range = {0.2f, 0.7f};
       },
       add_transfer},
      {"transfer.glow", [](FrameInput& input) { volume(input).transfer.glow = 0.9f; }, add_transfer},
      {"transfer.emission", [](FrameInput& input) { volume(input).transfer.emission = 3; }, add_transfer},
      {"colors", [&](FrameInput& input) { volume(input).colors = &tinted; }},
      {"tints", [](FrameInput& input) { volume(input).tints = {glm::vec3(2, 0, 0)}; },
       [&](FrameInput& input) {
         volume(input).colors = &tinted;
         volume(input).tints = {glm::vec3(0, 0, 2)};
       }},
  });
}

TEST_F(FrameInputTest, NoiseInVolumes) {
  expect_rows_of_bounced_light({{"disturbance", add_disturbance}, {"detail", add_detail}});
  input_.environment.bounces = 0;
  expect_rows({
      {"disturbance.voxel_from_file",
       [](FrameInput& input) { volume(input).disturbance.voxel_from_file[0][0] = 2; }, add_disturbance},
      {"disturbance.noise.size", [](FrameInput& input) { volume(input).disturbance.noise.size = 3; },
       add_disturbance},
      {"disturbance.noise.drift",
       [](FrameInput& input) {
         volume(input).disturbance.noise.drift = {0, 4, 0};
       },
       add_disturbance},
      {"disturbance.noise.grow", [](FrameInput& input) { volume(input).disturbance.noise.grow = 12; },
       add_disturbance},
      {"disturbance.time", [](FrameInput& input) { volume(input).disturbance.time = 2; }, add_disturbance},
      {"detail.voxel_from_file", [](FrameInput& input) { volume(input).detail.voxel_from_file[0][0] = 2; },
       add_detail},
      {"detail.noise.size", [](FrameInput& input) { volume(input).detail.noise.size = 3; }, add_detail},
      {"detail.noise.drift",
       [](FrameInput& input) {
         volume(input).detail.noise.drift = {0, 4, 0};
       },
       add_detail},
      {"detail.densest", [](FrameInput& input) { volume(input).detail.densest = 2; }, add_detail},
      {"detail.time", [](FrameInput& input) { volume(input).detail.time = 2; }, add_detail},
  });
}

TEST_F(FrameInputTest, SlicesAndDecals) {
  [[maybe_unused]] const auto& [placement, volume, strength, gamma, correction, falloff, fade, scatter,
                                middle, radius] = input_.decals[0];
  const auto decal_row = [](const char* field, float planning::DecalInput::*member, float value) {
    return FieldChange{field, [=](FrameInput& input) { input.decals[0].*member = value; }};
  };
  const auto two = two_slices();
  const auto curved = [](FrameInput& input) { input.decals[0].gamma = 0.4f; };
  const auto with_two = [&](FrameInput& input) { input.slices = two; };
  expect_rows({
      {"slices",
       [&](FrameInput& input) { input.slices = std::make_shared<const grids::DenseVolumes>(1, (*two)[1]); }},
      {"decals", [](FrameInput& input) { input.decals.clear(); }},
      {"decals[0].world_from_box", [](FrameInput& input) { input.decals[0].world_from_box[3].x += 0.5f; }},
      {"decals[0].volume", [](FrameInput& input) { input.decals[0].volume = 1; }, with_two},
      decal_row("decals[0].strength", &planning::DecalInput::strength, 0.3f),
      decal_row("decals[0].gamma", &planning::DecalInput::gamma, 2),
      {"decals[0].correction", [](FrameInput& input) { input.decals[0].correction = 0.3f; }, curved},
      {"decals[0].falloff", [](FrameInput& input) { input.decals[0].falloff = 3; }, curved},
      decal_row("decals[0].fade", &planning::DecalInput::fade, 0.4f),
      decal_row("decals[0].scatter", &planning::DecalInput::scatter, 1),
      {"decals[0].middle",
       [](FrameInput& input) {
         input.decals[0].middle = {0.3f, 0.2f, 0};
       },
       [](FrameInput& input) { input.decals[0].radius = 0.2f; }},
      decal_row("decals[0].radius", &planning::DecalInput::radius, 0.2f),
  });
}

TEST_F(FrameInputTest, Particles) {
  [[maybe_unused]] const auto& [from_uvw, slices, tints, extinction, count, quad, seed, time, drift, swirl,
                                swirl_seconds, softness, index] = input_.particles[0];
  const auto particle_row = [](const char* field, auto planning::ParticleInput::*member, auto value) {
    return FieldChange{field, [=](FrameInput& input) { input.particles[0].*member = value; }};
  };
  const auto two = two_slices();
  const auto with_two = [&](FrameInput& input) { input.slices = two; };
  expect_rows({
      {"particles", [](FrameInput& input) { input.particles.clear(); }},
      {"particles[0].world_from_uvw",
       [](FrameInput& input) { input.particles[0].world_from_uvw[3].y += 0.2f; }},
      {"particles[0].slices", [](FrameInput& input) { input.particles[0].slices = 1; }, with_two},
      {"particles[0].tints",
       [](FrameInput& input) {
         input.particles[0].tints[0] = {4, 1, 1};
       }},
      particle_row("particles[0].extinction", &planning::ParticleInput::extinction, 2.0f),
      particle_row("particles[0].count", &planning::ParticleInput::count, 30u),
      particle_row("particles[0].radius", &planning::ParticleInput::radius, 0.3f),
      particle_row("particles[0].seed", &planning::ParticleInput::seed, 7u),
      particle_row("particles[0].time", &planning::ParticleInput::time, 1.3),
      {"particles[0].drift", [](FrameInput& input) { input.particles[0].drift = 0.3f; },
       [](FrameInput& input) { input.particles[0].time = 1; }},
      particle_row("particles[0].swirl", &planning::ParticleInput::swirl, 0.2f),
      {"particles[0].swirl_seconds", [](FrameInput& input) { input.particles[0].swirl_seconds = 2; },
       [](FrameInput& input) { input.particles[0].time = 1; }},
      particle_row("particles[0].softness", &planning::ParticleInput::softness, 2.0f),
      {"particles[0].index",
       [](FrameInput& input) { input.particles[0].index = 3; },
       {},
       "it names the volume in messages"},
  });
}

TEST_F(FrameInputTest, QualityAndDebugViews) {
  [[maybe_unused]] const auto& [step_scale, error_scale, fine_shadows, detail, light, indirect, rebuild,
                                bytes] = input_.quality;
  [[maybe_unused]] const auto& [view, slice] = input_.debug;
  const auto close = [](FrameInput& input) {
    input.view.camera = {{-1.1f, 0.9f, 2.2f}, {-1.2f, 0.6f, 0.4f}, 0.9f};
  };
  expect_rows({
      {"step_scale", [](FrameInput& input) { input.quality.step_scale = 2; }},
      {"resolve_error_scale",
       [](FrameInput& input) { input.quality.resolve_error_scale = 3; },
       {},
       "every pixel has a ray (MediaOptions::march_scale)"},
      {"fine_shadows", [](FrameInput& input) { input.quality.fine_shadows = false; }, close},
      {"detail", [](FrameInput& input) { input.quality.detail = false; }, close},
      {"light_update_fraction",
       [](FrameInput& input) { input.quality.light_update_fraction = 0.25f; },
       {},
       "no light changed"},
      {"indirect_update_fraction",
       [](FrameInput& input) { input.quality.indirect_update_fraction = 0.25f; },
       {},
       "no light changed"},
      {"rebuild_light",
       [](FrameInput& input) { input.quality.rebuild_light = true; },
       {},
       "rebuilt light equals cached light"},
      {"volume_upload_bytes",
       [](FrameInput& input) { input.quality.volume_upload_bytes = 1 << 20; },
       {},
       "volumes without a preview are uploaded at once"},
      {"debug.view", [](FrameInput& input) { input.debug.view = planning::DebugView::depth; }},
      {"debug.slice",
       [](FrameInput& input) {
         input.debug.slice = {1, 0.4f};
       },
       [](FrameInput& input) {
         input.debug.view = planning::DebugView::density;
         input.debug.slice = {1, 1.2f};
       }},
  });
}

TEST_F(FrameInputTest, AllGroups) {
  [[maybe_unused]] const auto& [view, environment, level, smoke, volumes, slices, decals, particles, tanks,
                                quality, debug] = input_;
  EXPECT_TRUE(tanks.empty()) << "tank_frames_test.cpp has theirs";
}

}  // namespace
}  // namespace brume::render
