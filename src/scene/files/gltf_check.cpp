#include "scene/files/gltf_check.hpp"

#include <algorithm>
#include <map>

#include "scene/files/gltf_rewrite.hpp"
#include "scene/text_reader.hpp"

namespace brume::scene {
namespace {

using nlohmann::json;

constexpr int kMostNesting = 64;
constexpr double kMostBytes = 1ull << 32, kPi = 3.14159265358979323846;

enum class Kind { any, object, array, text, flag, number, whole, index };

struct Rule {
  const char* path;  ///< Array elements are [], members of any name *.
  Kind kind = Kind::any;
  double least = 0, most = 0;
  std::size_t count = 0;        ///< Required length of an array; 0 for any.
  const char* array = nullptr;  ///< The array that an index refers to.
  bool required = false;
};

/// Extensions that a file may require. KHR_materials_* are allowed too: surfaces look plainer without them.
constexpr std::string_view kSupportedExtensions[] = {"KHR_lights_punctual",     "KHR_mesh_quantization",
                                                     "KHR_texture_transform",   "KHR_draco_mesh_compression",
                                                     "EXT_meshopt_compression", "EXT_texture_webp",
                                                     "EXT_mesh_gpu_instancing"};

#define TEXTURE(path)                                                                               \
  {path ".index", Kind::index, 0, 0, 0, "/textures", true}, {path ".texCoord", Kind::whole, 0, 64}, \
      {path ".extensions", Kind::object},                                                           \
      {path ".extensions.KHR_texture_transform.offset[]", Kind::number, -1e6, 1e6, 2},              \
      {path ".extensions.KHR_texture_transform.rotation", Kind::number, -1e6, 1e6},                 \
      {path ".extensions.KHR_texture_transform.scale[]", Kind::number, -1e6, 1e6, 2}, {             \
    path ".extensions.KHR_texture_transform.texCoord", Kind::whole, 0, 64                           \
  }

#define LIGHTS "extensions.KHR_lights_punctual.lights"
#define GLOSSY "materials[].extensions.KHR_materials_pbrSpecularGlossiness"
#define DRACO "meshes[].primitives[].extensions.KHR_draco_mesh_compression"
#define MESHOPT "bufferViews[].extensions.EXT_meshopt_compression"
constexpr Rule kRules[] = {
    {"asset.version", Kind::text, 0, 0, 0, nullptr, true},
    {"extensionsRequired[]", Kind::text},
    {"scene", Kind::index, 0, 0, 0, "/scenes"},
    {"scenes[].nodes[]", Kind::index, 0, 0, 0, "/nodes"},
    {"nodes[].name", Kind::text},
    {"nodes[].mesh", Kind::index, 0, 0, 0, "/meshes"},
    {"nodes[].skin", Kind::index, 0, 0, 0, "/skins"},
    {"skins[].joints[]", Kind::index, 0, 0, 0, "/nodes"},
    {"skins[].inverseBindMatrices", Kind::index, 0, 0, 0, "/accessors"},
    {"nodes[].camera", Kind::index, 0, 0, 0, "/cameras"},
    {"nodes[].children[]", Kind::index, 0, 0, 0, "/nodes"},
    {"nodes[].matrix[]", Kind::number, -1e30, 1e30, 16},
    {"nodes[].translation[]", Kind::number, -1e30, 1e30, 3},
    {"nodes[].rotation[]", Kind::number, -1e30, 1e30, 4},
    {"nodes[].scale[]", Kind::number, -1e30, 1e30, 3},
    {"nodes[].extensions.KHR_lights_punctual.light", Kind::index, 0, 0, 0,
     "/extensions/KHR_lights_punctual/lights", true},
    {"meshes[].name", Kind::text},
    {"meshes[].primitives[].mode", Kind::whole, 0, 6},
    {"meshes[].primitives[].material", Kind::index, 0, 0, 0, "/materials"},
    {"nodes[].extensions.EXT_mesh_gpu_instancing.attributes.*", Kind::index, 0, 0, 0, "/accessors"},
    {"meshes[].primitives[].indices", Kind::index, 0, 0, 0, "/accessors"},
    {"nodes[].weights[]", Kind::number, -1e6, 1e6},
    {"meshes[].weights[]", Kind::number, -1e6, 1e6},
    {"meshes[].primitives[].targets[].*", Kind::index, 0, 0, 0, "/accessors"},
    {"meshes[].primitives[].attributes.*", Kind::index, 0, 0, 0, "/accessors"},
    {"meshes[].primitives[].attributes.POSITION", Kind::index, 0, 0, 0, "/accessors", true},
    {DRACO ".bufferView", Kind::index, 0, 0, 0, "/bufferViews", true},
    {DRACO ".attributes", Kind::object, 0, 0, 0, nullptr, true},
    {DRACO ".attributes.*", Kind::whole, 0, 0x7fffffff},
    {"accessors[].bufferView", Kind::index, 0, 0, 0, "/bufferViews"},
    {"accessors[].byteOffset", Kind::whole, 0, kMostBytes},
    {"accessors[].count", Kind::whole, 1, kMostBytes, 0, nullptr, true},
    {"accessors[].componentType", Kind::whole, 5120, 5126, 0, nullptr, true},
    {"accessors[].type", Kind::text, 0, 0, 0, nullptr, true},
    {"accessors[].normalized", Kind::flag},
    {"accessors[].sparse.count", Kind::whole, 0, 1u << 30, 0, nullptr, true},
    {"accessors[].sparse.indices.bufferView", Kind::index, 0, 0, 0, "/bufferViews", true},
    {"accessors[].sparse.indices.byteOffset", Kind::whole, 0, 1u << 30},
    {"accessors[].sparse.indices.componentType", Kind::whole, 5121, 5125, 0, nullptr, true},
    {"accessors[].sparse.values.bufferView", Kind::index, 0, 0, 0, "/bufferViews", true},
    {"accessors[].sparse.values.byteOffset", Kind::whole, 0, 1u << 30},
    {"bufferViews[].buffer", Kind::index, 0, 0, 0, "/buffers", true},
    {"bufferViews[].byteOffset", Kind::whole, 0, kMostBytes},
    {"bufferViews[].byteLength", Kind::whole, 1, 0x7fffffff, 0, nullptr, true},
    {"bufferViews[].byteStride", Kind::whole, 4, 252},
    {MESHOPT ".buffer", Kind::index, 0, 0, 0, "/buffers", true},
    {MESHOPT ".byteOffset", Kind::whole, 0, 0x7fffffff},
    {MESHOPT ".byteLength", Kind::whole, 1, 0x7fffffff, 0, nullptr, true},
    {MESHOPT ".byteStride", Kind::whole, 1, 256, 0, nullptr, true},
    {MESHOPT ".count", Kind::whole, 1, 0x7fffffff, 0, nullptr, true},
    {MESHOPT ".mode", Kind::text, 0, 0, 0, nullptr, true},
    {MESHOPT ".filter", Kind::text},
    {"buffers[].byteLength", Kind::whole, 1, kMostBytes, 0, nullptr, true},
    {"buffers[].uri", Kind::text},
    {"materials[].name", Kind::text},
    {"materials[].pbrMetallicRoughness.baseColorFactor[]", Kind::number, 0, 1, 4},
    {"materials[].pbrMetallicRoughness.roughnessFactor", Kind::number, 0, 1},
    {"materials[].pbrMetallicRoughness.metallicFactor", Kind::number, 0, 1},
    TEXTURE("materials[].pbrMetallicRoughness.baseColorTexture"),
    TEXTURE("materials[].pbrMetallicRoughness.metallicRoughnessTexture"),
    {GLOSSY ".diffuseFactor[]", Kind::number, 0, 1, 4},
    {GLOSSY ".glossinessFactor", Kind::number, 0, 1},
    TEXTURE(GLOSSY ".diffuseTexture"),
    TEXTURE("materials[].normalTexture"),
    TEXTURE("materials[].emissiveTexture"),
    {"materials[].emissiveFactor[]", Kind::number, 0, 1e6, 3},
    {"materials[].alphaMode", Kind::text},
    {"materials[].alphaCutoff", Kind::number, 0, 1e6},
    {"materials[].extensions.KHR_materials_emissive_strength.emissiveStrength", Kind::number, 0, 1e6},
    {"materials[].extensions.KHR_materials_transmission.transmissionFactor", Kind::number, 0, 1e6},
    {"textures[].source", Kind::index, 0, 0, 0, "/images"},
    {"textures[].sampler", Kind::index, 0, 0, 0, "/samplers"},
    {"samplers[].wrapS", Kind::whole, 0, 0xffff},
    {"samplers[].wrapT", Kind::whole, 0, 0xffff},
    {"textures[].extensions.EXT_texture_webp.source", Kind::index, 0, 0, 0, "/images", true},
    {"images[].bufferView", Kind::index, 0, 0, 0, "/bufferViews"},
    {"images[].uri", Kind::text},
    {"cameras[].type", Kind::text, 0, 0, 0, nullptr, true},
    {"cameras[].perspective.znear", Kind::number, 0, 1e30, 0, nullptr, true},
    {"cameras[].perspective.yfov", Kind::number, 0.001, kPi - 0.001, 0, nullptr, true},
    {LIGHTS "[].type", Kind::text, 0, 0, 0, nullptr, true},
    {LIGHTS "[].color[]", Kind::number, 0, 1e6, 3},
    {LIGHTS "[].intensity", Kind::number, 0, 1e12},
    {LIGHTS "[].spot.innerConeAngle", Kind::number, 0, kPi / 2},
    {LIGHTS "[].spot.outerConeAngle", Kind::number, 0, kPi / 2},
};
#undef GLOSSY
#undef MESHOPT
#undef DRACO
#undef LIGHTS
#undef TEXTURE

/// The rules by path, including rules for the enclosing arrays and objects.
struct Node {
  Rule rule{};
  std::vector<std::string> required;
};

const std::map<std::string, Node>& rules() {
  static const std::map<std::string, Node> all = [] {
    std::map<std::string, Node> result;
    for (const Rule& rule : kRules) {
      result[rule.path].rule = rule;
      const std::string path = rule.path;
      for (std::size_t end = path.find_first_of(".["); end != std::string::npos;
           end = path.find_first_of(".[", end + 1)) {
        Rule& around = result[path.substr(0, end)].rule;
        around.kind = path[end] == '.' ? Kind::object : Kind::array;
        if (path[end] == '[' && end + 2 == path.size()) around.count = rule.count;
      }
      const std::size_t dot = path.rfind('.');
      if (rule.required) result[path.substr(0, dot)].required.push_back(path.substr(dot + 1));
    }
    result["meshes[]"].required = {"primitives"};
    result["skins[]"].required = {"joints"};
    result["meshes[].primitives[]"].required = {"attributes"};
    return result;
  }();
  return all;
}

class Checker {
 public:
  Checker(const json& document, const std::string& file) : document_(document), file_(file) {}

