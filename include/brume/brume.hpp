// The C interface (brume.h) for C++17: handles that release themselves, vectors instead of pointers,
// exceptions instead of results. Header only; units, ranges, errors and thread rules are as in the C
// functions that it calls.
//
//   brume::api::Context context;
//   brume::api::Level level(context, params);
//   brume::api::World world(level);
//
// Errors     Every function throws brume::api::Error where brume.h returns an error.
// Objects    Objects can be moved, not copied. An object that was moved from may only be destroyed or
// assigned to. C          get() returns the handle, for functions of brume.h.
#ifndef BRUME_BRUME_HPP
#define BRUME_BRUME_HPP

#include <brume/brume.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace brume::api {

/// A failed call: result() returns its result, what() the line of brume_last_error().
class Error : public std::runtime_error {
 public:
  /// Takes the line of the calling thread's last failure.
  explicit Error(brume_result result) : std::runtime_error(brume_last_error()), result_(result) {}
  /// The result of the call.
  brume_result result() const noexcept { return result_; }

 private:
  brume_result result_;
};

inline void check(brume_result result) {
  if (result != BRUME_OK) throw Error(result);
}

using Bytes = std::vector<std::uint8_t>;

namespace detail {

template <typename T, brume_result (*destroy)(T*) BRUME_NOEXCEPT>
class Handle {
 public:
  explicit Handle(T* handle) : handle_(handle) {}
  T* get() const noexcept { return handle_.get(); }

 private:
  struct Destroy {
    void operator()(T* handle) const noexcept { destroy(handle); }
  };
  std::unique_ptr<T, Destroy> handle_;
};

/// The handle that create(&handle) makes.
template <typename T, typename Create>
T* created(Create create) {
  T* handle = nullptr;
  check(create(&handle));
  return handle;
}

/// The value that read(&value) writes.
template <typename T, typename Read>
T value_of(Read read) {
  T value{};
  check(read(&value));
  return value;
}

/// The bytes that write(buffer, capacity, &size) writes.
template <typename Write>
Bytes bytes_of(Write write) {
  std::size_t size = 0;
  check(write(nullptr, std::size_t{0}, &size));
  Bytes bytes(size);
  if (size > 0) check(write(bytes.data(), bytes.size(), &size));
  return bytes;
}

/// The elements that write(elements, capacity, &count) writes.
template <typename T, typename Write>
std::vector<T> list_of(Write write) {
  std::size_t count = 0;
  check(write(nullptr, std::size_t{0}, &count));
  std::vector<T> list(count);
  if (count > 0) check(write(list.data(), list.size(), &count));
  return list;
}

/// The number of voxels of a box; 0 for none, which the functions reject.
inline std::size_t voxels_of(const brume_voxel& low, const brume_voxel& high) {
  if (low.x >= high.x || low.y >= high.y || low.z >= high.z) return 0;
  const auto extent = [](std::int32_t from, std::int32_t to) {
    return static_cast<std::size_t>(std::int64_t{to} - std::int64_t{from});
  };
  const std::array<std::size_t, 3> size{extent(low.x, high.x), extent(low.y, high.y), extent(low.z, high.z)};
  for (const std::size_t axis : size)
    if (axis > BRUME_MAX_LEVEL_AXIS) return 0;
  return size[0] * size[1] * size[2];
}

}  // namespace detail

/// The nearest position to a point [m].
inline brume_position position(double x, double y, double z) {
  return detail::value_of<brume_position>(
      [&](brume_position* out) { return brume_position_from_metres(x, y, z, out); });
}

/// A brume_context.
class Context : public detail::Handle<brume_context, brume_context_destroy> {
 public:
  /// brume_context_create.
  explicit Context(const brume_context_params& params = brume_context_defaults())
      : Handle(detail::created<brume_context>(
            [&](brume_context** out) { return brume_context_create(&params, out); })) {}
};

/// A brume_level.
class Level : public detail::Handle<brume_level, brume_level_destroy> {
 public:
  /// brume_level_create_from_voxels.
  Level(const Context& context, const brume_voxels_params& params)
      : Handle(detail::created<brume_level>([&](brume_level** out) {
          return brume_level_create_from_voxels(context.get(), &params, out);
        })) {}
  /// brume_level_create_from_triangles.
  Level(const Context& context, const brume_triangles_params& params)
      : Handle(detail::created<brume_level>([&](brume_level** out) {
          return brume_level_create_from_triangles(context.get(), &params, out);
        })) {}

