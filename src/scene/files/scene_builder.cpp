#include "scene/files/scene_builder.hpp"

#include <algorithm>
#include <cmath>

#include "core/log.hpp"
#include "image/decode.hpp"
#include "scene/files/mesh_tools.hpp"
#include "scene/files/stand_ins.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

std::uint32_t last_index(std::size_t size) {
  return static_cast<std::uint32_t>(size - 1);
}

bool all_finite(const glm::mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!std::isfinite(matrix[column][row])) return false;
    }
  }
  return true;
}

double determinant(const glm::mat4& matrix) {
  return glm::determinant(glm::dmat3(glm::dmat4(matrix)));
}

/// The colours of one image, white for null, with the opacities of another.
image::Image8 with_opacity(const image::Image8* color, const image::Image8& opacity) {
  const image::Image8 white{1, 1, {255, 255, 255, 255}};
  const image::Image8& base = color ? *color : white;
  bool has_alpha = false;
  for (std::size_t i = 3; i < opacity.rgba.size(); i += 4) has_alpha = has_alpha || opacity.rgba[i] < 255;
  image::Image8 result{std::max(base.width, opacity.width), std::max(base.height, opacity.height), {}};
  result.rgba.resize(std::size_t{4} * result.width * result.height);
  for (std::size_t y = 0; y < result.height; ++y)
    for (std::size_t x = 0; x < result.width; ++x) {
      const auto nearest = [&](const image::Image8& image) {
        const std::size_t column = x * image.width / result.width, row = y * image.height / result.height;
        return image.rgba.data() + 4 * (row * image.width + column);
      };
      const std::uint8_t *from = nearest(base), *value = nearest(opacity);
      std::uint8_t* to = result.rgba.data() + 4 * (y * result.width + x);
      std::copy_n(from, 3, to);
      to[3] = has_alpha ? value[3] : static_cast<std::uint8_t>((value[0] + value[1] + value[2]) / 3);
    }
  return result;
}

}  // namespace

Result<std::uint32_t> SceneBuilder::add_mesh(Mesh mesh) {
  vertices_ += mesh.vertices.size();
  indices_ += mesh.indices.size();
  if (vertices_ > kMostVertices || indices_ > kMostIndices) {
    return Failure{ErrorCode::resource_limit, name_ + ": has more than " + std::to_string(kMostVertices) +
                                                  " vertices or " + std::to_string(kMostIndices) +
                                                  " indices; split the scene or simplify its meshes"};
  }
  scene.meshes.push_back(std::move(mesh));
  return last_index(scene.meshes.size());
}

std::uint32_t SceneBuilder::image_of_file(std::span<const std::string> names, const std::string& place,
                                          const char* instead, ImageUse use, Wraps wraps) {
  for (const std::string& name : names) {
    const auto found = files_.find(name);
    if (!found) continue;
    if (const auto known = images_.find({*found, wraps}); known != images_.end()) return known->second;
    const auto bytes = files_.read(*found);
    if (bytes)
      return images_[{*found, wraps}] =
                 add_image(image::decode_image(*bytes, *found), *found, place, use, wraps);
    warn_of_image(use, place + ": " + bytes.failure().message + "; " + instead);
    return images_[{*found, wraps}] = checker_image();
  }
  if (!images_.contains({names.front(), wraps})) {
    warn_of_image(use, place + ": the image " + in_quotes(names.front()) + " " +
                           why_not_found(names.front()) + "; " + instead);
  }
  return images_[{names.front(), wraps}] = checker_image();
}

std::uint32_t SceneBuilder::image_of_bytes(std::span<const std::byte> bytes, const std::string& name,
                                           const std::string& place, ImageUse use, Wraps wraps) {
  return add_image(image::decode_image(bytes, name), name, place, use, wraps);
}

std::uint32_t SceneBuilder::image_with_opacity(std::uint32_t color, std::span<const std::string> names,
                                               const std::string& place, Wraps wraps) {
  const std::pair key(color, names.front());
  if (const auto known = with_opacity_.find(key); known != with_opacity_.end()) return known->second;
  const auto fail = [&](const std::string& why) {
    if (missing_opacities_.insert(names.front()).second)
      warn_of_image(ImageUse::roles, place + ": " + why + "; the material counts as opaque");
    return kNone;
  };

  // The file.
  const auto found =
      std::ranges::find_if(names, [&](const auto& name) { return files_.find(name).has_value(); });
  if (found == names.end())
    return fail("the image " + in_quotes(names.front()) + " " + why_not_found(names.front()));
  const std::string file = *files_.find(*found);
  const auto bytes = files_.read(file);
  if (!bytes) return fail(bytes.failure().message);
  const auto opacity = image::decode_image(*bytes, file);
  if (!opacity) return fail(opacity.failure().message);

  // The image. Its size is checked before it is made.
  const image::Image8* base = color == kNone ? nullptr : &scene.images[color].pixels;
  const std::uint64_t width = std::max(opacity->width, base ? base->width : 1),
                      height = std::max(opacity->height, base ? base->height : 1);
  if (image_bytes_ + 4 * width * height > kMostImageBytes)
    return fail("the scene's images exceed " + std::to_string(kMostImageBytes >> 20) + " MiB with " + file);
  return with_opacity_[key] = add_image(with_opacity(base, *opacity), file, place, ImageUse::roles, wraps);
}