  void check() const {
    if (!document_.is_object()) fail("", "expected an object");
    check_version();
    if (!document_.contains("asset")) fail("", "expected a member \"asset\"");
    visit(document_, "", "", 0);
    check_extensions();
    check_views();
  }

 private:
  /// glTF 1.0 has objects where 2.0 has arrays, and its files often lack the version.
  void check_version() const {
    const json::json_pointer version("/asset/version");
    std::string number;
    if (document_.contains("asset") && document_["asset"].is_object() && document_.contains(version) &&
        document_.at(version).is_string())
      number = document_.at(version).get<std::string>();
    const bool is_first = number.starts_with("1.") ||
                          (number.empty() && document_.contains("meshes") && document_["meshes"].is_object());
    if (is_first) throw Error(ErrorCode::bad_input, file_ + ": is glTF 1.0; convert it to 2.0");
    if (!number.empty() && !number.starts_with("2.")) {
      throw Error(ErrorCode::bad_input,
                  file_ + ": is glTF of version " + in_quotes(number) + "; convert it to 2.0");
    }
  }

  void check_extensions() const {
    if (!document_.contains("extensionsRequired")) return;
    const json& required = document_["extensionsRequired"];
    for (std::size_t i = 0; i < required.size(); ++i) {
      const auto name = required[i].get<std::string>();
      if (name.starts_with("KHR_materials_") || std::ranges::count(kSupportedExtensions, name) > 0) continue;
      fail("extensionsRequired[" + std::to_string(i) + "]",
           "the file requires the extension " + name + ", which is not supported; export without it");
    }
  }

