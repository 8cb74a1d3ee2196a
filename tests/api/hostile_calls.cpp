#include "tests/api/hostile_calls.hpp"

#include <algorithm>

namespace brume::api {

const std::vector<Hostile::Step>& Hostile::steps() {
  using H = Hostile;
  static const std::vector<Step> all{&H::general,
                                     &H::context_create,
                                     &H::context_destroy,
                                     &H::level_from_voxels,
                                     &H::level_from_triangles,
                                     &H::level_destroy,
                                     &H::level_read,
                                     &H::masks_create,
                                     &H::masks_destroy,
                                     &H::world_create,
                                     &H::world_destroy,
                                     &H::world_append,
                                     &H::world_append,
                                     &H::world_append,
                                     &H::world_replace,
                                     &H::world_move,
                                     &H::world_move,
                                     &H::world_move,
                                     &H::world_read,
                                     &H::world_state,
                                     &H::world_state,
                                     &H::world_restore,
                                     &H::state_read,
                                     &H::state_save,
                                     &H::state_filter,
                                     &H::state_load,
                                     &H::state_destroy,
                                     &H::sender_create,
                                     &H::sender_push,
                                     &H::sender_push,
                                     &H::sender_packets,
                                     &H::sender_packets,
                                     &H::sender_destroy,
                                     &H::receiver_create,
                                     &H::receiver_receive,
                                     &H::receiver_receive,
                                     &H::receiver_read,
                                     &H::receiver_destroy,
                                     &H::field_create,
                                     &H::field_update,
                                     &H::field_update,
                                     &H::field_query,
                                     &H::field_query,
                                     &H::field_query,
                                     &H::field_destroy,
                                     &H::textures_create,
                                     &H::textures_update,
                                     &H::textures_read,
                                     &H::textures_destroy,
                                     &H::defaults};
  return all;
}

void Hostile::general() {
  auto at = output<brume_position>();
  const double x = real(100), y = real(20000), z = real(100);
  checked("brume_position_from_metres", brume_position_from_metres(x, y, z, at.pointer()), at.untouched());
  auto major = output<std::uint32_t>(), minor = output<std::uint32_t>();
  checked("brume_version", brume_version(major.pointer(), minor.pointer(), nullptr), true);
  EXPECT_NE(brume_result_name(static_cast<brume_result>(number(15))), nullptr);
}

void Hostile::context_create() {
  if (!contexts_.empty() && !chance(0.15)) return;
  brume_context_params params = brume_context_defaults();
  params.thread_count = chance(0.9) ? 1 : number(3);
  params.log = [](void* user, brume_result, const char*) { ++*static_cast<std::uint64_t*>(user); };
  params.log_user = &logged_;
  auto out = output<brume_context*>();
  keep("brume_context_create", brume_context_create(spoiled(params), out.pointer()), out, contexts_,
       brume_context_destroy);
}

void Hostile::context_destroy() {
  end("brume_context_destroy", contexts_, brume_context_destroy);
}

void Hostile::level_from_voxels() {
  if (!levels_.empty() && !chance(0.15)) return;
  brume_voxels_params params = brume_voxels_defaults();
  params.layout = layout();
  const brume_voxel& size = params.layout.size;
  const std::uint64_t voxels = std::uint64_t{static_cast<std::uint32_t>(size.x)} *
                               static_cast<std::uint32_t>(size.y) * static_cast<std::uint32_t>(size.z);
  params.byte_count = std::min<std::uint64_t>((voxels + 7) / 8, bits_.size());
  if (chance(0.03)) params.byte_count = count(10);
  params.bits = chance(0.03) ? nullptr : bits_.data();
  params.glass_bits = chance(0.5) ? nullptr : bits_.data();
  params.grille_bits = chance(0.5) ? nullptr : bits_.data();
  auto out = output<brume_level*>();
  keep("brume_level_create_from_voxels",
       brume_level_create_from_voxels(handle(contexts_), spoiled(params), out.pointer()), out, levels_,
       brume_level_destroy);
}

void Hostile::level_from_triangles() {
  if (!levels_.empty() && !chance(0.15)) return;
  std::vector<brume_point> points(1 + below(12));
  for (brume_point& p : points) p = point(14);
  std::vector<std::uint32_t> indices(3 * below(6));
  const auto point_count = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t& i : indices) i = chance(0.01) ? number(30) : below(point_count);
  brume_triangles_params params = brume_triangles_defaults();
  params.layout = layout();
  if (chance(0.2)) params.layout.size = {0, 0, 0};
  params.margin = number(4);
  params.points = chance(0.02) ? nullptr : points.data();
  // Too many points or indices would be read, unless they are more than there may be.
  params.point_count = std::min(count(points.size()), chance(0.03) ? ~std::size_t{0} : points.size());
  params.indices = chance(0.02) ? nullptr : indices.data();
  params.index_count = chance(0.02) ? ~std::size_t{0} : indices.size() - below(indices.empty() ? 1 : 2);
  if (params.point_count > points.size()) params.index_count = ~std::size_t{0} - 2;
  std::vector<std::uint8_t> roles(indices.size() / 3);
  for (std::uint8_t& role : roles) role = static_cast<std::uint8_t>(chance(0.01) ? below(256) : below(4));
  params.roles = chance(0.3) ? nullptr : roles.data();
  auto out = output<brume_level*>();
  keep("brume_level_create_from_triangles",
       brume_level_create_from_triangles(handle(contexts_), spoiled(params), out.pointer()), out, levels_,
       brume_level_destroy);
}

