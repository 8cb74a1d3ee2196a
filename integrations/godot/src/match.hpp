// A match of one level: its world, and its field for lines of sight.
#pragma once

#include <brume/brume.hpp>

#include <memory>
#include <optional>

#include "godot.hpp"
#include "smoke_textures.hpp"

namespace brume::godot {

/// What a BrumeMatch of GDScript holds. Before a level is set, everything else throws std::logic_error.
class Match {
 public:
  /// An image for shoot_mask, for levels that are set later: rows from the top, 255 removes all smoke.
  /// Returns its number.
  std::int64_t add_mask(std::uint32_t width, std::uint32_t height, std::vector<std::uint8_t> texels);
  void level_from_boxes(const std::vector<Box>& boxes, double voxel_size);
  /// `roles`: a brume_role for each triangle; empty: all are walls.
  void level_from_triangles(const std::vector<brume_point>& points, const std::vector<std::int32_t>& indices,
                            const std::vector<std::uint8_t>& roles, double voxel_size);

  /// The low corner of the voxels [m], their number along each axis, and their size [m].
  std::vector<float> layout();

  // Events of the next tick.
  void throw_smoke(brume_point from, brume_point at, double cubic_metres);
  void shoot(brume_point origin, brume_point toward, double radius);
  /// A hole with the shape of an image, upright for the shooter.
  void shoot_mask(brume_point origin, brume_point toward, double half_size, std::uint32_t mask,
                  double stay_open_seconds);
  void blast(brume_point at, double radius);
  void move(std::uint32_t body, brume_point to);
  /// The voxels whose middle is in the box become walls, or free.
  void edit(const Box& box, bool solid);
  /// An event as the header has it: the members of its struct in their order.
  void append(std::uint32_t kind, std::uint32_t tick, const std::vector<std::int32_t>& members);

  void step() { world().step(); }
  void advance_to(std::uint32_t tick) { world().advance_to(tick); }
  void forget_before(std::uint32_t tick) { world().forget_before(tick); }
  std::uint32_t tick() { return world().tick(); }
  std::uint64_t hash() { return world().hash(); }

  /// The optical depth between each pair of points.
  std::vector<float> depths(const std::vector<brume_point>& ends);
  /// The same through the smoke as it is drawn.
  std::vector<float> drawn_depths(const std::vector<brume_point>& ends);
  bool sees(brume_point a, brume_point b, double threshold);

  /// Textures of the field from now on, with light for so many lights.
  void make_textures(std::uint32_t light_count, bool sky);
  /// `suns`: 1 for each light that is a sun, whose point is the direction towards it.
  void update_textures(double seconds, const std::vector<brume_point>& lights,
                       const std::vector<std::uint8_t>& suns, double light_fraction);
  /// Throws std::logic_error before make_textures.
  SmokeTextures& textures();

 private:
  struct Running {
    Running(api::Level made, const api::Masks& masks);
    api::Level level;
    api::World world;
    api::Field field;
    std::optional<std::uint64_t> in_field;  ///< The hash of the state that the field has taken over.
    std::optional<SmokeTextures> textures;
  };

  static std::vector<brume_segment> lines_of(const std::vector<brume_point>& ends);
  Running& running();
  api::World& world() { return running().world; }
  /// The field with the present state.
  api::Field& field();
  brume_event next_event(brume_event_kind kind);

  struct Mask {
    std::uint32_t width, height;
    std::vector<std::uint8_t> texels;
  };
  api::Masks masks() const;

  api::Context context_;
  std::vector<Mask> masks_;
  std::unique_ptr<Running> running_;
};

}  // namespace brume::godot