  void check_views() const {
    if (!document_.contains("bufferViews")) return;
    const json& views = document_["bufferViews"];
    const json::json_pointer meshopt("/extensions/EXT_meshopt_compression");
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::string path = "bufferViews[" + std::to_string(i) + "]";
      check_range(views[i], path);
      const bool is_compressed = views[i].contains(meshopt);
      if (is_compressed) check_range(views[i].at(meshopt), path + ".extensions.EXT_meshopt_compression");
      if (has_no_data(is_compressed ? views[i].at(meshopt) : views[i]))
        fail(path + ".buffer", "the buffer has no data");
    }
    if (!document_.contains("images")) return;
    for (const json& image : document_["images"]) {
      if (image.contains("bufferView") && views[image["bufferView"].get<std::size_t>()].contains(meshopt))
        fail("images", "an image in a bufferView with EXT_meshopt_compression");
    }
  }

  bool has_no_data(const json& range) const {
    return is_fallback_buffer(document_["buffers"][range["buffer"].get<std::size_t>()]);
  }

  /// The bytes lie in their buffer.
  void check_range(const json& range, const std::string& path) const {
    const auto end = range.value("byteOffset", std::uint64_t{0}) + range["byteLength"].get<std::uint64_t>();
    const auto size =
        document_["buffers"][range["buffer"].get<std::size_t>()]["byteLength"].get<std::uint64_t>();
    if (end > size)
      fail(path, "ends at byte " + std::to_string(end) + " of a buffer of " + std::to_string(size));
  }