void Hostile::level_destroy() {
  end("brume_level_destroy", levels_, brume_level_destroy);
}

void Hostile::level_read() {
  read<brume_layout>("brume_level_layout", levels_, brume_level_layout);
  read<std::uint64_t>("brume_level_hash", levels_, brume_level_hash);
  read_box("brume_level_solid",
           [&](brume_voxel low, brume_voxel high, std::uint8_t* out, std::size_t voxels) {
             return brume_level_solid(handle(levels_), low, high, out, voxels);
           });
  read_box("brume_level_roles",
           [&](brume_voxel low, brume_voxel high, std::uint8_t* out, std::size_t voxels) {
             return brume_level_roles(handle(levels_), low, high, out, voxels);
           });
}

void Hostile::masks_create() {
  if (!masks_.empty() && !chance(0.15)) return;
  std::vector<brume_mask_image> images(below(3));
  for (brume_mask_image& image : images) image = {1 + below(20), 1 + below(20), bits_.data()};
  if (!images.empty() && chance(0.05)) images[0].width = chance(0.5) ? 0 : 4095;
  if (!images.empty() && chance(0.03)) images[0].texels = nullptr;
  auto out = output<brume_masks*>();
  keep("brume_masks_create",
       brume_masks_create(handle(contexts_), chance(0.03) ? nullptr : images.data(), count(images.size()),
                          out.pointer()),
       out, masks_, brume_masks_destroy);
}

void Hostile::masks_destroy() {
  end("brume_masks_destroy", masks_, brume_masks_destroy);
}

void Hostile::world_create() {
  if (!worlds_.empty() && !chance(0.15)) return;
  brume_world_params params = brume_world_defaults();
  if (chance(0.05)) params.ticks_per_second = number(1500);
  params.masks = chance(0.5) ? nullptr : handle(masks_);
  auto out = output<brume_world*>();
  keep("brume_world_create", brume_world_create(handle(levels_), spoiled(params), out.pointer()), out,
       worlds_, brume_world_destroy);
}

void Hostile::world_destroy() {
  end("brume_world_destroy", worlds_, brume_world_destroy);
}

void Hostile::world_append() {
  std::vector<brume_event> events(below(3) + 1);
  for (brume_event& one : events) one = event();
  const brume_event* first = chance(0.02) ? nullptr : events.data();
  checked("brume_world_append", brume_world_append(handle(worlds_), first, count(events.size())), true);
}

void Hostile::world_replace() {
  std::vector<brume_event> events(below(3));
  std::uint32_t first = number(400);
  for (brume_event& one : events) {
    one = event();
    if (!chance(0.1)) first = std::min(first, one.tick);
  }
  checked("brume_world_replace_from",
          brume_world_replace_from(handle(worlds_), first, events.data(), count(events.size())), true);
}

