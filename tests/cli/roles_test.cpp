// Roles end to end: levels of files, seen by `brume query`, Sight, the C interface, and by a ray among
// triangles.
#include <gtest/gtest.h>
#include <brume/brume.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "apps/cli/coverage.hpp"
#include "image/png.hpp"
#include "scenario/world_triangles.hpp"
#include "smoke/holes.hpp"
#include "surfaces/surfaces.hpp"
#include "tests/cli/command_test.hpp"

namespace brume::cli {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec3;
// ---- Levels ----

/// Boxes with their looks, as a glTF file.
class Level {
 public:
  /// `extras`: of the node, or empty.
  void add(const std::string& name, const std::string& look, vec3 low, vec3 high) {
    static const char* const kLooks[] = {"brick", "pane", "leaves"};
    const auto material = std::find(std::begin(kLooks), std::end(kLooks), look) - std::begin(kLooks);
    const vec3 middle = 0.5f * (low + high), size = high - low;
    nodes_.push_back({{"name", name},
                      {"mesh", material},
                      {"translation", {middle.x, middle.y, middle.z}},
                      {"scale", {size.x, size.y, size.z}}});
  }

  /// Writes level.gltf, whose cube has three materials, and leaves.png, of which a half is cut out.
  void write(const WorkFolder& folder) const {
    image::Image8 leaves{2, 2, {}};
    for (const int alpha : {255, 0, 0, 255})
      leaves.rgba.insert(leaves.rgba.end(), {40, 90, 20, static_cast<std::uint8_t>(alpha)});
    image::save_png(folder.path() / "leaves.png", leaves).value_or_throw();
    folder.write("cube.bin", cube());
    Json nodes = nodes_, meshes = Json::array();
    for (int i = 0; i < 3; ++i)
      meshes.push_back(
          {{"primitives",
            {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 2}}}, {"indices", 1}, {"material", i}}}}});
    const Json file{{"asset", {{"version", "2.0"}}},
                    {"nodes", nodes},
                    {"meshes", meshes},
                    {"materials",
                     {{{"name", "brick"}},
                      {{"name", "pane"},
                       {"alphaMode", "BLEND"},
                       {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.1}}}}},
                      {{"name", "leaves"},
                       {"alphaMode", "MASK"},
                       {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}}},
                    {"textures", {{{"source", 0}}}},
                    {"images", {{{"uri", "leaves.png"}}}},
                    {"buffers", {{{"uri", "cube.bin"}, {"byteLength", 232}}}},
                    {"bufferViews",
                     {{{"buffer", 0}, {"byteLength", 96}},
                      {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 72}},
                      {{"buffer", 0}, {"byteOffset", 168}, {"byteLength", 64}}}},
                    {"accessors",
                     {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
                      {{"bufferView", 1}, {"componentType", 5123}, {"count", 36}, {"type", "SCALAR"}},
                      {{"bufferView", 2}, {"componentType", 5126}, {"count", 8}, {"type", "VEC2"}}}}};
    folder.write("level.gltf", file.dump());
  }

 private:
  /// Corners at +-0.5, indices, and texture coordinates by which each face shows the whole image.
  static std::string cube() {
    std::string bytes;
    const auto append = [&](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (int i = 0; i < 8; ++i)
      for (int axis = 0; axis < 3; ++axis) append((i >> axis & 1) != 0 ? 0.5f : -0.5f);
    for (const int i : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                        2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
      append(static_cast<std::uint16_t>(i));
    for (int i = 0; i < 8; ++i)
      for (const int axis : {0, 1}) append(static_cast<float>((i >> axis & 1) + (i >> 2 & 1)));
    return bytes;
  }
  std::vector<Json> nodes_;
};

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  float within(float low, float high) {
    return low + (high - low) * static_cast<float>(random_() >> 8) * 0x1p-24f;
  }
  vec3 within(vec3 low, vec3 high) {
    const float x = within(low.x, high.x), y = within(low.y, high.y);
    return {x, y, within(low.z, high.z)};
  }
  unsigned below(unsigned n) { return static_cast<unsigned>(random_() % n); }

 private:
  std::mt19937 random_;
};

constexpr vec3 kLow(-4, 0, -3), kHigh(4, 3, 3);  // of the room

/// A screen across x or z, part of the room's width and height.
void add_screen(Level& level, Random& random, const std::string& name, const std::string& look) {
  const bool across_x = random.below(2) == 0;
  const float thick = random.within(0.01f, 0.2f);
  vec3 low = random.within(kLow, vec3(2, 1, 1.5f)), high = low + random.within(vec3(1, 1, 1), vec3(3, 2, 2));
  high[across_x ? 0 : 2] = low[across_x ? 0 : 2] + thick;
  level.add(name, look, low, high);
}

