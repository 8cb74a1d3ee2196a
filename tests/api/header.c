/* Compiled by the test of the headers as C11, and as C++: the defaults can be evaluated. */
#include <brume/brume_textures.h>

int main(void) {
  const brume_context_params context = brume_context_defaults();
  const brume_voxels_params voxels = brume_voxels_defaults();
  const brume_triangles_params triangles = brume_triangles_defaults();
  const brume_world_params world = brume_world_defaults();
  const brume_sender_params sender = brume_sender_defaults();
  const brume_receiver_params receiver = brume_receiver_defaults();
  const brume_field_params field = brume_field_defaults();
  const brume_event event = brume_event_defaults(BRUME_EVENT_SHOT, 1);
  const brume_textures_params textures = brume_textures_defaults();
  const brume_textures_frame frame = brume_textures_frame_defaults();
  const uint32_t lengths = brume_length(0.2) + brume_smoke_voxels(225.0, voxels.layout.voxel_size);
  return context.next || voxels.next || triangles.next || world.next || sender.next || receiver.next ||
         field.next || event.next || textures.next || frame.next || lengths != 2005;
}
