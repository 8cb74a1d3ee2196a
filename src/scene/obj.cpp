#include "scene/obj.hpp"

#include <array>
#include <charconv>
#include <map>
#include <unordered_map>
#include <utility>

#include "scene/color.hpp"
#include "scene/mesh_tools.hpp"
#include "scene/polygon.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

constexpr std::int64_t kUnset = -1;

/// The indices of a face corner, from 0; kUnset if absent.
struct Corner {
  std::int64_t position = kUnset, uv = kUnset, normal = kUnset;
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = static_cast<std::uint64_t>(corner.position) * 0x9e3779b97f4a7c15ull;
    hash = (hash ^ static_cast<std::uint64_t>(corner.uv)) * 0xff51afd7ed558ccdull;
    hash = (hash ^ (hash >> 32) ^ static_cast<std::uint64_t>(corner.normal)) * 0xc4ceb9fe1a85ec53ull;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name)
      : reader_(text, name, TextReader::Continuation::backslash) {}

  Result<ObjModel> parse() {
    while (reader_.next_line()) {
      if (auto read = read_statement(reader_.next_word()); !read) return read.failure();
    }
    std::erase_if(model_.parts, [](const ObjPart& part) { return part.indices.empty(); });
    model_.has_colors = !colors_.empty();
    return std::move(model_);
  }

 private:
  Result<void> read_statement(std::string_view word) {
    if (word == "v") return read_position();
    if (word == "vt") return read_vector(uvs_, 2, 1, "a texture coordinate");
    if (word == "vn") return read_vector(normals_, 3, 3, "a normal");
    if (word == "f") return read_face();
    if (word == "usemtl") {
      material_ = std::string(reader_.rest_of_line());
      use_part();
    }
    if (word == "o" || word == "g") {
      object_ = std::string(reader_.rest_of_line());
      use_part();
    }
    if (word == "mtllib")
      model_.libraries.push_back({std::string(reader_.rest_of_line()), reader_.line_place()});
    return {};
  }

  /// From `least` to `most` numbers; further values on the line (weights, colours) are ignored.
  Result<void> read_vector(std::vector<glm::vec3>& into, int most, int least, const char* what) {
    constexpr const char* kAxes[3] = {"first", "second", "third"};
    glm::vec3 value(0);
    for (int axis = 0; axis < most; ++axis) {
      const std::string_view word = reader_.next_word();
      if (word.empty() && axis >= least) break;
      const auto number =
          reader_.number_from(word, std::string("the ") + kAxes[axis] + " component of " + what);
      if (!number) return number.failure();
      value[axis] = *number;
    }
    into.push_back(value);
    return {};
  }

  /// A position, and the vertex colour of many scanners and sculpting programs: "v x y z r g b".
  Result<void> read_position() {
    if (auto read = read_vector(positions_, 3, 3, "a position"); !read) return read;
    glm::vec3 color(0);
    int channels = 0;
    for (std::string_view word = reader_.next_word(); !word.empty(); word = reader_.next_word()) {
      const auto number = reader_.number_from(word, "a vertex colour");
      if (!number || channels == 3) return {};
      color[channels++] = *number;
    }
    if (channels != 3) return {};
    colors_.resize(positions_.size(), glm::vec3(1));
    colors_.back() = glm::clamp(color, 0.0f, 1.0f);
    return {};
  }

  /// The part of the present object and material.
  void use_part() {
    const bool is_named = model_.parts.size() < kMostObjObjects || parts_.contains({object_, material_});
    const std::string object = is_named ? object_ : "";
    const auto [entry, is_new] = parts_.try_emplace({object, material_}, model_.parts.size());
    if (is_new) model_.parts.push_back({object, material_, reader_.line_place(), {}});
    part_ = entry->second;
  }

  /// Removes an index from the front of `word`.
  Result<std::int64_t> read_index(std::string_view& word, std::string_view whole, std::size_t count,
                                  const char* what) {
    std::int64_t index = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    const auto used = static_cast<std::size_t>(end - word.data());
    if (error == std::errc::invalid_argument || (used < word.size() && *end != '/')) {
      return reader_.expected("a face corner like 1, 1/2, 1//3 or 1/2/3", whole);
    }
    const auto limit = static_cast<std::int64_t>(count);
    if (error != std::errc() || index == 0 || index > limit || index < -limit) {
      return Failure{ErrorCode::bad_input, reader_.place() + ": " + in_quotes(whole) + " names no " + what +
                                               ": there are " + std::to_string(count) +
                                               " above this line, and they count from 1"};
    }
    word.remove_prefix(used);
    return index > 0 ? index - 1 : limit + index;
  }

  Result<Corner> read_corner(std::string_view whole) {
    Corner corner;
    std::string_view word = whole;
    const auto position = read_index(word, whole, positions_.size(), "position");
    if (!position) return position.failure();
    corner.position = *position;
    if (!word.empty()) word.remove_prefix(1);
    if (!word.empty() && word.front() != '/') {
      const auto uv = read_index(word, whole, uvs_.size(), "texture coordinate");
      if (!uv) return uv.failure();
      corner.uv = *uv;
    }
    if (!word.empty()) word.remove_prefix(1);
    if (!word.empty()) {
      const auto normal = read_index(word, whole, normals_.size(), "normal");
      if (!normal) return normal.failure();
      corner.normal = *normal;
      if (!word.empty()) return reader_.expected("a face corner like 1, 1/2, 1//3 or 1/2/3", whole);
    }
    return corner;
  }

  Result<void> read_face() {
    face_.clear();
    face_positions_.clear();
    for (std::string_view word = reader_.next_word(); !word.empty(); word = reader_.next_word()) {
      const auto corner = read_corner(word);
      if (!corner) return corner.failure();
      face_.push_back(*corner);
      face_positions_.push_back(positions_[static_cast<std::size_t>(corner->position)]);
    }
    if (face_.size() < 3) return reader_.expected("at least 3 corners of a face", {});
    if (face_.size() > kMaxConcaveCorners && !is_convex(face_positions_)) {
      return Failure{ErrorCode::resource_limit,
                     reader_.line_place() + ": a face with " + std::to_string(face_.size()) +
                         " corners; at most " + std::to_string(kMaxConcaveCorners) +
                         " are triangulated if it is not convex: export the mesh as triangles"};
    }
    add_face();
    return {};
  }

  void add_face() {
    if (model_.parts.empty()) use_part();
    face_vertices_.clear();
    std::int64_t face_normal = kUnset;
    for (Corner corner : face_) {
      const bool has_normal =
          corner.normal != kUnset && is_usable(normals_[static_cast<std::size_t>(corner.normal)]);
      if (!has_normal) {
        if (face_normal == kUnset) {
          face_normals_.push_back(unit_normal());
          face_normal = static_cast<std::int64_t>(face_normals_.size());
        }
        corner.normal = kUnset - face_normal;  // Below kUnset: one of the faces' own normals.
      }
      face_vertices_.push_back(vertex_of(corner));
    }
    std::vector<std::uint32_t>& indices = model_.parts[part_].indices;
    for (const auto& triangle : triangulate(face_positions_)) {
      for (const std::uint32_t corner : triangle) indices.push_back(face_vertices_[corner]);
    }
  }

  static glm::vec3 linear(glm::vec3 srgb) {
    return glm::vec3(
        glm::dvec3(linear_from_srgb(srgb.r), linear_from_srgb(srgb.g), linear_from_srgb(srgb.b)));
  }

  static bool is_usable(glm::vec3 normal) {
    const double square = glm::dot(glm::dvec3(normal), glm::dvec3(normal));
    return square > 1e-60;
  }

  glm::vec3 unit_normal() const {
    const glm::dvec3 area = area_vector(face_positions_);
    const double size = glm::length(area);
    return size > 1e-150 && size < 1e150 ? glm::vec3(area / size) : glm::vec3(0, 1, 0);
  }

  std::uint32_t vertex_of(const Corner& corner) {
    const auto next = static_cast<std::uint32_t>(model_.vertices.size());
    const auto [entry, is_new] = vertex_of_corner_.try_emplace(corner, next);
    if (!is_new) return entry->second;
    Vertex vertex;
    const auto position = static_cast<std::size_t>(corner.position);
    vertex.position = positions_[position];
    if (position < colors_.size()) vertex.color = glm::vec4(linear(colors_[position]), 1);
    if (corner.uv != kUnset) {
      const glm::vec3 uv = uvs_[static_cast<std::size_t>(corner.uv)];
      vertex.uv = glm::vec2(uv.x, 1.0f - uv.y);
    }
    vertex.normal =
        corner.normal >= 0
            ? glm::vec3(glm::normalize(glm::dvec3(normals_[static_cast<std::size_t>(corner.normal)])))
            : face_normals_[static_cast<std::size_t>(kUnset - corner.normal - 1)];
    model_.vertices.push_back(vertex);
    return next;
  }

  TextReader reader_;
  ObjModel model_;
  std::vector<glm::vec3> positions_, uvs_, normals_, face_normals_;
  std::vector<glm::vec3> colors_;  ///< sRGB, of the first positions; the others are white.
  std::string object_, material_;
  std::map<std::pair<std::string, std::string>, std::size_t> parts_;  // by object and material
  std::size_t part_ = 0;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertex_of_corner_;
  std::vector<Corner> face_;
  std::vector<glm::vec3> face_positions_;
  std::vector<std::uint32_t> face_vertices_;
};

}  // namespace

Result<ObjModel> parse_obj(std::string_view text, const std::string& name) {
  if (is_utf16(text)) return parse_obj(utf8_from_utf16(text), name);
  return ObjParser(text, name).parse();
}

Mesh merged_mesh(ObjModel model, const std::string& name) {
  Mesh mesh{name, std::move(model.vertices), {}};
  for (const ObjPart& part : model.parts) {
    mesh.indices.insert(mesh.indices.end(), part.indices.begin(), part.indices.end());
  }
  compute_tangents(mesh);
  return mesh;
}

std::vector<Mesh> part_meshes(const ObjModel& model) {
  std::vector<Mesh> meshes;
  std::vector<std::uint32_t> new_index(model.vertices.size(), kNone);
  for (const ObjPart& part : model.parts) {
    Mesh mesh{part.material, {}, {}};
    for (const std::uint32_t index : part.indices) {
      if (new_index[index] == kNone) {
        new_index[index] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(model.vertices[index]);
      }
      mesh.indices.push_back(new_index[index]);
    }
    for (const std::uint32_t index : part.indices) new_index[index] = kNone;
    compute_tangents(mesh);
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace brume::scene