/// A floor and a few screens: walls, panes by their material and by name, leaves by their texture, fences by
/// name and by the timeline, cables that are ghosts. With a smoke.
void write_level(const WorkFolder& folder, unsigned seed) {
  Random random(seed);
  Level level;
  level.add("floor", "brick", kLow - vec3(0.5f, 0.3f, 0.5f), vec3(kHigh.x + 0.5f, 0, kHigh.z + 0.5f));
  const std::pair<const char*, const char*> kinds[] = {
      {"wall", "brick"},        {"pane", "pane"},   {"GLASS_box", "brick"},    {"bush", "leaves"},
      {"GRILLE_gate", "brick"}, {"fence", "brick"}, {"IGNORE_cable", "brick"}, {"shutter", "pane"}};
  for (const auto& [name, look] : kinds)
    for (unsigned count = 1 + random.below(2); count > 0; --count) add_screen(level, random, name, look);
  level.write(folder);
  const vec3 at = random.within(vec3(-3, 1, -2), vec3(3, 2, 2)),
             from = random.within(vec3(-3, 1, -2), vec3(3, 2, 2));
  char smoke[160];
  std::snprintf(
      smoke, sizeof smoke,
      "[[event]]\ntype = \"smoke\"\ntime = 0.5\nfrom = [%.3f, %.3f, %.3f]\nat = [%.3f, %.3f, %.3f]\n",
      double{from.x}, double{from.y}, double{from.z}, double{at.x}, double{at.y}, double{at.z});
  folder.write(
      "level.toml",
      "version = 1\nscene = \"level.gltf\"\nduration = 6.0\n[grid]\nvoxel = 0.25\n[smoke]\nvoxels = 900\n"
      "[[role]]\nobject = \"fence\"\nrole = \"grille\"\n[[role]]\nobject = \"shutter\"\nrole = \"wall\"\n" +
          std::string(smoke));
}

// ---- The reference: a segment among triangles, in double ----

struct Triangle3 {
  dvec3 a, b, c;
};

double distance_of_point(const dvec3& p, const Triangle3& t) {
  // The nearest point of the plane if it lies inside, else of the edges.
  const dvec3 n = glm::cross(t.b - t.a, t.c - t.a);
  const auto inside = [&](const dvec3& u, const dvec3& v) {
    return glm::dot(glm::cross(v - u, p - u), n) >= 0;
  };
  if (inside(t.a, t.b) && inside(t.b, t.c) && inside(t.c, t.a))
    return std::abs(glm::dot(p - t.a, n)) / glm::length(n);
  double least = std::numeric_limits<double>::infinity();
  for (const auto& [u, v] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)}) {
    const double at = std::clamp(glm::dot(p - u, v - u) / glm::dot(v - u, v - u), 0.0, 1.0);
    least = std::min(least, glm::length(p - (u + at * (v - u))));
  }
  return least;
}

/// Of two segments (Ericson 2005, section 5.1.9).
double distance_of_segments(const dvec3& p, const dvec3& q, const dvec3& u, const dvec3& v) {
  const dvec3 d = q - p, e = v - u, r = p - u;
  const double a = glm::dot(d, d), f = glm::dot(e, r), g = glm::dot(e, e), c = glm::dot(d, r),
               b = glm::dot(d, e);
  const double denominator = a * g - b * b;
  double s = denominator > 0 ? std::clamp((b * f - c * g) / denominator, 0.0, 1.0) : 0;
  double t = (b * s + f) / g;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return glm::length((p + s * d) - (u + t * e));
}

/// Where the segment meets the triangle, as a fraction; nothing for a miss. Moeller and Trumbore 1997.
std::optional<double> hit(const dvec3& p, const dvec3& q, const Triangle3& t) {
  const dvec3 d = q - p, ab = t.b - t.a, ac = t.c - t.a, n = glm::cross(d, ac);
  const double determinant = glm::dot(ab, n);
  if (determinant == 0) return std::nullopt;
  const dvec3 from = p - t.a;
  const double u = glm::dot(from, n) / determinant;
  const dvec3 m = glm::cross(from, ab);
  const double v = glm::dot(d, m) / determinant, at = glm::dot(ac, m) / determinant;
  if (!(u >= 0 && v >= 0 && u + v <= 1 && at >= 0 && at <= 1)) return std::nullopt;
  return at;
}

