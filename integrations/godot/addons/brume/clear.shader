shader_type spatial;
// Removes what is drawn already, its alpha too: before the smoke is drawn alone, at half the resolution.
render_mode unshaded, blend_mul, depth_draw_never, depth_test_disable, cull_disabled;

void vertex() {
  POSITION = vec4(VERTEX.xy, 0.0, 1.0);
}

void fragment() {
  ALBEDO = vec3(0.0, 0.0, 0.0);
  ALPHA = 0.0;
}