  [[noreturn]] void fail(const std::string& path, const std::string& what) const {
    throw Error(ErrorCode::bad_input, file_ + ": " + (path.empty() ? "the document" : path) + ": " + what);
  }

  void expect(bool holds, const json& value, const std::string& path, const std::string& what) const {
    if (holds) return;
    // Printing an untrusted value could be long: arrays and objects are only named.
    const std::string found = value.is_structured()
                                  ? std::string("an ") + value.type_name()
                                  : in_quotes(value.dump(-1, ' ', true, json::error_handler_t::replace));
    fail(path, "expected " + what + ", found " + found);
  }

  /// `pattern` is the path in the form of the rules.
  void visit(const json& value, const std::string& pattern, const std::string& path, int depth) const {
    if (depth > kMostNesting) fail(path.substr(0, 200), "is nested too deeply");
    auto known = rules().find(pattern);
    if (known == rules().end()) known = rules().find(pattern.substr(0, pattern.rfind('.') + 1) + "*");
    if (known != rules().end()) judge(value, known->second, path);
    if (value.is_array()) {
      for (std::size_t i = 0; i < value.size(); ++i)
        visit(value[i], pattern + "[]", path + "[" + std::to_string(i) + "]", depth + 1);
    } else if (value.is_object()) {
      for (const auto& [key, member] : value.items()) {
        const std::string name = (path.empty() ? "" : ".") + key;
        visit(member, pattern + name, path + name, depth + 1);
      }
    }
  }