void Hostile::world_move() {
  if (chance(0.5)) return void(checked("brume_world_step", brume_world_step(handle(worlds_)), true));
  checked("brume_world_advance_to", brume_world_advance_to(handle(worlds_), number(500)), true);
  if (chance(0.2))
    checked("brume_world_forget_before", brume_world_forget_before(handle(worlds_), number(300)), true);
}

void Hostile::world_read() {
  read<std::uint32_t>("brume_world_tick", worlds_, brume_world_tick);
  read<std::uint32_t>("brume_world_earliest_tick", worlds_, brume_world_earliest_tick);
  read<std::uint64_t>("brume_world_hash", worlds_, brume_world_hash);
}

void Hostile::world_state() {
  auto out = output<brume_state*>();
  keep("brume_world_state", brume_world_state(handle(worlds_), out.pointer()), out, states_,
       brume_state_destroy);
}

void Hostile::world_restore() {
  if (chance(0.5))
    checked("brume_world_restore", brume_world_restore(handle(worlds_), handle(states_)), true);
}

void Hostile::state_read() {
  read<brume_state_info>("brume_state_describe", states_, brume_state_describe);
  read<std::uint64_t>("brume_state_hash", states_, brume_state_hash);
  read_list("brume_state_grenades", states_, brume_state_grenades);
  read_list("brume_state_clouds", states_, brume_state_clouds);
  read_list("brume_state_blasts", states_, brume_state_blasts);
  read_list("brume_state_holes", states_, brume_state_holes);
  read_list("brume_state_bodies", states_, brume_state_bodies);
}

void Hostile::state_filter() {
  std::vector<brume_box> boxes(below(3));
  for (brume_box& box : boxes) {
    box.low = point(20);
    box.high = chance(0.9) ? brume_point{box.low.x + 5, box.low.y + 3, box.low.z} : point(20);
  }
  auto out = output<brume_state*>();
  keep("brume_state_filter",
       brume_state_filter(handle(states_), chance(0.03) ? nullptr : boxes.data(), count(boxes.size()),
                          out.pointer()),
       out, states_, brume_state_destroy);
}

void Hostile::state_save() {
  read_bytes("brume_state_save", [&](void* buffer, std::size_t capacity, std::size_t* size) {
    return brume_state_save(handle(states_), buffer, capacity, size);
  });
}

void Hostile::state_load() {
  const auto bytes = packet();
  auto out = output<brume_state*>();
  keep("brume_state_load",
       brume_state_load(handle(contexts_), bytes.empty() ? nullptr : bytes.data(), bytes.size(),
                        out.pointer()),
       out, states_, brume_state_destroy);
}

void Hostile::state_destroy() {
  end("brume_state_destroy", states_, brume_state_destroy);
}

void Hostile::sender_create() {
  if (!senders_.empty() && !chance(0.15)) return;
  brume_sender_params params = brume_sender_defaults();
  params.history = number(9);
  auto out = output<brume_sender*>();
  keep("brume_sender_create", brume_sender_create(handle(contexts_), spoiled(params), out.pointer()), out,
       senders_, brume_sender_destroy);
}

void Hostile::sender_push() {
  checked("brume_sender_push", brume_sender_push(handle(senders_), handle(states_)), true);
}

void Hostile::sender_packets() {
  read_bytes("brume_sender_packet", [&](void* buffer, std::size_t capacity, std::size_t* size) {
    return brume_sender_packet(handle(senders_), buffer, capacity, size);
  });
  const auto request = packet();
  read_bytes("brume_sender_answer", [&](void* buffer, std::size_t capacity, std::size_t* size) {
    const void* bytes = chance(0.02) ? nullptr : request.data();
    return brume_sender_answer(handle(senders_), bytes, request.size(), buffer, capacity, size);
  });
}

void Hostile::sender_destroy() {
  end("brume_sender_destroy", senders_, brume_sender_destroy);
}

