// What the systems do differently, through the interface that hides it. tests/windows runs these on Windows,
// too.
#include <gtest/gtest.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include "core/file.hpp"
#include "core/key.hpp"
#include "core/numbered_files.hpp"
#include "core/platform/child_process.hpp"
#include "core/platform/library.hpp"
#include "core/platform/machine.hpp"
#include "core/platform/process.hpp"
#include "core/utf8.hpp"

namespace brume {
namespace {

namespace fs = std::filesystem;

/// Letters of three scripts, of which no single-byte code page has all.
const std::string kName = "R\xc3\xa4ume \xce\xa9 \xe7\x85\x99";

class Platform : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / to_path(kName + std::to_string(platform::process_id()));
    fs::remove_all(folder_);
    fs::create_directory(folder_);
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
};

TEST_F(Platform, PathsAreUtf8) {
  const fs::path file = folder_ / to_path(kName + ".txt");
  ASSERT_TRUE(write_file_atomic(file, std::string("smoke\n")));
  EXPECT_EQ(*read_text_file(file), "smoke\n") << "line breaks stay as they are";
  EXPECT_EQ(file.filename().string(), kName + ".txt");
  const auto missing = read_text_file(folder_ / to_path(kName + "2"));
  ASSERT_FALSE(missing);
  EXPECT_NE(
      missing.failure().message.find(kName + "2: cannot open: No such file or directory; check the path"),
      std::string::npos)
      << missing.failure().message;
  std::ifstream stream(file);
  EXPECT_TRUE(stream) << "of the library of C++";
}

TEST_F(Platform, FilesAreReplacedAtOnce) {
  const fs::path file = folder_ / "a";
  ASSERT_TRUE(write_file_atomic(file, std::string("old")));
  {
    auto half = AtomicFile::open(file);
    ASSERT_TRUE(half);
    ASSERT_TRUE(half->write(std::as_bytes(std::span("ne", 2))));
    EXPECT_EQ(*read_text_file(file), "old");
  }
  EXPECT_EQ(file_count(), 1u) << "what is not committed leaves nothing";
  for (const char* text : {"new", "newer"}) {
    ASSERT_TRUE(write_file_atomic(file, std::string(text)));
    EXPECT_EQ(*read_text_file(file), text);
  }
  EXPECT_EQ(file_count(), 1u);
}

TEST_F(Platform, PartsOfEndedProcessesAreRemoved) {
  // No process has the largest number.
  const fs::path stale = folder_ / ".a.brume-part-2147483647-0";
  std::ofstream(stale) << "half";
  platform::remove_if_stale(stale);
  EXPECT_FALSE(fs::exists(stale));
  auto ours = AtomicFile::open(folder_ / "b", AtomicFile::Naming::named);
  ASSERT_TRUE(ours);
  for (const auto& entry : fs::directory_iterator(folder_)) platform::remove_if_stale(entry.path());
  ASSERT_TRUE(ours->write(std::as_bytes(std::span("b", 1))));
  EXPECT_TRUE(ours->commit()) << "a part whose writer lives stays";
  EXPECT_EQ(*read_text_file(folder_ / "b"), "b");
}

TEST_F(Platform, RefusesFoldersAndWhatIsReadOnly) {
  const auto folder = write_file_atomic(folder_, std::string("x"));
  ASSERT_FALSE(folder);
  EXPECT_NE(folder.failure().message.find("is a folder; name a file inside it"), std::string::npos);
  const auto read = read_text_file(folder_);
  ASSERT_FALSE(read);
  EXPECT_NE(read.failure().message.find("not a regular file"), std::string::npos) << read.failure().message;
  const auto nowhere = write_file_atomic(folder_ / "none" / "x", std::string("x"));
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.failure().message.find("does not exist; create it first"), std::string::npos);
}

// Linux has no such names.
#if defined(_WIN32)
TEST_F(Platform, RefusesNamesThatNoFileCanHave) {
  for (const auto& [name, why] : {std::pair{"CON.png", "the name of a device"},
                                  {"nul", "the name of a device"},
                                  {"Aux .tar.gz", "the name of a device"},
                                  {"com1.png", "the name of a device"},
                                  {"LPT9", "the name of a device"},
                                  {"ab:c.png", "a ':' in its name"},
                                  {"a?.png", "a '?' in its name"},
                                  {"a\x01.png", "a control character in its name"}}) {
    const auto file = AtomicFile::open(folder_ / to_path(name));
    ASSERT_FALSE(file) << name;
    EXPECT_EQ(file.failure().code, ErrorCode::bad_input);
    EXPECT_NE(file.failure().message.find(name + (": has " + std::string(why))), std::string::npos)
        << file.failure().message;
  }
  EXPECT_EQ(file_count(), 0u);
  for (const char* name : {"console.png", "com.png", "com0", "lpt10.png", "nul_1", "a b.png"})
    EXPECT_TRUE(AtomicFile::open(folder_ / to_path(name))) << name;
}
#endif