  void judge(const json& value, const Node& node, const std::string& path) const {
    const Rule& rule = node.rule;
    if (rule.kind == Kind::object) expect(value.is_object(), value, path, "an object");
    if (rule.kind == Kind::array) expect(value.is_array(), value, path, "an array");
    if (rule.kind == Kind::text) expect(value.is_string(), value, path, "a text");
    if (rule.kind == Kind::flag) expect(value.is_boolean(), value, path, "true or false");
    if (rule.count > 0 && value.is_array() && value.size() != rule.count) {
      fail(path,
           "expected " + std::to_string(rule.count) + " numbers, found " + std::to_string(value.size()));
    }
    if (rule.kind == Kind::number || rule.kind == Kind::whole) check_number(value, rule, path);
    if (rule.kind == Kind::index) check_index(value, rule.array, path);
    for (const std::string& key : node.required) {
      if (!value.contains(key)) fail(path, "expected a member \"" + key + "\"");
    }
  }

  void check_number(const json& value, const Rule& rule, const std::string& path) const {
    const bool whole = rule.kind == Kind::whole;
    const std::string what = whole ? "a whole number" : "a number";
    expect(whole ? value.is_number_unsigned() : value.is_number(), value, path, what);
    const auto shown = [whole](double limit) {
      return whole ? std::to_string(static_cast<std::uint64_t>(limit)) : json(limit).dump();
    };
    expect(value.get<double>() >= rule.least && value.get<double>() <= rule.most, value, path,
           what + " from " + shown(rule.least) + " to " + shown(rule.most));
  }

  void check_index(const json& value, const std::string& array, const std::string& path) const {
    expect(value.is_number_unsigned(), value, path, "a whole number");
    const json::json_pointer pointer(array);
    const std::size_t count = document_.contains(pointer) ? document_.at(pointer).size() : 0;
    if (value.get<std::uint64_t>() < count) return;
    fail(path, "names " + array.substr(array.rfind('/') + 1) + "[" + value.dump() +
                   "], but the document has " + std::to_string(count) + " of them");
  }

  const json& document_;
  const std::string& file_;
};

/// A file of another kind gets a clearer answer than a syntax error.
void check_is_json(std::string_view text, const std::string& file) {
  if (text.empty()) throw Error(ErrorCode::bad_input, file + ": is no glTF file: it is empty");
  if (is_utf16(text)) throw Error(ErrorCode::bad_input, file + ": is UTF-16; save it as UTF-8");
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (start != std::string_view::npos && text[start] == '{') return;
  throw Error(ErrorCode::bad_input,
              file + ": is no glTF file: it begins neither with \"{\", as .gltf files do, " +
                  "nor with \"glTF\", as .glb files do; export or copy it again");
}

}  // namespace

json checked_gltf_json(std::string_view text, const std::string& file) {
  if (text.size() > kMostGltfJson) {
    throw Error(ErrorCode::resource_limit, file + ": has " + std::to_string(text.size()) +
                                               " bytes of JSON, at most " + std::to_string(kMostGltfJson) +
                                               " are accepted; store the buffers in a .bin or .glb file");
  }
  check_is_json(text, file);
  try {
    json document = json::parse(text.begin(), text.end());
    Checker(document, file).check();
    return document;
  } catch (const json::parse_error& error) {
    const LineColumn at = line_column(text, error.byte > 0 ? error.byte - 1 : 0);
    throw Error(ErrorCode::bad_input,
                file + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": invalid JSON");
  } catch (const json::exception&) {
    throw Error(ErrorCode::bad_input, file + ": the JSON holds a number too large to read");
  }
}

}  // namespace brume::scene
