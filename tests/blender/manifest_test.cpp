// The package is a valid add-on for Blender 3.4 and extension for 4.2; does not require Blender.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>

#include "core/file.hpp"
#include "scene/files/toml_table.hpp"
#include "tests/cli/run_program.hpp"

namespace brume::blender {
namespace {

const std::filesystem::path kAddon = BRUME_SOURCE_DIR "/integrations/blender/brume_blender";

std::string manifest_text() {
  return read_text_file(kAddon / "blender_manifest.toml").value_or_throw();
}

// Fields and formats of "Blender 4.2 manual, Extensions: getting started".
TEST(BlenderPackage, ManifestHasTheFieldsThatBlender42Requires) {
  const std::string text = manifest_text();
  const auto parsed = scene::parse_toml(text, "blender_manifest.toml");
  ASSERT_TRUE(parsed) << parsed.failure().message;
  const toml::table& manifest = *parsed;
  const auto field = [&](const char* name) { return manifest[name].value_or(std::string()); };
  const std::regex version("[0-9]+\\.[0-9]+\\.[0-9]+");
  EXPECT_EQ(field("schema_version"), "1.0.0");
  EXPECT_EQ(field("id"), kAddon.filename().string());
  EXPECT_NE(field("id"), "brume") << "the Python module, which Blender may find first";
  EXPECT_TRUE(std::regex_match(field("version"), version));
  EXPECT_NE(field("name"), "");
  EXPECT_NE(field("maintainer"), "");
  EXPECT_EQ(field("type"), "add-on");
  EXPECT_EQ(field("blender_version_min"), "4.2.0");
  EXPECT_LE(field("tagline").size(), 64u);
  EXPECT_TRUE(std::isalnum(static_cast<unsigned char>(field("tagline").back())));
  const toml::array* licenses = manifest["license"].as_array();
  ASSERT_NE(licenses, nullptr);
  ASSERT_FALSE(licenses->empty());
  for (const toml::node& license : *licenses)
    EXPECT_EQ(license.value_or(std::string()).rfind("SPDX:", 0), 0u);
  const toml::table* permissions = manifest["permissions"].as_table();
  ASSERT_NE(permissions, nullptr);
  for (const auto& [name, why] : *permissions) {
    EXPECT_TRUE((std::set<std::string>{"files", "network", "clipboard", "camera", "microphone"}.contains(
        std::string(name.str()))));
    EXPECT_LE(why.value_or(std::string(99, ' ')).size(), 64u);
    EXPECT_NE(why.value_or(std::string(".")).back(), '.');
  }
}

TEST(BlenderPackage, ManifestAndCodeHaveTheSameVersion) {
  std::smatch in_manifest, in_code;
  const std::string manifest = manifest_text();
  const std::string code = read_text_file(kAddon / "__init__.py").value_or_throw();
  ASSERT_TRUE(
      std::regex_search(manifest, in_manifest, std::regex("\nversion = \"(\\d+)\\.(\\d+)\\.(\\d+)\"")));
  ASSERT_TRUE(std::regex_search(code, in_code, std::regex("\"version\": \\((\\d+), (\\d+), (\\d+)\\)")));
  for (std::size_t part = 1; part <= 3; ++part) EXPECT_EQ(in_manifest[part], in_code[part]);
}

// One folder with the name of the package, as 3.4 requires, with the manifest in it for 4.2.
TEST(BlenderPackage, ZipContainsOnlyTheSources) {
  const cli::WorkFolder folder;
  const std::string zip = (folder.path() / "brume.zip").string(), list = (folder.path() / "list").string();
  std::ostringstream command;
  command << "'" BRUME_SOURCE_DIR "/script/blender-addon' '" << zip << "' > /dev/null && cmake -E tar tf '"
          << zip << "' > '" << list << "'";
  ASSERT_EQ(std::system(command.str().c_str()), 0);
  std::set<std::string> packed, wanted{"brume_blender/blender_manifest.toml"};
  std::istringstream lines(read_text_file(list).value_or_throw());
  for (std::string line; std::getline(lines, line);) packed.insert(line);
  for (const auto& entry : std::filesystem::directory_iterator(kAddon)) {
    if (entry.path().extension() == ".py") wanted.insert("brume_blender/" + entry.path().filename().string());
  }
  EXPECT_EQ(packed, wanted);
  EXPECT_TRUE(packed.contains("brume_blender/__init__.py"));
}

}  // namespace
}  // namespace brume::blender
