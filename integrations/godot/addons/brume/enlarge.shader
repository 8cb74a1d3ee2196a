shader_type spatial;
// Smoke that was drawn at half the resolution, in front of the scene: of the nine nearest texels those count whose
// surface is as far away, so that smoke ends at edges. Nine, as grain of the smoke is even over three by three.
render_mode unshaded, depth_draw_never, depth_test_disable, cull_disabled;

uniform sampler2D smoke;  // times its opacity

void vertex() {
  POSITION = vec4(VERTEX.xy, 0.0, 1.0);
}

void fragment() {
  vec2 size = vec2(textureSize(smoke, 0));
  vec4 surface = INV_PROJECTION_MATRIX * vec4(0.0, 0.0, texture(DEPTH_TEXTURE, SCREEN_UV).r * 2.0 - 1.0, 1.0);
  float away = surface.z / surface.w;
  vec2 middle = floor(SCREEN_UV * size);
  vec2 part = SCREEN_UV * size - middle - 0.5;
  vec4 sum = vec4(0.0, 0.0, 0.0, 0.0);
  float weights = 0.0;
  for (int i = 0; i < 9; ++i) {
    vec2 step = vec2(float(i % 3), float(i / 3)) - 1.0;
    vec2 texel = clamp(middle + step, vec2(0.0, 0.0), size - 1.0);
    vec4 other = INV_PROJECTION_MATRIX *
                 vec4(0.0, 0.0, texture(DEPTH_TEXTURE, (texel + 0.5) / size).r * 2.0 - 1.0, 1.0);
    // A quadratic B-spline.
    vec2 off = abs(step - part);
    vec2 outer = 0.5 * (1.5 - off) * (1.5 - off);
    vec2 near = vec2(off.x < 0.5 ? 0.75 - off.x * off.x : outer.x, off.y < 0.5 ? 0.75 - off.y * off.y : outer.y);
    float weight = near.x * near.y / (0.02 + abs(other.z / other.w / away - 1.0));
    sum += weight * texelFetch(smoke, ivec2(texel), 0);
    weights += weight;
  }
  sum /= max(weights, 0.000001);
  ALPHA = sum.a;
  ALBEDO = sum.rgb / max(ALPHA, 0.001);
}
