// A renderer of somebody else, in OpenGL ES 3.0 without a window: it has the smoke from brume_textures.h and
// shaders/export/smoke.glsl alone.
#pragma once

#include <EGL/egl.h>
#include <GLES3/gl3.h>
#include <brume/brume_textures.h>

#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace brume::textures {

struct Picture {
  int width = 0, height = 0;
  std::vector<glm::vec4> texels;  ///< Rows from the top.
  const glm::vec4& at(int x, int y) const {
    return texels[static_cast<std::size_t>(x) +
                  static_cast<std::size_t>(width) * static_cast<std::size_t>(y)];
  }
};

/// Layers of numbers, rows from the top: a sampler2DArray of this name, not filtered.
struct FloatMap {
  std::string name;
  int width = 0, height = 0, layers = 1;
  std::vector<float> values;
};

/// A pinhole whose axes are unit vectors.
struct Eye {
  glm::vec3 position{0}, forward{0, 0, -1}, right{1, 0, 0}, up{0, 1, 0};
  float tan_half_height = 0.5f;
  static Eye looking(glm::vec3 from, glm::vec3 to, float vertical_degrees);
  /// The direction of a pixel's middle.
  glm::vec3 direction(const Picture& picture, int x, int y) const;
};

class GlEngine {
 public:
  /// Throws std::runtime_error where there is no OpenGL ES 3.0 with float targets.
  GlEngine();
  ~GlEngine();
  GlEngine(const GlEngine&) = delete;
  GlEngine& operator=(const GlEngine&) = delete;

  std::string device() const;
  /// Makes textures that have to be made again, and uploads what the last update changed. Returns the bytes.
  std::size_t follow(const brume_textures* textures);
  /// A program of a fragment shader's main, with smoke.glsl, `light` and smoke_march.glsl. `main` writes
  /// `color` from `origin` and `direction`. Throws with the compiler's messages.
  GLuint program(const std::string& light, const std::string& main);
  /// The same of smoke.hlsl and smoke_march.hlsl, translated by glslc and spirv-cross.
  GLuint program_of_hlsl(const std::string& light, const std::string& main);
  /// Draws all pixels. `values` are set as uniforms by name.
  Picture draw(GLuint program, const Eye& eye, int width, int height,
               const std::vector<std::pair<std::string, glm::vec4>>& values = {},
               const std::vector<FloatMap>& maps = {});

 private:
  GLuint link(const std::string& fragment) const;
  void bind_smoke(GLuint program) const;

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  std::array<GLuint, BRUME_TEXTURE_COUNT> textures_{};
  std::array<std::uint32_t, BRUME_TEXTURE_COUNT> generations_{};
  std::array<float, BRUME_CONSTANTS> constants_{};
};

}  // namespace brume::textures
