#include "tests/textures/gl_engine.hpp"

#include <EGL/eglext.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "core/file.hpp"
#include "tests/work_folder.hpp"

namespace brume::textures {
namespace {

void check(brume_result result) {
  if (result != BRUME_OK) throw std::runtime_error(brume_last_error());
}

/// What OpenGL calls a texture's format.
struct GlFormat {
  GLenum internal, format, type;
};
GlFormat gl_format(std::uint32_t format) {
  switch (format) {
    case BRUME_FORMAT_R8:
      return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case BRUME_FORMAT_RG8:
      return {GL_RG8, GL_RG, GL_UNSIGNED_BYTE};
    case BRUME_FORMAT_RGBA8:
      return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case BRUME_FORMAT_RGBA16F:
      return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case BRUME_FORMAT_RGBA32F:
      return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case BRUME_FORMAT_R16UI:
      return {GL_R16UI, GL_RED_INTEGER, GL_UNSIGNED_SHORT};
    case BRUME_FORMAT_R32UI:
      return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case BRUME_FORMAT_RG32UI:
      return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT};
    case BRUME_FORMAT_RGBA32UI:
      return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
    default:
      throw std::runtime_error("a texture of format " + std::to_string(format));
  }
}

bool is_flat(std::uint32_t kind) {
  return kind == BRUME_TEXTURE_BOUNDARY || kind == BRUME_TEXTURE_CORNERS || kind == BRUME_TEXTURE_HOLES ||
         kind == BRUME_TEXTURE_MASKS;
}
bool is_linear(std::uint32_t kind) {
  return kind == BRUME_TEXTURE_DENSITY || kind == BRUME_TEXTURE_DISPLACEMENT || kind == BRUME_TEXTURE_MASKS ||
         kind == BRUME_TEXTURE_NOISE || kind == BRUME_TEXTURE_DETAIL || kind == BRUME_TEXTURE_LIGHT;
}
bool repeats(std::uint32_t kind) {
  return kind == BRUME_TEXTURE_NOISE || kind == BRUME_TEXTURE_DETAIL;
}
GLenum target_of(std::uint32_t kind) {
  return is_flat(kind) ? GL_TEXTURE_2D : GL_TEXTURE_3D;
}

constexpr std::array kNames{"brume_density",  "brume_displacement", "brume_pages",       "brume_cells",
                            "brume_boundary", "brume_corners",      "brume_holes",       "brume_masks",
                            "brume_noise",    "brume_detail",       "brume_light_volume"};
static_assert(kNames.size() == BRUME_TEXTURE_COUNT);

void upload(const brume_region& region, std::uint32_t texture_format) {
  const GlFormat format = gl_format(texture_format);
  const auto i = [](std::uint32_t n) { return static_cast<GLint>(n); };
  if (is_flat(region.texture)) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, i(region.x), i(region.y), i(region.width), i(region.height),
                    format.format, format.type, region.texels);
  } else {
    glTexSubImage3D(GL_TEXTURE_3D, 0, i(region.x), i(region.y), i(region.z), i(region.width),
                    i(region.height), i(region.depth), format.format, format.type, region.texels);
  }
}

void make(std::uint32_t kind, const brume_texture& texture) {
  const GlFormat format = gl_format(texture.format);
  const auto width = static_cast<GLsizei>(texture.width), height = static_cast<GLsizei>(texture.height);
  const auto depth = static_cast<GLsizei>(texture.depth);
  const GLenum target = target_of(kind);
  GLsizei levels = 1;
  if (repeats(kind))
    while (width >> levels > 0) ++levels;
  if (is_flat(kind)) {
    glTexStorage2D(target, levels, format.internal, width, height);
  } else {
    glTexStorage3D(target, levels, format.internal, width, height, depth);
  }
  // Texels that no region writes are not numbers, or as large as can be: a shader that reads them shows it.
  const std::vector<std::uint8_t> poison(std::size_t{texture.width} * texture.height * texture.depth * 16,
                                         0xff);
  upload({kind, 0, 0, 0, texture.width, texture.height, texture.depth, 0, poison.data(), poison.size()},
         texture.format);
  const GLint filter = is_linear(kind) ? GL_LINEAR : GL_NEAREST;
  glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
  glTexParameteri(target, GL_TEXTURE_MIN_FILTER, repeats(kind) ? GL_LINEAR_MIPMAP_LINEAR : filter);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTexParameteri(target, axis, repeats(kind) ? GL_REPEAT : GL_CLAMP_TO_EDGE);
}

const std::string kVersion = "#version 300 es\n";

std::string exported(const char* name) {
  const auto text = read_text_file(std::string(BRUME_SOURCE_DIR "/shaders/export/") + name);
  if (!text) throw std::runtime_error(text.failure().message);
  return *text;
}

GLuint compile(GLenum stage, const std::string& source) {
  const GLuint shader = glCreateShader(stage);
  const char* const text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error(log.data());
  }
  return shader;
}

