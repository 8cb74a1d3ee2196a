// What was shot and blown up just now, drawn over the image: a muzzle flash, a tracer, sparks and a mark
// where it hit, and a fireball. Walls hide them, and smoke dims them as it dims a line of sight.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/viewer/ui_parts.hpp"
#include "scenario/aim.hpp"
#include "smoke/holes.hpp"
#include "smoke/sight.hpp"

namespace brume::viewer {
namespace {

// Lifetimes [s]. Longer than the longest frame, so that each shows.
constexpr double kFlashSeconds = 0.27, kTracerSeconds = 0.45, kSparkSeconds = 0.45, kMarkSeconds = 6,
                 kFireballSeconds = 0.6;
constexpr float kRange = 100;  // [m], of a shot
constexpr int kTracerParts = 20;
constexpr glm::vec3 kHot{1, 0.93f, 0.75f}, kFire{1, 0.62f, 0.24f}, kScorch{0.05f, 0.045f, 0.04f},
    kDust{0.75f, 0.7f, 0.64f};

ImU32 colour_of(glm::vec3 colour, float alpha) {
  return ImGui::ColorConvertFloat4ToU32(ImVec4(colour.x, colour.y, colour.z, std::clamp(alpha, 0.0f, 1.0f)));
}

ImVec2 vec(glm::vec2 v) {
  return {v.x, v.y};
}

/// How visible world points are from the eye, and where they are on the display.
class Eye {
 public:
  Eye(const Game& game)
      : session_(game.session()),
        camera_(game.player().camera()),
        scenario_(session_.live().scenario()),
        holes_(smoke::make_holes(session_.simulation().world().state(), &scenario_.masks)),
        sight_(session_.simulation().volume(), session_.simulation().world().solids().sight, holes_,
               static_cast<float>(session_.seconds()), settings(scenario_)) {}

  std::optional<glm::vec2> at(glm::vec3 world) const { return on_display(camera_, world); }
  /// Transmittance to a point; 0 behind a wall.
  float visibility(glm::vec3 world) const {
    // Short of the point, which may lie on a wall.
    const glm::vec3 eye = camera_.position_world;
    const float distance = glm::length(world - eye);
    const float voxel = scenario_.voxels.grid.layout().voxel_size;
    const glm::vec3 end = glm::mix(eye, world, std::max(1 - voxel / std::max(distance, voxel), 0.05f));
    const auto wall = sight_.first_wall(eye, end);
    const auto depth = sight_.optical_depth(eye, end);
    return !wall || *wall || !depth ? 0 : std::exp(-*depth);
  }
  /// Size of a length at a point on the display [px].
  float pixels(glm::vec3 world, float length) const {
    const float distance = std::max(glm::length(world - camera_.position_world), 0.1f);
    return 0.5f * ImGui::GetIO().DisplaySize.y * length / (distance * std::tan(0.5f * camera_.vertical_fov));
  }

