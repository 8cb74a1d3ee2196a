// Whatever the child process does, its parent goes on.
#include <gtest/gtest.h>

#include <filesystem>

#include "grids/files/grid_files.hpp"
#include "tests/grids/child.hpp"
#include "tests/grids/sample_grids.hpp"
#include "tests/log_lines.hpp"

namespace brume::grids {
namespace {

namespace fs = std::filesystem;

class Worker : public testing::Test {
 protected:
  // Reads a file with a script in place of brume-vdb.
  Failure failure_with(const std::string& script) const {
    const ChildProgram program(executable(script));
    const auto file = load_grid_file(folder_.path() / folder_.write("a.vdb", "x"));
    return file ? Failure{} : file.failure();
  }
  Failure saving_with(const std::string& script) const {
    const ChildProgram program(executable(script));
    const auto saved = save_grid_file(folder_.path() / "b.vdb", {{smoke_grid("density", 20)}, {}});
    EXPECT_FALSE(fs::exists(folder_.path() / "b.vdb"));
    return saved ? Failure{} : saved.failure();
  }
  std::string executable(const std::string& script) const {
    const fs::path path = folder_.path() / folder_.write("child", "#!/bin/sh\n" + script + "\n");
    fs::permissions(path, fs::perms::owner_all);
    return path.string();
  }
  static void expect(const Failure& failure, ErrorCode code, const std::string& part) {
    EXPECT_EQ(failure.code, code) << failure.message;
    EXPECT_NE(failure.message.find(part), std::string::npos) << failure.message;
    EXPECT_EQ(failure.message.find('\n'), std::string::npos);
  }

  WorkFolder folder_;
};

TEST_F(Worker, ReportsACrash) {
  expect(failure_with("kill -SEGV $$"), ErrorCode::bad_input,
         "a.vdb: OpenVDB's reader crashed on it (signal 11); the file is damaged");
  expect(saving_with("kill -SEGV $$"), ErrorCode::bad_input, "signal 11");
}

TEST_F(Worker, ReportsLimits) {
  expect(failure_with("kill -KILL $$"), ErrorCode::resource_limit, "a.vdb: brume-vdb was killed");
  expect(failure_with("kill -XCPU $$"), ErrorCode::resource_limit, "processor time");
  expect(failure_with("echo 'brume-vdb: too large' >&2; exit 4"), ErrorCode::resource_limit,
         "a.vdb: too large");
}

TEST_F(Worker, RefusesWhatIsNoAnswer) {
  expect(failure_with("exit 0"), ErrorCode::bad_input, "a.vdb: not a .brv file");
  expect(failure_with("echo nonsense"), ErrorCode::bad_input, "not a .brv file");
  expect(failure_with("exit 9"), ErrorCode::internal, "exit code 9");
  expect(failure_with("echo oops >&2; exit 1"), ErrorCode::internal, "a.vdb: oops");
  expect(saving_with("exit 3"), ErrorCode::bad_input, "exit code 3");
}

TEST_F(Worker, RefusesMoreThanTheLimits) {
  const ChildProgram program(executable("exec yes"));
  const auto file = load_grid_file(folder_.path() / folder_.write("a.vdb", "x"), {.bytes = 1 << 20});
  ASSERT_FALSE(file);
  expect(file.failure(), ErrorCode::resource_limit, "more than the limits allow");
}

TEST_F(Worker, NamesTheMissingProgram) {
  const ChildProgram program("/none/brume-vdb");
  const auto file = load_grid_file(folder_.path() / folder_.write("a.vdb", "x"));
  ASSERT_FALSE(file);
  expect(file.failure(), ErrorCode::no_device, "a.vdb: requires the program brume-vdb");
}

TEST_F(Worker, NamesMissingAndForeignFiles) {
  const ChildProgram program;
  const auto code = [&](const char* name) { return load_grid_file(folder_.path() / name).failure(); };
  expect(code("none.vdb"), ErrorCode::bad_input, "none.vdb: cannot open");
  folder_.write("text.vdb", "hello");
  folder_.write("text.nvdb", "hello, this is text of more than sixteen bytes");
  folder_.write("empty.nvdb", "");
  folder_.write("text.brv", "hello");
  expect(code("text.vdb"), ErrorCode::bad_input, "text.vdb: ");
  expect(code("text.nvdb"), ErrorCode::bad_input, "text.nvdb: not a .nvdb file");
  expect(code("empty.nvdb"), ErrorCode::bad_input, "empty.nvdb: not a .nvdb file");
  expect(code("text.brv"), ErrorCode::bad_input, "text.brv: not a .brv file");
  expect(code("text.txt"), ErrorCode::bad_input, "unknown file suffix");
}

TEST_F(Worker, PassesWarningsOn) {
  const LogLines log;
  failure_with("echo 'brume-vdb: warning: grid \"a\" is skipped' >&2; exit 0");
  EXPECT_EQ(log.lines.size(), 1u);
  EXPECT_TRUE(log.has("a.vdb: grid \"a\" is skipped"));
}

}  // namespace
}  // namespace brume::grids
