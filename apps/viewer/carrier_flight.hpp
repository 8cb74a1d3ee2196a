// A carrier that the player steers, and the camera that follows it.
#pragma once

#include <vector>

#include "apps/viewer/window.hpp"
#include "scenario/scenario.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::viewer {

/// While it lasts, the carrier is where the player steers it, whatever its keys and the time.
class CarrierFlight {
 public:
  /// Begins where the carrier is at a time [s]. The camera goes behind it, along the direction of `camera`,
  /// as far as the size of what moves with the carrier requires.
  CarrierFlight(const scenario::Scenario& scenario, std::size_t carrier, double seconds,
                const scene::Camera& camera);

  /// Index into Timeline::carriers.
  std::size_t carrier() const { return carrier_; }
  /// Where it is; the time has no meaning.
  const scene::CarrierKey& pose() const { return pose_; }
  /// The camera before the flight.
  const scene::Camera& camera_before() const { return camera_before_; }

  /// Turns carrier and camera to the left and right by the mouse, and moves the carrier level along the
  /// camera's direction by the keys, at `speed` [m/s]. Up and down, the mouse lifts the camera alone. Nothing
  /// stops the carrier. Returns whether anything moved.
  bool steer(const Input& input, float speed, double seconds);
  /// Behind the carrier, or nearer where a wall is between them.
  scene::Camera camera(const voxel::BitGrid& grid) const;
  /// All carriers of a timeline, this one where the player has steered it at any time.
  std::vector<scene::Carrier> steered(std::vector<scene::Carrier> carriers) const;

 private:
  glm::vec3 direction_world() const;

  std::size_t carrier_;
  scene::CarrierKey pose_;
  scene::Camera camera_before_;
  float distance_ = 1;         ///< From the carrier to the camera [m].
  float yaw_ = 0, pitch_ = 0;  ///< View direction of the camera, as in Player [rad].
};

/// The size of all that moves with a carrier: the diagonal of a box around its objects, or else around its
/// volumes and decals [m]. Without any: 1.
float size_of_carried(const scenario::Scenario& scenario, const scene::Carrier& carrier);

}  // namespace brume::viewer