 private:
  static smoke::SightSettings settings(const scenario::Scenario& scenario) {
    smoke::SightSettings settings;
    settings.extinction = scenario.timeline.smoke.extinction;
    settings.masks = &scenario.masks;
    return settings;
  }
  const Session& session_;
  scene::Camera camera_;
  const scenario::Scenario& scenario_;
  std::vector<shared::Hole> holes_;
  smoke::Sight sight_;
};

/// A disc that fades towards its rim.
void glow(ImDrawList& list, glm::vec2 at, float radius, glm::vec3 colour, float alpha) {
  constexpr int kDiscs = 40;  // so many that no ring shows
  for (int i = 1; i <= kDiscs; ++i)
    list.AddCircleFilled(vec(at), radius * static_cast<float>(i) / kDiscs, colour_of(colour, alpha / kDiscs));
}

/// The remaining fraction of a lifetime; 0 before and after.
float remaining(double event_time, double seconds, double lifetime) {
  const double age = seconds - event_time;
  return age >= 0 && age < lifetime ? static_cast<float>(1 - age / lifetime) : 0.0f;
}

void draw_flash(ImDrawList& list, const Eye& eye, glm::vec3 muzzle, float life) {
  const auto at = eye.at(muzzle);
  if (!at || life <= 0) return;
  const float radius = eye.pixels(muzzle, 0.075f);
  glow(list, *at, 1.7f * radius, kFire, 1.6f * life);
  glow(list, *at, 0.6f * radius, kHot, 2.5f * life);
}

void draw_tracer(ImDrawList& list, const Eye& eye, glm::vec3 from, glm::vec3 to, float life) {
  if (life <= 0) return;
  for (int i = 0; i < kTracerParts; ++i) {
    // Parts become longer with the distance, as perspective shortens them.
    const auto place = [&](int part) {
      const float t = static_cast<float>(part) / kTracerParts;
      return glm::mix(from, to, t * t);
    };
    const glm::vec3 a = place(i), b = place(i + 1);
    const auto begin = eye.at(a), end = eye.at(b);
    if (!begin || !end) continue;
    const float visible = eye.visibility(0.5f * (a + b)) * life;
    if (visible < 0.01f) continue;
    const float width = std::clamp(eye.pixels(a, 0.008f), 1.2f, 4.0f);
    list.AddLine(vec(*begin), vec(*end), colour_of(kFire, 0.45f * visible), 2.6f * width);
    list.AddLine(vec(*begin), vec(*end), colour_of(kHot, 0.95f * visible), width);
  }
}

void draw_impact(ImDrawList& list, const Eye& eye, glm::vec3 place, double event_time, double seconds) {
  const auto at = eye.at(place);
  const float mark = remaining(event_time, seconds, kMarkSeconds);
  if (!at || mark <= 0) return;
  const float visible = eye.visibility(place);
  if (visible < 0.01f) return;
  // Dark with a pale rim, to show on any wall.
  const float radius = std::max(eye.pixels(place, 0.035f), 2.0f);
  const float strength = visible * std::min(4 * mark, 1.0f);
  list.AddCircle(vec(*at), radius + 1, colour_of(kDust, 0.5f * strength), 0, 1.5f);
  list.AddCircleFilled(vec(*at), radius, colour_of(kScorch, 0.9f * strength));
  const float sparks = visible * remaining(event_time, seconds, kSparkSeconds);
  if (sparks <= 0) return;
  const float reach = eye.pixels(place, 0.35f * (1.2f - sparks));
  for (int i = 0; i < 9; ++i) {
    const float angle = 0.7f * static_cast<float>(i),
                length = reach * (0.55f + 0.15f * static_cast<float>(i % 4));
    const glm::vec2 direction(std::cos(angle), std::sin(angle));
    list.AddLine(vec(*at + 0.35f * length * direction), vec(*at + length * direction),
                 colour_of(kHot, sparks), 1.5f);
  }
  glow(list, *at, eye.pixels(place, 0.16f), kFire, sparks);
}

void draw_shot(ImDrawList& list, const Eye& eye, const Game& game, glm::vec3 from, glm::vec3 toward,
               double event_time) {
  const double seconds = game.session().seconds();
  const glm::vec3 direction = glm::normalize(toward - from);
  const scenario::Aim aimed = scenario::aim(game.grid(), from, direction, kRange);
  // The weapon is at the right of the eye, so that its own shot is no point.
  const glm::vec3 helper = std::abs(direction.y) > 0.99f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(direction, helper));
  const glm::vec3 muzzle = from + 0.55f * direction + 0.17f * right - 0.15f * glm::cross(right, direction);
  draw_tracer(list, eye, muzzle, aimed.at_world, remaining(event_time, seconds, kTracerSeconds));
  if (aimed.meets) draw_impact(list, eye, aimed.at_world, event_time, seconds);
  draw_flash(list, eye, muzzle, remaining(event_time, seconds, kFlashSeconds));
}

void draw_fireball(ImDrawList& list, const Eye& eye, glm::vec3 centre, float size, float life) {
  const auto at = life > 0 ? eye.at(centre) : std::nullopt;
  if (!at) return;
  const float visible = eye.visibility(centre);
  const float radius = eye.pixels(centre, (1.15f - 0.75f * life) * 0.3f * size);
  glow(list, *at, 1.5f * radius, kFire, 0.9f * visible * life);
  glow(list, *at, 0.8f * radius, kHot, 1.8f * visible * life * life);
}

/// Events with a path are shots, those with a place and a size explosions.
template <typename Event>
concept IsShot = requires(Event event) {
  event.toward_world;
};
template <typename Event>
concept IsExplosion = requires(Event event) {
  event.at_world;
  event.radius;
};

}  // namespace

void lay_out_shot_marks(const Game& game) {
  const Session& session = game.session();
  const scene::Timeline& timeline = session.live().scenario().timeline;
  const double seconds = session.seconds();
  std::optional<Eye> eye;
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  scene::for_each_event_list(timeline, [&]<typename Event>(const char*, const std::vector<Event>& events) {
    if constexpr (IsShot<Event> || IsExplosion<Event>) {
      for (const Event& event : events) {
        if (remaining(event.time, seconds, kMarkSeconds) <= 0) continue;
        if (!eye) eye.emplace(game);
        if constexpr (IsShot<Event>)
          draw_shot(list, *eye, game, event.from_world, event.toward_world, event.time);
        else
          draw_fireball(list, *eye, event.at_world, event.radius,
                        remaining(event.time, seconds, kFireballSeconds));
      }
    }
  });
}

}  // namespace brume::viewer