/// A display without a window, initialized: of Mesa, or of the first device, which other drivers have.
EGLDisplay windowless_display() {
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  const auto get_devices =
      reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  if (!get_display) return EGL_NO_DISPLAY;
  EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
  EGLDeviceEXT device = nullptr;
  EGLint count = 0;
  if (!get_devices || !get_devices(1, &device, &count) || count == 0) return EGL_NO_DISPLAY;
  display = get_display(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) ? display : EGL_NO_DISPLAY;
}

}  // namespace

Eye Eye::looking(glm::vec3 from, glm::vec3 to, float vertical_degrees) {
  Eye eye;
  eye.position = from;
  eye.forward = glm::normalize(to - from);
  eye.right = glm::normalize(glm::cross(eye.forward, glm::vec3(0, 1, 0)));
  eye.up = glm::cross(eye.right, eye.forward);
  eye.tan_half_height = std::tan(0.5f * glm::radians(vertical_degrees));
  return eye;
}

glm::vec3 Eye::direction(const Picture& picture, int x, int y) const {
  const float across = (2 * (static_cast<float>(x) + 0.5f) / static_cast<float>(picture.width) - 1) *
                       static_cast<float>(picture.width) / static_cast<float>(picture.height);
  const float upward = 1 - 2 * (static_cast<float>(y) + 0.5f) / static_cast<float>(picture.height);
  return glm::normalize(forward + tan_half_height * (across * right + upward * up));
}

GlEngine::GlEngine() : display_(windowless_display()) {
  if (display_ == EGL_NO_DISPLAY) throw std::runtime_error("no EGL without a window");
  eglBindAPI(EGL_OPENGL_ES_API);
  const std::array<EGLint, 5> attributes{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0,
                                         EGL_NONE};
  context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
    throw std::runtime_error("no OpenGL ES 3.0");
  const auto* const extensions = reinterpret_cast<const char*>(glGetString(GL_EXTENSIONS));
  if (std::string(extensions).find("GL_EXT_color_buffer_float") == std::string::npos)
    throw std::runtime_error("no float targets in OpenGL ES");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

GlEngine::~GlEngine() {
  eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

std::string GlEngine::device() const {
  return reinterpret_cast<const char*>(glGetString(GL_RENDERER));
}

std::size_t GlEngine::follow(const brume_textures* textures) {
  std::array<brume_texture, BRUME_TEXTURE_COUNT> list;
  check(brume_textures_list(textures, list.data(), list.size()));
  for (std::uint32_t kind = 0; kind < list.size(); ++kind) {
    if (list[kind].generation == generations_[kind]) continue;  // made, or of no size
    glDeleteTextures(1, &textures_[kind]);
    glGenTextures(1, &textures_[kind]);
    glBindTexture(target_of(kind), textures_[kind]);
    make(kind, list[kind]);
    generations_[kind] = list[kind].generation;
  }
  const brume_region* regions = nullptr;
  std::size_t count = 0, bytes = 0;
  check(brume_textures_regions(textures, &regions, &count));
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t kind = regions[i].texture;
    glBindTexture(target_of(kind), textures_[kind]);
    upload(regions[i], list[kind].format);
    if (repeats(kind)) glGenerateMipmap(target_of(kind));
    bytes += regions[i].byte_count;
  }
  check(brume_textures_constants(textures, constants_.data(), constants_.size()));
  return bytes;
}

GLuint GlEngine::link(const std::string& fragment) const {
  const std::string vertex = kVersion +
                             "void main() { vec2 p = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                             "  gl_Position = vec4(4.0 * p - 1.0, 0.0, 1.0); }\n";
  const GLuint linked = glCreateProgram();
  glAttachShader(linked, compile(GL_VERTEX_SHADER, vertex));
  glAttachShader(linked, compile(GL_FRAGMENT_SHADER, fragment));
  glLinkProgram(linked);
  GLint done = 0;
  glGetProgramiv(linked, GL_LINK_STATUS, &done);
  if (done != GL_TRUE) throw std::runtime_error("the program does not link");
  return linked;
}

GLuint GlEngine::program(const std::string& light, const std::string& main) {
  return link(kVersion +
              "precision highp float;\nprecision highp int;\nuniform vec4 view[5];\nout vec4 color;\n" +
              exported("smoke.glsl") + light + exported("smoke_march.glsl") +
              "void main() {\n"
              "  vec2 at = vec2(gl_FragCoord.x, view[4].y - gl_FragCoord.y) / view[4].xy;\n"
              "  at = at * vec2(2.0, -2.0) + vec2(-1.0, 1.0);\n"
              "  vec3 origin = view[0].xyz, direction = normalize(view[1].xyz + at.x * view[2].xyz + at.y * "
              "view[3].xyz);\n"
              "  float pixel_width = view[4].z;\n" +
              main + "}\n");
}