double distance_of_segment(const dvec3& p, const dvec3& q, const Triangle3& t) {
  if (hit(p, q, t)) return 0;
  double least = std::min(distance_of_point(p, t), distance_of_point(q, t));
  for (const auto& [u, v] : {std::pair(t.a, t.b), std::pair(t.b, t.c), std::pair(t.c, t.a)})
    least = std::min(least, distance_of_segments(p, q, u, v));
  return least;
}

enum class Truth { visible, hidden, either };

/// What a line of sight among walls of voxels must say of a segment among walls of triangles. A wall's voxels
/// are those that its triangles touch, and a segment is hidden if it passes one of them that contains none of
/// its ends. So:
/// - A voxel on the segment that a triangle touches has a point of both: where all triangles are farther from
/// the
///   segment than a voxel's diagonal, nothing hides it.
/// - A triangle that the segment meets touches the voxel of the point where they meet, which hides the
/// segment if it
///   contains neither end.
/// In between either answer is right: the wall is as thick as its voxels. So it is where the segment meets a
/// triangle within `kRounding` of a voxel's face, which floats may pass on the other side of: coordinates are
/// below 2^6 voxels, and their sums have 24 bits.
Truth truth_of(const std::vector<Triangle3>& walls, const voxel::GridLayout& layout, vec3 from, vec3 to) {
  constexpr double kRounding = 0x1p-12;  // voxels
  const double edge = layout.voxel_size;
  const dvec3 p(from), q(to);
  const auto voxel_at = [&](const dvec3& world) { return (world - dvec3(layout.origin_world)) / edge; };
  const dvec3 first = glm::floor(voxel_at(p)), last = glm::floor(voxel_at(q));
  double nearest = std::numeric_limits<double>::infinity();
  for (const Triangle3& t : walls) {
    nearest = std::min(nearest, distance_of_segment(p, q, t));
    const auto at = hit(p, q, t);
    if (!at) continue;
    const dvec3 place = voxel_at(p + *at * (q - p)), cell = glm::floor(place), within = place - cell;
    const bool clear = std::min({within.x, within.y, within.z}) > kRounding &&
                       std::max({within.x, within.y, within.z}) < 1 - kRounding;
    if (clear && cell != first && cell != last) return Truth::hidden;
  }
  return nearest > (std::sqrt(3.0) + kRounding) * edge ? Truth::visible : Truth::either;
}

std::vector<Triangle3> walls_of(const scene::Scene& scene) {
  std::vector<Triangle3> walls;
  for (const voxel::Triangle& t : scenario::world_triangles(scene, stops_sight))
    walls.push_back({dvec3(t.a), dvec3(t.b), dvec3(t.c)});
  return walls;
}

// ---- The C interface of the same level ----

struct Embedded {
  api::Context context;
  std::vector<brume_point> points;
  std::vector<std::uint32_t> indices;
  std::vector<std::uint8_t> roles;
  std::optional<api::Level> level;
  std::optional<api::World> world;
  std::optional<api::Field> field;

  Embedded(const scenario::Scenario& scenario, const sim::World& other) {
    for (const scene::Object& object : scenario.scene.objects)
      for (const voxel::Triangle& t : scenario::object_triangles(scenario.scene, object)) {
        roles.push_back(static_cast<std::uint8_t>(object.role));
        for (const vec3& corner : {t.a, t.b, t.c}) {
          indices.push_back(static_cast<std::uint32_t>(points.size()));
          points.push_back({corner.x, corner.y, corner.z});
        }
      }
    const voxel::GridLayout& layout = scenario.voxels.grid.layout();
    brume_triangles_params params = brume_triangles_defaults();
    params.layout = {{layout.size.x, layout.size.y, layout.size.z},
                     layout.voxel_size,
                     {layout.origin_world.x, layout.origin_world.y, layout.origin_world.z}};
    params.points = points.data();
    params.point_count = points.size();
    params.indices = indices.data();
    params.index_count = indices.size();
    params.roles = roles.data();
    level.emplace(context, params);
    world.emplace(*level);
    for (const sim::Event& logged : other.log()) {
      const auto& smoke = std::get<sim::ThrowSmoke>(logged);
      brume_event event = brume_event_defaults(BRUME_EVENT_SMOKE, smoke.tick);
      event.u.smoke = {{smoke.from.x, smoke.from.y, smoke.from.z},
                       {smoke.at.x, smoke.at.y, smoke.at.z},
                       smoke.smoke.voxels,
                       smoke.smoke.bloom_ticks,
                       smoke.smoke.hold_ticks,
                       smoke.smoke.dissolve_ticks};
      world->append(event);
    }
    world->advance_to(other.tick());
    brume_field_params field_params = brume_field_defaults();
    field_params.extinction = scenario.timeline.smoke.extinction;
    field.emplace(*level, field_params);
    field->update(world->state());
  }
};