  /// brume_level_layout.
  brume_layout layout() const {
    return detail::value_of<brume_layout>([&](brume_layout* out) { return brume_level_layout(get(), out); });
  }
  /// Levels of one hash give the same smoke and lines of sight: brume_level_hash.
  std::uint64_t hash() const {
    return detail::value_of<std::uint64_t>([&](std::uint64_t* out) { return brume_level_hash(get(), out); });
  }
  /// 1 for each solid voxel of the box, else 0.
  Bytes solid(brume_voxel low, brume_voxel high) const {
    Bytes out(detail::voxels_of(low, high));
    check(brume_level_solid(get(), low, high, out.data(), out.size()));
    return out;
  }
  /// The brume_role of each voxel of the box.
  Bytes roles(brume_voxel low, brume_voxel high) const {
    Bytes out(detail::voxels_of(low, high));
    check(brume_level_roles(get(), low, high, out.data(), out.size()));
    return out;
  }
};

/// A brume_masks.
class Masks : public detail::Handle<brume_masks, brume_masks_destroy> {
 public:
  /// brume_masks_create.
  Masks(const Context& context, const std::vector<brume_mask_image>& images)
      : Handle(detail::created<brume_masks>([&](brume_masks** out) {
          return brume_masks_create(context.get(), images.data(), images.size(), out);
        })) {}
};

/// A brume_state: an immutable snapshot.
class State : public detail::Handle<brume_state, brume_state_destroy> {
 public:
  /// Takes over a handle.
  explicit State(brume_state* handle) : Handle(handle) {}
  /// Loads the bytes of save().
  State(const Context& context, const Bytes& bytes)
      : Handle(detail::created<brume_state>([&](brume_state** out) {
          return brume_state_load(context.get(), bytes.data(), bytes.size(), out);
        })) {}

  /// Counts and times.
  brume_state_info describe() const {
    return detail::value_of<brume_state_info>(
        [&](brume_state_info* out) { return brume_state_describe(get(), out); });
  }
  /// As World::hash.
  std::uint64_t hash() const {
    return detail::value_of<std::uint64_t>([&](std::uint64_t* out) { return brume_state_hash(get(), out); });
  }
  /// The part that reaches one of the boxes: brume_state_filter.
  State filtered(const std::vector<brume_box>& boxes) const {
    return State(detail::created<brume_state>(
        [&](brume_state** out) { return brume_state_filter(get(), boxes.data(), boxes.size(), out); }));
  }
  /// The state as bytes, for the constructor.
  Bytes save() const {
    return detail::bytes_of([&](void* buffer, std::size_t capacity, std::size_t* size) {
      return brume_state_save(get(), buffer, capacity, size);
    });
  }
  /// The grenades in the air.
  std::vector<brume_grenade> grenades() const {
    return detail::list_of<brume_grenade>([&](brume_grenade* list, std::size_t capacity, std::size_t* count) {
      return brume_state_grenades(get(), list, capacity, count);
    });
  }
  /// The clouds of smoke.
  std::vector<brume_cloud> clouds() const {
    return detail::list_of<brume_cloud>([&](brume_cloud* list, std::size_t capacity, std::size_t* count) {
      return brume_state_clouds(get(), list, capacity, count);
    });
  }
  /// The cavities of explosions.
  std::vector<brume_blast> blasts() const {
    return detail::list_of<brume_blast>([&](brume_blast* list, std::size_t capacity, std::size_t* count) {
      return brume_state_blasts(get(), list, capacity, count);
    });
  }
  /// The holes of shots.
  std::vector<brume_hole> holes() const {
    return detail::list_of<brume_hole>([&](brume_hole* list, std::size_t capacity, std::size_t* count) {
      return brume_state_holes(get(), list, capacity, count);
    });
  }
  /// All bodies.
  std::vector<brume_body> bodies() const {
    return detail::list_of<brume_body>([&](brume_body* list, std::size_t capacity, std::size_t* count) {
      return brume_state_bodies(get(), list, capacity, count);
    });
  }
};

