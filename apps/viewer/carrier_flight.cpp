#include "apps/viewer/carrier_flight.hpp"

#include <algorithm>
#include <cmath>

#include "apps/viewer/player.hpp"
#include "scenario/aim.hpp"

namespace brume::viewer {
namespace {

constexpr float kSizesBehind = 2;  // distance of the camera in sizes of what is carried
constexpr float kNearestCamera = 0.3f, kFarthestCamera = 200;  // [m]
constexpr float kFirstPitch = -0.3f;  // [rad]: from above, if the player looked level or up
constexpr float kLowestPitch = -1.5f, kHighestPitch = 1.2f;

}  // namespace

float size_of_carried(const scenario::Scenario& scenario, const scene::Carrier& carrier) {
  Box<float> box = kEmptyBox;
  for (const scene::Object& object : scenario.scene.objects) {
    if (carrier.object.empty() || object.name != carrier.object) continue;
    for (const scene::Vertex& vertex : scenario.scene.meshes[object.mesh].vertices) {
      const glm::vec3 place(object.world_from_mesh * glm::vec4(vertex.position, 1));
      box = united(box, {place, place});
    }
  }
  const scene::Timeline& timeline = scenario.timeline;
  for (std::size_t i = 0; i < timeline.volumes.size() && box.empty(); ++i)
    if (timeline.volumes[i].carrier == carrier.name)
      box = volumes::transformed(volumes::world_from_file(timeline.volumes[i]),
                                 scenario.volumes->typical_frame(i).bounds);
  for (std::size_t i = 0; i < timeline.decals.size() && box.empty(); ++i)
    if (timeline.decals[i].carrier == carrier.name) {
      const scenario::SliceVolume& slices = scenario.slices.of_decals[i];
      const Box<double>& grid = (*scenario.slices.volumes)[slices.volume]->front().box;
      box = volumes::transformed(scenario::world_from_file({}, timeline.decals[i], 0) * slices.file_from_box,
                                 {glm::vec3(grid.low), glm::vec3(grid.high)});
    }
  return box.empty() ? 1 : glm::length(box.high - box.low);
}

CarrierFlight::CarrierFlight(const scenario::Scenario& scenario, std::size_t carrier, double seconds,
                             const scene::Camera& camera)
    : carrier_(carrier),
      pose_(scene::key_at(scenario.timeline.carriers[carrier], seconds)),
      camera_before_(camera),
      distance_(std::clamp(kSizesBehind * size_of_carried(scenario, scenario.timeline.carriers[carrier]),
                           kNearestCamera, kFarthestCamera)) {
  const glm::vec3 direction = glm::normalize(camera.target_world - camera.position_world);
  yaw_ = std::atan2(direction.x, -direction.z);
  pitch_ = std::clamp(std::asin(std::clamp(direction.y, -1.0f, 1.0f)), kLowestPitch, kFirstPitch);
}

glm::vec3 CarrierFlight::direction_world() const {
  return {std::cos(pitch_) * std::sin(yaw_), std::sin(pitch_), -std::cos(pitch_) * std::cos(yaw_)};
}

bool CarrierFlight::steer(const Input& input, float speed, double seconds) {
  const glm::vec2 turn = Player::kRadiansPerPixel * glm::vec2(input.look_px);
  yaw_ += turn.x;
  pitch_ = std::clamp(pitch_ - turn.y, kLowestPitch, kHighestPitch);
  // To the right is a negative rotation about y, which points up.
  pose_.rotation.y -= glm::degrees(turn.x);

  const auto axis = [&](Action positive, Action negative) {
    return (input.is_held(positive) ? 1.0f : 0.0f) - (input.is_held(negative) ? 1.0f : 0.0f);
  };
  const glm::vec3 ahead(std::sin(yaw_), 0, -std::cos(yaw_)), right(std::cos(yaw_), 0, std::sin(yaw_));
  glm::vec3 direction =
      axis(Action::forward, Action::back) * ahead + axis(Action::right, Action::left) * right;
  direction.y = axis(Action::up, Action::down);
  const float length = glm::length(direction);
  if (length > 1) direction /= length;
  pose_.position_world += speed * static_cast<float>(seconds) * direction;
  return length > 0 || turn != glm::vec2(0);
}

scene::Camera CarrierFlight::camera(const voxel::BitGrid& grid) const {
  const glm::vec3 direction = direction_world();
  float distance = distance_;
  // What is solid at the carrier itself, a pad that it stands on, hides it less than no distance would.
  if (const auto wall = scenario::aim(grid, pose_.position_world, -direction, distance_).meets)
    distance = std::max(*wall - 0.5f * grid.layout().voxel_size, 0.5f * distance_);
  scene::Camera camera;
  camera.position_world = pose_.position_world - distance * direction;
  camera.target_world = pose_.position_world;
  return camera;
}

std::vector<scene::Carrier> CarrierFlight::steered(std::vector<scene::Carrier> carriers) const {
  carriers[carrier_].keys = {{0, pose_.position_world, pose_.rotation}};
  return carriers;
}

}  // namespace brume::viewer