// ---- Agreement ----

constexpr int kPairs = 1000;

struct Counts {
  int visible = 0, hidden = 0, either = 0, through = 0, smoky = 0, pictured = 0;
};

/// Whether the segment meets what is drawn opaque, but lets sight pass.
bool meets_screen(const scene::Scene& scene, vec3 from, vec3 to) {
  for (const scene::Object& object : scene.objects)
    if (!stops_sight(object.role) && !scene::is_pane(object))
      for (const voxel::Triangle& t : scenario::object_triangles(scene, object))
        if (hit(dvec3(from), dvec3(to), {dvec3(t.a), dvec3(t.b), dvec3(t.c)})) return true;
  return false;
}

/// Whether the segment meets glass or a grille, but no wall.
bool is_through(const scene::Scene& scene, vec3 from, vec3 to) {
  bool any = false;
  for (const voxel::Triangle& t : scenario::world_triangles(
           scene, [](Role role) { return role == Role::glass || role == Role::grille; }))
    any |= hit(dvec3(from), dvec3(to), {dvec3(t.a), dvec3(t.b), dvec3(t.c)}).has_value();
  return any;
}

void compare_level(const WorkFolder& folder, unsigned seed, Counts& counts) {
  const scenario::Scenario scenario =
      scenario::load_scenario(folder.path() / "level.toml", {}).value_or_throw();
  const auto simulation = scenario::Simulation::create(scenario).value_or_throw();
  const std::vector<Triangle3> walls = walls_of(scenario.scene);
  // What pictures show: the G-buffer draws the same (GBufferPass).
  const planning::LevelState all;
  const surfaces::Surfaces drawn(scenario.scene, {&all, 1});
  Random random(1000 + seed);
  for (const double time : {0.0, 3.0}) {
    simulation->advance_to(time);
    const sim::State& state = simulation->world().state();
    const Embedded embedded(scenario, simulation->world());
    ASSERT_EQ(embedded.world->hash(), simulation->world().state_hash()) << "the grenade landed elsewhere";
    const std::vector<shared::Hole> holes = smoke::make_holes(state);
    const smoke::Sight sight(simulation->volume(), simulation->world().solids().sight, holes,
                             state.seconds(state.tick), {scenario.timeline.smoke.extinction});
    std::vector<smoke::Segment> segments;
    for (int i = 0; i < kPairs; ++i) {
      const vec3 from = random.within(kLow, kHigh);
      segments.push_back({from, random.within(kLow, kHigh)});
    }
    std::vector<std::uint8_t> many(segments.size());
    sight.visible(segments, 3, many).value_or_throw();
    for (std::size_t i = 0; i < segments.size(); ++i) {
      const auto& [a, b] = segments[i];
      const SightSample query = sample_sight(scenario, *simulation, {a, b});
      const bool visible = query.hidden_by == HiddenBy::nothing;
      const brume_segment segment{{a.x, a.y, a.z}, {b.x, b.y, b.z}};
      ASSERT_EQ(many[i] != 0, visible) << "Sight, pair " << i;
      ASSERT_EQ(embedded.field->visible(segment, 3), visible) << "the C interface, pair " << i;
      ASSERT_EQ(embedded.field->first_wall(segment).has_value(), query.wall.has_value()) << i;
      counts.smoky += query.hidden_by == HiddenBy::smoke;
      if (time > 0) continue;
      const Truth truth = truth_of(walls, scenario.voxels.grid.layout(), a, b);
      counts.visible += truth == Truth::visible;
      counts.hidden += truth == Truth::hidden;
      counts.either += truth == Truth::either;
      counts.through += visible && is_through(scenario.scene, a, b);
      if (truth != Truth::either && !meets_screen(scenario.scene, a, b)) {
        const float distance = glm::distance(a, b);
        ASSERT_EQ(!drawn.occluded({a, (b - a) / distance, distance}), visible) << "the picture, pair " << i;
        ++counts.pictured;
      }
      if (truth != Truth::either) {
        ASSERT_EQ(visible, truth == Truth::visible)
            << "triangles, pair " << i << ": " << a.x << "," << a.y << "," << a.z << " to " << b.x << ","
            << b.y << "," << b.z;
      }
    }
  }
}