/// A brume_world.
class World : public detail::Handle<brume_world, brume_world_destroy> {
 public:
  /// brume_world_create.
  explicit World(const Level& level, const brume_world_params& params = brume_world_defaults())
      : Handle(detail::created<brume_world>(
            [&](brume_world** out) { return brume_world_create(level.get(), &params, out); })) {}

  /// Adds an event, late or not: brume_world_append.
  void append(const brume_event& event) { check(brume_world_append(get(), &event, 1)); }
  /// Adds events at once, which rolls back once.
  void append(const std::vector<brume_event>& events) {
    check(brume_world_append(get(), events.data(), events.size()));
  }
  /// Replaces all events from a tick on.
  void replace_from(std::uint32_t tick, const std::vector<brume_event>& events) {
    check(brume_world_replace_from(get(), tick, events.data(), events.size()));
  }
  /// Moves to a tick, forwards or backwards.
  void advance_to(std::uint32_t tick) { check(brume_world_advance_to(get(), tick)); }
  /// Moves to the next tick.
  void step() { check(brume_world_step(get())); }
  /// Drops the history before a tick, and refuses events before it from now on.
  void forget_before(std::uint32_t tick) { check(brume_world_forget_before(get(), tick)); }
  /// Adopts a state.
  void restore(const State& state) { check(brume_world_restore(get(), state.get())); }

  /// The present tick.
  std::uint32_t tick() const {
    return detail::value_of<std::uint32_t>([&](std::uint32_t* out) { return brume_world_tick(get(), out); });
  }
  /// The earliest tick to which it can roll back.
  std::uint32_t earliest_tick() const {
    return detail::value_of<std::uint32_t>(
        [&](std::uint32_t* out) { return brume_world_earliest_tick(get(), out); });
  }
  /// Equal states have equal hashes on every machine.
  std::uint64_t hash() const {
    return detail::value_of<std::uint64_t>([&](std::uint64_t* out) { return brume_world_hash(get(), out); });
  }
  /// A snapshot of the present state.
  State state() const {
    return State(
        detail::created<brume_state>([&](brume_state** out) { return brume_world_state(get(), out); }));
  }
};

/// A brume_sender.
class Sender : public detail::Handle<brume_sender, brume_sender_destroy> {
 public:
  /// brume_sender_create.
  explicit Sender(const Context& context, const brume_sender_params& params = brume_sender_defaults())
      : Handle(detail::created<brume_sender>(
            [&](brume_sender** out) { return brume_sender_create(context.get(), &params, out); })) {}

  /// The packet of the state, for every receiver.
  Bytes push(const State& state) {
    check(brume_sender_push(get(), state.get()));
    return packet();
  }
  /// The packet of the last state pushed.
  Bytes packet() const {
    return detail::bytes_of([&](void* buffer, std::size_t capacity, std::size_t* size) {
      return brume_sender_packet(get(), buffer, capacity, size);
    });
  }
  /// The answer to a receiver's request; empty when it is up to date.
  Bytes answer(const Bytes& request) {
    return detail::bytes_of([&](void* buffer, std::size_t capacity, std::size_t* size) {
      return brume_sender_answer(get(), request.data(), request.size(), buffer, capacity, size);
    });
  }
};

/// A brume_receiver.
class Receiver : public detail::Handle<brume_receiver, brume_receiver_destroy> {
 public:
  /// brume_receiver_create.
  explicit Receiver(const Context& context, const brume_receiver_params& params = brume_receiver_defaults())
      : Handle(detail::created<brume_receiver>(
            [&](brume_receiver** out) { return brume_receiver_create(context.get(), &params, out); })) {}