std::uint32_t SceneBuilder::add_image(Result<image::Image8> pixels, const std::string& name,
                                      const std::string& place, ImageUse use, Wraps wraps) {
  if (!pixels) {
    // An embedded image has no name but its place.
    const std::string& what = pixels.failure().message;
    warn_of_image(use, (what.starts_with(place) ? what : place + ": " + what) + "; " + kCheckerStandsIn);
    return checker_image();
  }
  if (image_bytes_ + pixels->rgba.size() > kMostImageBytes) {
    warn_of_image(use, place + ": the scene's images exceed " + std::to_string(kMostImageBytes >> 20) +
                           " MiB; a magenta checker stands in for " + name);
    return checker_image();
  }
  image_bytes_ += pixels->rgba.size();
  scene.images.push_back({name, std::move(*pixels), wraps});
  return last_index(scene.images.size());
}

void SceneBuilder::warn_of_image(ImageUse use, const std::string& line) const {
  const bool is_needed = use == ImageUse::roles ? use_ != ImageUse::none : use_ == ImageUse::pictures;
  if (is_needed) log_warning(line);
}

std::uint32_t SceneBuilder::checker_image() {
  if (checker_ == kNone) {
    scene.images.push_back({"stand-in checker", magenta_checker()});
    checker_ = last_index(scene.images.size());
  }
  return checker_;
}

Result<std::uint32_t> SceneBuilder::cube_mesh() {
  if (cube_ == kNone) {
    auto added = add_mesh(unit_cube());
    if (!added) return added;
    cube_ = *added;
  }
  return cube_;
}

Result<std::uint32_t> SceneBuilder::mirrored_mesh(std::uint32_t mesh) {
  if (const auto known = mirrored_.find(mesh); known != mirrored_.end()) return known->second;
  auto added = add_mesh(mirrored(scene.meshes[mesh]));
  if (added) mirrored_[mesh] = *added;
  return added;
}

Result<void> SceneBuilder::add_object(Object object, const std::string& place) {
  const double volume = determinant(object.world_from_mesh);
  if (volume == 0) {
    log_warning(place + ": \"" + object.name +
                "\" is scaled to nothing and skipped; give it a scale other than 0");
    return {};
  }
  if (volume < 0) {
    const auto copy = mirrored_mesh(object.mesh);
    if (!copy) return copy.failure();
    object.mesh = *copy;
  }
  scene.objects.push_back(std::move(object));
  return {};
}

Result<void> SceneBuilder::set_grenade(const Object& object, const std::string& place) {
  if (determinant(object.world_from_mesh) == 0) {
    log_warning(place + ": the grenade is scaled to nothing and skipped; give it a scale other than 0");
    return {};
  }
  Mesh mesh = scene.meshes[object.mesh];
  if (determinant(object.world_from_mesh) < 0) mesh = mirrored(mesh);
  mesh.name = "grenade";
  centre(mesh);
  const auto added = add_mesh(std::move(mesh));
  if (!added) return added.failure();
  scene.grenade = object;
  scene.grenade->mesh = *added;
  scene.grenade->role = Role::ghost;
  scene.grenade->world_from_mesh[3] = glm::vec4(0, 0, 0, 1);
  return {};
}

Result<void> SceneBuilder::check_object(const Object& object) const {
  bool reachable = all_finite(object.world_from_mesh);
  for (const Vertex& vertex : scene.meshes[object.mesh].vertices) {
    const glm::vec3 p = glm::vec3(object.world_from_mesh * glm::vec4(vertex.position, 1));
    for (int axis = 0; axis < 3; ++axis) reachable = reachable && std::abs(p[axis]) <= kFarthest;
  }
  if (reachable) return {};
  return Failure{ErrorCode::bad_input, name_ + ": \"" + object.name +
                                           "\" reaches farther than 10,000 km from the origin; check its "
                                           "position, its scale and the unit of its mesh"};
}

Result<Scene> SceneBuilder::finish() && {
  for (const Object& object : scene.objects)
    if (auto checked = check_object(object); !checked) return checked.failure();
  if (scene.grenade) {
    if (auto checked = check_object(*scene.grenade); !checked) return checked.failure();
  }
  return std::move(scene);
}

}  // namespace brume::scene