TEST(Roles, AllAgreeOnFortyLevels) {
  Counts counts;
  for (unsigned seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE("level " + std::to_string(seed));
    const WorkFolder folder;
    write_level(folder, seed);
    compare_level(folder, seed, counts);
    if (testing::Test::HasFatalFailure()) return;
  }
  // Each kind of answer was among them.
  for (const int count : {counts.visible, counts.hidden, counts.through, counts.smoky, counts.pictured})
    EXPECT_GT(count, 100);
  RecordProperty("either", counts.either);
  std::printf(
      "must be visible %d, hidden %d, either %d; visible through glass or grilles %d; hidden by smoke %d; "
      "as drawn %d\n",
      counts.visible, counts.hidden, counts.either, counts.through, counts.smoky, counts.pictured);
}

// ---- The program ----

class RolesOfFiles : public CommandTest {
 protected:
  /// A screen between two places, with a floor below.
  RolesOfFiles() {
    Level level;
    level.add("floor", "brick", vec3(-4, -0.3f, -4), vec3(4, 0, 4));
    level.add("screen", "pane", vec3(-2, 0, -0.01f), vec3(2, 3, 0.01f));
    level.add("bush", "leaves", vec3(-2, 0, 1), vec3(2, 3, 1.2f));
    level.write(folder_);
  }
  Outcome query(const std::string& file, const std::vector<std::string>& more = {}) const {
    return run({"query", file, "--from", "0,1.5,3", "--to", "0,1.5,-3", "--time", "0"}, more);
  }
  std::string timeline(const std::string& roles) const {
    return folder_.write("t.toml", "version = 1\nscene = \"level.gltf\"\n" + roles);
  }
};

TEST_F(RolesOfFiles, APaneThatIsNotDrawnHidesNothing) {
  const Outcome seen = query("level.gltf", {"--expect", "visible"});
  EXPECT_EQ(seen.exit_code, 0) << seen.error;
  const Json answer = Json::parse(query("level.gltf", {"--json", "-"}).out);
  EXPECT_TRUE(answer["visible"]);
  EXPECT_TRUE(answer["hidden_by"].is_null());
  EXPECT_TRUE(answer["first_solid"].is_null());
}

TEST_F(RolesOfFiles, ATimelineDecides) {
  for (const char* object : {"screen", "bush"})
    for (const char* role : {"wall", "glass", "grille", "ghost"}) {
      timeline("[[role]]\nobject = \"" + std::string(object) + "\"\nrole = \"" + role + "\"\n");
      const bool hidden = std::string(role) == "wall";
      const Outcome run = query("t.toml", {"--expect", hidden ? "hidden" : "visible"});
      EXPECT_EQ(run.exit_code, 0) << object << " " << role << ": " << run.error;
      EXPECT_EQ(run.out.find("hidden by wall") != std::string::npos, hidden) << run.out;
    }
}

TEST_F(RolesOfFiles, WrongNamesAreAnswered) {
  timeline("[[role]]\nobject = \"sceen\"\nrole = \"wall\"\n");
  const Outcome object = query("t.toml");
  EXPECT_NE(object.exit_code, 0);
  EXPECT_NE(object.error.find("t.toml:4:10: the scene has no object \"sceen\"; did you mean \"screen\""),
            std::string::npos)
      << object.error;
  timeline("[[role]]\nobject = \"screen\"\nrole = \"window\"\n");
  const Outcome role = query("t.toml");
  EXPECT_NE(role.exit_code, 0);
  EXPECT_NE(role.error.find("expected \"wall\", \"glass\", \"grille\" or \"ghost\""), std::string::npos)
      << role.error;
}

TEST_F(RolesOfFiles, InfoAndVoxelizeCountThem) {
  const Json scene = json_of({"info", "level.gltf"});
  EXPECT_EQ(scene["roles"], (Json{{"wall", 12}, {"glass", 12}, {"grille", 12}, {"ghost", 0}}));
  EXPECT_EQ(scene["solid_triangles"], 24);
  timeline("[[role]]\nobject = \"bush\"\nrole = \"wall\"\n");
  const Json of_timeline = json_of({"info", "t.toml"});
  EXPECT_EQ(of_timeline["roles"], (Json{{"wall", 24}, {"glass", 12}, {"grille", 0}, {"ghost", 0}}));
  const Arguments voxelize{"voxelize", "level.gltf", "-o", "a.vxl"};
  const Json voxels = json_of(voxelize);
  EXPECT_GT(voxels["glass"], 0);
  EXPECT_GT(voxels["grilles"], 0);
  const Json again = json_of(voxelize);
  EXPECT_TRUE(again["cached"]);
  EXPECT_EQ(again["glass"], voxels["glass"]);
  const Json file = json_of({"info", "a.vxl"});
  EXPECT_EQ(file["glass"], voxels["glass"]);
  EXPECT_EQ(file["grilles"], voxels["grilles"]);
}

}  // namespace
}  // namespace brume::cli
