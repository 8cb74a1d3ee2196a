// What Godot calls: it registers the class BrumeMatch with its methods.
#include <cstdio>
#include <new>

#include "match.hpp"

namespace brume::godot {
namespace {

/// A method of the class: its name, the number of its arguments, and what it does.
struct Method {
  const char* name;
  int arguments;
  godot_variant (*call)(Match&, const Arguments&);
};

/// A method that returns whether it succeeded.
template <typename Call>
constexpr auto done(Call) {
  return +[](Match& match, const Arguments& given) {
    Call{}(match, given);
    return value(true);
  };
}

std::string hex(std::uint64_t number) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(number));
  return text;
}

using A = const Arguments&;

constexpr Method kMethods[] = {
    {"add_mask", 3, [](Match& m, A a) { return value(m.add_mask(a.index(0), a.index(1), a.bytes(2))); }},
    {"level_from_boxes", 2, done([](Match& m, A a) { m.level_from_boxes(a.boxes(0), a.number(1)); })},
    {"level_from_triangles", 4, done([](Match& m, A a) {
       m.level_from_triangles(a.points(0), a.integers(1), a.bytes(2), a.number(3));
     })},
    {"layout", 0, [](Match& m, A) { return value(m.layout()); }},
    {"throw_smoke", 3, done([](Match& m, A a) { m.throw_smoke(a.point(0), a.point(1), a.number(2)); })},
    {"shoot", 3, done([](Match& m, A a) { m.shoot(a.point(0), a.point(1), a.number(2)); })},
    {"shoot_mask", 5,
     done([](Match& m, A a) { m.shoot_mask(a.point(0), a.point(1), a.number(2), a.index(3), a.number(4)); })},
    {"blast", 2, done([](Match& m, A a) { m.blast(a.point(0), a.number(1)); })},
    {"move", 2, done([](Match& m, A a) { m.move(a.index(0), a.point(1)); })},
    {"edit", 2, done([](Match& m, A a) { m.edit(a.box(0), a.boolean(1)); })},
    {"append", 3, done([](Match& m, A a) { m.append(a.index(0), a.index(1), a.integers(2)); })},
    {"step", 0, done([](Match& m, A) { m.step(); })},
    {"advance_to", 1, done([](Match& m, A a) { m.advance_to(a.index(0)); })},
    {"forget_before", 1, done([](Match& m, A a) { m.forget_before(a.index(0)); })},
    {"tick", 0, [](Match& m, A) { return value(std::int64_t{m.tick()}); }},
    {"hash", 0, [](Match& m, A) { return value(hex(m.hash())); }},
    {"depths", 1, [](Match& m, A a) { return value(m.depths(a.points(0))); }},
    {"drawn_depths", 1, [](Match& m, A a) { return value(m.drawn_depths(a.points(0))); }},
    {"sees", 3, [](Match& m, A a) { return value(m.sees(a.point(0), a.point(1), a.number(2))); }},
    {"make_textures", 2, done([](Match& m, A a) { m.make_textures(a.index(0), a.boolean(1)); })},
    {"update_textures", 4,
     done([](Match& m, A a) { m.update_textures(a.number(0), a.points(1), a.bytes(2), a.number(3)); })},
    {"texture_layout", 1, [](Match& m, A a) { return value(m.textures().layout(a.index(0))); }},
    {"changed_layers", 1, [](Match& m, A a) { return value(m.textures().changed_layers(a.index(0))); }},
    {"layer", 2, [](Match& m, A a) { return value(m.textures().layer(a.index(0), a.index(1))); }},
    {"constants", 0, [](Match& m, A) { return value(m.textures().constants()); }},
};

/// Calls a method; an error is shown, and null returned.
godot_variant call(godot_object*, void* method_data, void* user_data, int count, godot_variant** values) {
  const Method& method = *static_cast<const Method*>(method_data);
  std::string error;
  try {
    if (!user_data) throw std::bad_alloc();
    if (count != method.arguments)
      throw std::invalid_argument(std::to_string(method.arguments) + " arguments are expected, not " +
                                  std::to_string(count));
    return method.call(*static_cast<Match*>(user_data), Arguments(values, count));
  } catch (const std::exception& caught) {
    error = caught.what();
  }
  show_error("BrumeMatch." + std::string(method.name) + ": " + error);
  return nothing();
}

void* create(godot_object*, void*) {
  try {
    return new Match;
  } catch (const std::exception& error) {
    show_error(std::string("BrumeMatch: ") + error.what());
    return nullptr;
  }
}

void destroy(godot_object*, void*, void* match) {
  delete static_cast<Match*>(match);
}

const godot_gdnative_ext_nativescript_api_struct* scripts = nullptr;

}  // namespace
}  // namespace brume::godot

#define EXPORTED extern "C" __attribute__((visibility("default")))

EXPORTED void godot_gdnative_init(godot_gdnative_init_options* options) {
  using namespace brume::godot;
  api = options->api_struct;
  for (unsigned i = 0; i < api->num_extensions; ++i)
    if (api->extensions[i]->type == GDNATIVE_EXT_NATIVESCRIPT)
      scripts = reinterpret_cast<const godot_gdnative_ext_nativescript_api_struct*>(api->extensions[i]);
}

EXPORTED void godot_gdnative_terminate(godot_gdnative_terminate_options*) {
  brume::godot::api = nullptr;
}

EXPORTED void godot_nativescript_init(void* library) {
  using namespace brume::godot;
  scripts->godot_nativescript_register_class(library, "BrumeMatch", "Reference", {create, nullptr, nullptr},
                                             {destroy, nullptr, nullptr});
  for (const Method& method : kMethods)
    scripts->godot_nativescript_register_method(library, "BrumeMatch", method.name,
                                                {GODOT_METHOD_RPC_MODE_DISABLED},
                                                {call, const_cast<Method*>(&method), nullptr});
}