  /// Processes a packet or answer, in any order.
  brume_reception receive(const Bytes& packet) {
    std::uint32_t reception = 0;
    check(brume_receiver_receive(get(), packet.data(), packet.size(), &reception));
    return static_cast<brume_reception>(reception);
  }
  /// Whether a state is known to be missing: send a request.
  bool behind() const {
    return detail::value_of<std::uint32_t>(
               [&](std::uint32_t* out) { return brume_receiver_behind(get(), out); }) != 0;
  }
  /// A request for the sender.
  Bytes request() const {
    return detail::bytes_of([&](void* buffer, std::size_t capacity, std::size_t* size) {
      return brume_receiver_request(get(), buffer, capacity, size);
    });
  }
  /// The newest state.
  State state() const {
    return State(
        detail::created<brume_state>([&](brume_state** out) { return brume_receiver_state(get(), out); }));
  }
  /// Drops all states: a new match starts.
  void reset() { check(brume_receiver_reset(get())); }
};

/// A brume_field.
class Field : public detail::Handle<brume_field, brume_field_destroy> {
 public:
  /// brume_field_create.
  explicit Field(const Level& level, const brume_field_params& params = brume_field_defaults())
      : Handle(detail::created<brume_field>(
            [&](brume_field** out) { return brume_field_create(level.get(), &params, out); })) {}

  /// Takes over a state: brume_field_update.
  void update(const State& state) { check(brume_field_update(get(), state.get())); }

  /// The bricks of 8^3 voxels that the last update changed.
  std::vector<brume_voxel> changed_bricks() const {
    return detail::list_of<brume_voxel>([&](brume_voxel* list, std::size_t capacity, std::size_t* count) {
      return brume_field_changed_bricks(get(), list, capacity, count);
    });
  }

  /// The optical depth of a segment: exp(-depth) of the light passes.
  float optical_depth(const brume_segment& segment) const {
    return detail::value_of<float>(
        [&](float* out) { return brume_field_optical_depths(get(), &segment, 1, out); });
  }
  /// The optical depth of each segment.
  std::vector<float> optical_depths(const std::vector<brume_segment>& segments) const {
    std::vector<float> out(segments.size());
    check(brume_field_optical_depths(get(), segments.data(), segments.size(), out.data()));
    return out;
  }
  /// Whether no wall lies between, and the optical depth is at most `threshold`.
  bool visible(const brume_segment& segment, float threshold) const {
    return detail::value_of<std::uint8_t>([&](std::uint8_t* out) {
             return brume_field_visible(get(), &segment, 1, threshold, out);
           }) != 0;
  }
  /// 1 for each visible segment, else 0.
  Bytes visible(const std::vector<brume_segment>& segments, float threshold) const {
    Bytes out(segments.size());
    check(brume_field_visible(get(), segments.data(), segments.size(), threshold, out.data()));
    return out;
  }
  /// brume_field_drawn_depths: the optical depth of each segment.
  std::vector<float> drawn_depths(const std::vector<brume_segment>& segments,
                                  const brume_drawn_params& params = brume_drawn_defaults()) const {
    std::vector<float> out(segments.size());
    check(brume_field_drawn_depths(get(), &params, segments.data(), segments.size(), out.data()));
    return out;
  }
  /// brume_field_drawn_visible: 1 for each visible segment, else 0.
  Bytes drawn_visible(const std::vector<brume_segment>& segments, float threshold,
                      const brume_drawn_params& params = brume_drawn_defaults()) const {
    Bytes out(segments.size());
    check(brume_field_drawn_visible(get(), &params, segments.data(), segments.size(), threshold, out.data()));
    return out;
  }
  /// The first voxel of a wall along a segment.
  std::optional<brume_wall> first_wall(const brume_segment& segment) const {
    const auto wall = detail::value_of<brume_wall>(
        [&](brume_wall* out) { return brume_field_first_walls(get(), &segment, 1, out); });
    return wall.hit != 0 ? std::optional<brume_wall>(wall) : std::nullopt;
  }
  /// The first wall of each segment; see brume_wall::hit.
  std::vector<brume_wall> first_walls(const std::vector<brume_segment>& segments) const {
    std::vector<brume_wall> out(segments.size());
    check(brume_field_first_walls(get(), segments.data(), segments.size(), out.data()));
    return out;
  }
  /// The densities of a box of voxels, [0, 255].
  Bytes densities(brume_voxel low, brume_voxel high) const {
    Bytes out(detail::voxels_of(low, high));
    check(brume_field_densities(get(), low, high, out.data(), out.size()));
    return out;
  }
};

}  // namespace brume::api

#endif  // BRUME_BRUME_HPP