TEST_F(Platform, FilesAreIdentified) {
  ASSERT_TRUE(write_file_atomic(folder_ / "a", std::string("abc")));
  ASSERT_TRUE(write_file_atomic(folder_ / "b", std::string("abc")));
  const auto a = platform::info_of(folder_ / "a"), same = platform::info_of(folder_ / "." / "a"),
             b = platform::info_of(folder_ / "b"), folder = platform::info_of(folder_);
  ASSERT_TRUE(a && same && b && folder);
  EXPECT_EQ(a->size, 3u);
  EXPECT_TRUE(a->is_regular && !a->is_folder && folder->is_folder && !folder->is_regular);
  EXPECT_EQ(a->file, same->file);
  EXPECT_EQ(a->device, same->device);
  EXPECT_NE(a->file, b->file);
  EXPECT_FALSE(platform::info_of(folder_ / "c"));
  EXPECT_EQ(errno, ENOENT);
}

TEST_F(Platform, NumberedFilesAreFound) {
  for (const char* number : {"007", "012"})
    ASSERT_TRUE(write_file_atomic(folder_ / to_path(kName + number + ".png"), std::string()));
  EXPECT_EQ(numbered_files(folder_ / to_path(kName + "%03d.png")).size(), 2u);
}

TEST(Process, KnowsItself) {
  EXPECT_TRUE(platform::is_running(platform::process_id()));
  EXPECT_FALSE(platform::is_running(2147483647));
  EXPECT_TRUE(fs::exists(platform::program_file()));
  KeyHasher hasher;
  EXPECT_TRUE(hasher.add_file(platform::program_image(), [] {}));
  EXPECT_EQ(platform::environment("BRUME_NO_SUCH_VARIABLE"), "");
  EXPECT_NE(platform::environment("PATH"), "");
  EXPECT_GT(platform::memory_use().resident, 0u);
  EXPECT_FALSE(platform::processor_name().empty());
  EXPECT_EQ(platform::load_library("libbrume-none.so.0"), nullptr);
}

/// What a child does: not a test.
TEST(Child, DISABLED_Echo) {
  std::string line;
  std::getline(std::cin, line);
  std::cout << "[" << line << "]" << std::endl;
  std::cerr << kName << "\nlast words\n";
  std::_Exit(line == "fail" ? 7 : 0);
}

/// The arguments that start it.
std::vector<std::string> echo_arguments() {
  return {platform::program_file().string(), "--gtest_filter=Child.DISABLED_Echo",
          "--gtest_also_run_disabled_tests", "a \"quoted\\\" word\\"};
}

std::string all_of(int descriptor) {
  std::string text;
  std::array<std::byte, 100> bytes{};
  for (;;) {
    while (!platform::wait_readable(descriptor, 100)) {
    }
    const std::ptrdiff_t got = platform::read_some(descriptor, bytes);
    if (got <= 0) return text;
    text.append(reinterpret_cast<const char*>(bytes.data()), static_cast<std::size_t>(got));
  }
}

TEST(Child, ReadsAndWritesStreams) {
  for (const bool fails : {false, true}) {
    auto input = platform::make_child_input(), output = platform::make_child_output();
    ASSERT_TRUE(input && output);
    platform::ChildProcess child;
    ASSERT_EQ(child.start(echo_arguments(), {.input = input->childs.get(), .output = output->childs.get()}),
              0);
    input->childs.close();
    output->childs.close();
    const std::string line = fails ? "fail\n" : kName + "\n";
    EXPECT_EQ(platform::send_some(input->ours.get(), std::as_bytes(std::span(line))),
              static_cast<std::ptrdiff_t>(line.size()));
    const std::string text = all_of(output->ours.get());
    EXPECT_NE(text.find("[" + line.substr(0, line.size() - 1) + "]"), std::string::npos) << text;
    const platform::ChildEnd end = child.wait();
    EXPECT_EQ(end.cause, platform::ChildEnd::Cause::exited);
    EXPECT_EQ(end.code, fails ? 7 : 0);
    EXPECT_EQ(end.is_success(), !fails);
    EXPECT_EQ(platform::last_line(child.messages()), "last words");
    EXPECT_NE(child.messages().find(kName), std::string::npos);
  }
}

TEST(Child, IsKilledAndDoesNotKillTheWriter) {
  auto input = platform::make_child_input();
  ASSERT_TRUE(input);
  platform::ChildProcess child;
  ASSERT_EQ(child.start(echo_arguments(), {.input = input->childs.get()}), 0);
  input->childs.close();
  child.kill();
  EXPECT_EQ(child.wait().cause, platform::ChildEnd::Cause::killed);
  EXPECT_FALSE(child.running());
  const std::vector<std::byte> bytes(1 << 20);
  EXPECT_LT(platform::send_some(input->ours.get(), bytes), 0);
}

TEST(Child, MissingProgramsAreReported) {
  platform::ChildProcess child;
  EXPECT_EQ(child.start({"brume-no-such-program"}, {}), ENOENT);
  EXPECT_EQ(child.start({(fs::temp_directory_path() / "brume-no-such-program").string()}, {}), ENOENT);
  EXPECT_FALSE(child.running());
}

}  // namespace
}  // namespace brume