GLuint GlEngine::program_of_hlsl(const std::string& light, const std::string& main) {
  const cli::WorkFolder folder;
  folder.write("shader.hlsl",
               exported("smoke.hlsl") + light + exported("smoke_march.hlsl") +
                   "cbuffer view { float4 view_rows[5]; };\n"
                   "float4 main(float4 place : SV_Position) : SV_Target {\n"
                   "  float2 at = float2(place.x, view_rows[4].y - place.y) / view_rows[4].xy;\n"
                   "  at = at * float2(2.0, -2.0) + float2(-1.0, 1.0);\n"
                   "  float3 origin = view_rows[0].xyz;\n"
                   "  float3 direction = normalize(view_rows[1].xyz + at.x * view_rows[2].xyz + at.y * "
                   "view_rows[3].xyz);\n"
                   "  float pixel_width = view_rows[4].z;\n  float4 color;\n" +
                   main + "  return color;\n}\n");
  const std::string start = "cd '" + folder.path().string() + "' && ";
  const std::string commands = start +
                               "glslc -x hlsl -fshader-stage=fragment shader.hlsl -o shader.spv "
                               "--target-env=vulkan1.1 -fauto-bind-uniforms -fauto-map-locations && "
                               "spirv-cross shader.spv --version 300 --es --flatten-ubo --output shader.glsl";
  if (std::system(commands.c_str()) != 0) throw std::runtime_error("the HLSL does not compile");
  const auto text = read_text_file(folder.path() / "shader.glsl");
  if (!text) throw std::runtime_error(text.failure().message);
  return link(*text);
}

/// Textures and constants by their names, which those of samplers in translated HLSL contain.
void GlEngine::bind_smoke(GLuint program) const {
  for (std::uint32_t kind = 0; kind < BRUME_TEXTURE_COUNT; ++kind) {
    glActiveTexture(GL_TEXTURE0 + kind);
    glBindTexture(target_of(kind), textures_[kind]);
  }
  GLint count = 0;
  glGetProgramiv(program, GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    std::array<char, 256> text{};
    GLint size = 0;
    GLenum type = 0;
    glGetActiveUniform(program, static_cast<GLuint>(i), static_cast<GLsizei>(text.size()), nullptr, &size,
                       &type, text.data());
    const std::string name = text.data();
    const GLint at = glGetUniformLocation(program, text.data());
    if (name.find("brume_constants") != std::string::npos)
      glUniform4fv(at, BRUME_CONSTANTS / 4, constants_.data());
    for (std::uint32_t kind = 0; kind < BRUME_TEXTURE_COUNT; ++kind)
      if (name.find(kNames[kind]) != std::string::npos) glUniform1i(at, static_cast<GLint>(kind));
  }
}

Picture GlEngine::draw(GLuint program, const Eye& eye, int width, int height,
                       const std::vector<std::pair<std::string, glm::vec4>>& values,
                       const std::vector<FloatMap>& maps) {
  GLuint target = 0, framebuffer = 0;
  glGenTextures(1, &target);
  glActiveTexture(GL_TEXTURE0 + BRUME_TEXTURE_COUNT);
  glBindTexture(GL_TEXTURE_2D, target);
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, height);
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
  glViewport(0, 0, width, height);

  glUseProgram(program);
  const float across = eye.tan_half_height * static_cast<float>(width) / static_cast<float>(height);
  const std::array view{glm::vec4(eye.position, 0), glm::vec4(eye.forward, 0),
                        glm::vec4(across * eye.right, 0), glm::vec4(eye.tan_half_height * eye.up, 0),
                        glm::vec4(width, height, 2 * eye.tan_half_height / static_cast<float>(height), 0)};
  glUniform4fv(glGetUniformLocation(program, "view"), static_cast<GLsizei>(view.size()), &view[0].x);
  for (const auto& [name, value] : values)
    glUniform4f(glGetUniformLocation(program, name.c_str()), value.x, value.y, value.z, value.w);
  bind_smoke(program);
  std::vector<GLuint> made(maps.size());
  glGenTextures(static_cast<GLsizei>(made.size()), made.data());
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const auto unit = static_cast<GLint>(BRUME_TEXTURE_COUNT + 1 + i);
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D_ARRAY, made[i]);
    glTexStorage3D(GL_TEXTURE_2D_ARRAY, 1, GL_R32F, maps[i].width, maps[i].height, maps[i].layers);
    glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, 0, maps[i].width, maps[i].height, maps[i].layers, GL_RED,
                    GL_FLOAT, maps[i].values.data());
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glUniform1i(glGetUniformLocation(program, maps[i].name.c_str()), unit);
  }
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 3);

  Picture picture{width, height, std::vector<glm::vec4>(static_cast<std::size_t>(width * height))};
  std::vector<glm::vec4> rows(picture.texels.size());
  glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, rows.data());
  for (int y = 0; y < height; ++y)
    std::copy_n(rows.begin() + y * width, width, picture.texels.begin() + (height - 1 - y) * width);
  glDeleteFramebuffers(1, &framebuffer);
  glDeleteTextures(1, &target);
  glDeleteTextures(static_cast<GLsizei>(made.size()), made.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw std::runtime_error("OpenGL error " + std::to_string(error));
  return picture;
}

}  // namespace brume::textures