void Hostile::receiver_create() {
  if (!receivers_.empty() && !chance(0.15)) return;
  brume_receiver_params params = brume_receiver_defaults();
  if (chance(0.1)) params.max_bytes = number(1000);
  if (chance(0.1)) params.max_voxels = number(1000);
  if (chance(0.1)) params.max_items = number(10);
  if (chance(0.5)) params.level = handle(levels_);
  if (chance(0.5)) params.hold_ticks = number(66);
  auto out = output<brume_receiver*>();
  keep("brume_receiver_create", brume_receiver_create(handle(contexts_), spoiled(params), out.pointer()), out,
       receivers_, brume_receiver_destroy);
}

void Hostile::receiver_receive() {
  const auto bytes = packet();
  auto reception = output<std::uint32_t>();
  const brume_result result = brume_receiver_receive(
      handle(receivers_), chance(0.02) ? nullptr : bytes.data(), bytes.size(), reception.pointer());
  checked("brume_receiver_receive", result, reception.untouched());
}

void Hostile::receiver_read() {
  read<std::uint32_t>("brume_receiver_behind", receivers_, brume_receiver_behind);
  read_bytes("brume_receiver_request", [&](void* buffer, std::size_t capacity, std::size_t* size) {
    return brume_receiver_request(handle(receivers_), buffer, capacity, size);
  });
  auto out = output<brume_state*>();
  keep("brume_receiver_state", brume_receiver_state(handle(receivers_), out.pointer()), out, states_,
       brume_state_destroy);
  if (chance(0.1)) checked("brume_receiver_reset", brume_receiver_reset(handle(receivers_)), true);
}

void Hostile::receiver_destroy() {
  end("brume_receiver_destroy", receivers_, brume_receiver_destroy);
}

void Hostile::field_create() {
  if (!fields_.empty() && !chance(0.15)) return;
  brume_field_params params = brume_field_defaults();
  params.extinction = real(5);
  params.masks = chance(0.5) ? nullptr : handle(masks_);
  auto out = output<brume_field*>();
  keep("brume_field_create", brume_field_create(handle(levels_), spoiled(params), out.pointer()), out,
       fields_, brume_field_destroy);
}

void Hostile::field_update() {
  checked("brume_field_update", brume_field_update(handle(fields_), handle(states_)), true);
  read_list("brume_field_changed_bricks", fields_, brume_field_changed_bricks);
}

void Hostile::field_query() {
  query<float>("brume_field_optical_depths", [&](const brume_segment* lines, std::size_t number, float* out) {
    return brume_field_optical_depths(handle(fields_), lines, number, out);
  });
  const float threshold = real(4);
  query<std::uint8_t>("brume_field_visible",
                      [&](const brume_segment* lines, std::size_t number, std::uint8_t* out) {
                        return brume_field_visible(handle(fields_), lines, number, threshold, out);
                      });
  brume_drawn_params drawn = brume_drawn_defaults();
  drawn.erosion = real(1);
  drawn.detail = real(1);
  const brume_drawn_params* const look = chance(0.5) ? nullptr : spoiled(drawn);
  query<float>("brume_field_drawn_depths", [&](const brume_segment* lines, std::size_t number, float* out) {
    return brume_field_drawn_depths(handle(fields_), look, lines, number, out);
  });
  query<std::uint8_t>(
      "brume_field_drawn_visible", [&](const brume_segment* lines, std::size_t number, std::uint8_t* out) {
        return brume_field_drawn_visible(handle(fields_), look, lines, number, threshold, out);
      });
  query<brume_wall>("brume_field_first_walls",
                    [&](const brume_segment* lines, std::size_t number, brume_wall* out) {
                      return brume_field_first_walls(handle(fields_), lines, number, out);
                    });
  read_box("brume_field_densities",
           [&](brume_voxel low, brume_voxel high, std::uint8_t* out, std::size_t voxels) {
             return brume_field_densities(handle(fields_), low, high, out, voxels);
           });
}

void Hostile::field_destroy() {
  end("brume_field_destroy", fields_, brume_field_destroy);
}

}  // namespace brume::api
