
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <string>

#include "core/file.hpp"

#include "tests/work_folder.hpp"

namespace brume {
namespace {

namespace fs = std::filesystem;

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

class AtomicFileTest : public testing::TestWithParam<AtomicFile::Naming> {
 protected:
  std::size_t files() const { return work_folder_.files().size(); }
  void write(const fs::path& path, const std::string& text) const {
    auto file = AtomicFile::open(path, GetParam());
    ASSERT_TRUE(file) << file.failure().message;
    ASSERT_TRUE(file->write(bytes_of(text)));
    const auto done = file->commit();
    ASSERT_TRUE(done) << done.failure().message;
  }
  unsigned mode(const fs::path& path) const {
    struct stat info {};
    EXPECT_EQ(::stat(path.c_str(), &info), 0);
    return info.st_mode & 07777u;
  }
  const cli::WorkFolder work_folder_;
  const fs::path folder_ = work_folder_.path();
};

INSTANTIATE_TEST_SUITE_P(BothKinds, AtomicFileTest,
                         testing::Values(AtomicFile::Naming::nameless_if_possible,
                                         AtomicFile::Naming::named));

TEST_P(AtomicFileTest, CreatesAndReplaces) {
  for (const char* text : {"old", "a longer new one"}) {
    write(folder_ / "a", text);
    EXPECT_EQ(*read_text_file(folder_ / "a"), text);
    EXPECT_EQ(files(), 1u);
  }
}

TEST_P(AtomicFileTest, LeavesNothingWithoutCommit) {
  {
    auto file = AtomicFile::open(folder_ / "a", GetParam());
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(bytes_of("xyz")));
    const AtomicFile moved = std::move(*file);
    EXPECT_FALSE(fs::exists(folder_ / "a"));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_P(AtomicFileTest, FollowsLinksAndKeepsPermissions) {
  fs::create_directory(folder_ / "below");
  write(folder_ / "below" / "file", "old");
  ASSERT_EQ(::chmod((folder_ / "below" / "file").c_str(), 0640), 0);
  fs::create_symlink("below/file", folder_ / "one");
  fs::create_symlink("one", folder_ / "two");
  write(folder_ / "two", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "two"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "one"));
  EXPECT_EQ(*read_text_file(folder_ / "below" / "file"), "new");
  EXPECT_EQ(mode(folder_ / "below" / "file"), 0640u);
  // A link to nothing creates what it names.
  fs::create_symlink("below/fresh", folder_ / "three");
  write(folder_ / "three", "fresh");
  EXPECT_EQ(*read_text_file(folder_ / "below" / "fresh"), "fresh");
}

TEST_P(AtomicFileTest, FreshFilesHaveTheUsualPermissions) {
  const mode_t old = ::umask(027);
  write(folder_ / "a", "x");
  ::umask(old);
  EXPECT_EQ(mode(folder_ / "a"), 0640u);
}

TEST_P(AtomicFileTest, RefusesWhatIsNoFileAndWhatIsReadOnly) {
  const auto refused = [&](const fs::path& path, const std::string& part) {
    const auto file = AtomicFile::open(path, GetParam());
    ASSERT_FALSE(file) << path;
    EXPECT_EQ(file.failure().code, ErrorCode::bad_input);
    EXPECT_NE(file.failure().message.find(part), std::string::npos) << file.failure().message;
  };
  fs::create_symlink("loop", folder_ / "loop");
  refused(folder_ / "loop", "follow the link");
  refused(folder_, "folder");
  refused("/dev/null", "regular file");
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  refused(folder_ / "pipe", "regular file");
  if (::geteuid() == 0) return;  // root may write any file
  write(folder_ / "a", "x");
  ASSERT_EQ(::chmod((folder_ / "a").c_str(), 0400), 0);
  refused(folder_ / "a", "permissions");
}

// A child writes half a file, reports that, and waits to be killed.
class Writer {
 public:
  Writer(const fs::path& path, AtomicFile::Naming naming) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) return;
    process_ = ::fork();
    if (process_ == 0) {
      auto file = AtomicFile::open(path, naming);
      const char wrote = file && file->write(bytes_of("half")) ? 'y' : 'n';
      (void)!::write(ends[1], &wrote, 1);
      for (;;) ::pause();
    }
    (void)!::read(ends[0], &wrote_, 1);
    for (const int end : ends) ::close(end);
  }
  Writer(const Writer&) = delete;
  ~Writer() { kill(); }
  bool wrote() const { return wrote_ == 'y'; }
  void kill() {
    if (process_ <= 0) return;
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
    process_ = -1;
  }

 private:
  pid_t process_ = -1;
  char wrote_ = 0;
};

// Each visitor is a process of its own, since a process cleans a folder once.
void visit(const fs::path& path) {
  const pid_t process = ::fork();
  if (process == 0) ::_exit(AtomicFile::open(path) ? 0 : 1);
  int status = 1;
  ::waitpid(process, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST_P(AtomicFileTest, AKilledWriterLeavesNothingForTheNextOne) {
  Writer alive(folder_ / "a", GetParam());
  ASSERT_TRUE(alive.wrote());
  {
    Writer killed(folder_ / "a", GetParam());
    ASSERT_TRUE(killed.wrote());
  }
  const bool named = GetParam() == AtomicFile::Naming::named;
  EXPECT_EQ(files(), named ? 2u : 0u);
  // Names that are not ours stay, whatever they resemble.
  for (const char* name : {".a.brume-part-1", ".a.brume-part-1-x", "a.brume-part-1-2", ".brume-part-1-2"})
    ASSERT_TRUE(write_file_atomic(folder_ / name, std::string("mine")));
  visit(folder_ / "b");
  EXPECT_EQ(files(), 4u + (named ? 1u : 0u)) << "that of the writer that lives";
  alive.kill();
  visit(folder_ / "b");
  EXPECT_EQ(files(), 4u);
}

}  // namespace
}  // namespace brume
