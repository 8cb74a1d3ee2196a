#include "core/numbered_files.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/work_folder.hpp"

namespace brume {
namespace {

TEST(NumberedName, KnowsTheFormsOfPrograms) {
  for (const char* mark : {"%d", "%04d", "####", "#", "$F", "$F4", "<frame>", "<frame04>", "<f4>", "<F>"}) {
    const auto name = numbered_name(std::string("smoke.") + mark + ".vdb");
    ASSERT_TRUE(name) << mark;
    EXPECT_EQ(name->before, "smoke.") << mark;
    EXPECT_EQ(name->after, ".vdb") << mark;
  }
  const auto seventh = [](const std::string& name) { return numbered_name(name)->with(7); };
  for (const char* form : {"a%04d.x", "a####.x", "a$F4.x", "a<frame04>.x"})
    EXPECT_EQ(seventh(form), "a0007.x") << form;
  for (const char* form : {"a%d.x", "a#.x", "a$F.x", "a<frame>.x", "a%0d.x"})
    EXPECT_EQ(seventh(form), "a7.x");
  EXPECT_EQ(numbered_name("%02d")->with(123), "123");
  EXPECT_EQ(seventh("%0999999999999999999999d").size(), 1u);
  EXPECT_EQ(seventh("%099d").size(), 16u);
  for (const char* plain :
       {"smoke.vdb", "100%.vdb", "%s.vdb", "$HOME.vdb", "<UDIM>.vdb", "<frame.vdb", "a%5", "$", "<"})
    EXPECT_FALSE(numbered_name(plain)) << plain;
}

class NumberedFilesTest : public testing::Test {
 protected:
  void add(const std::string& name) { std::ofstream(folder_.path() / name) << name; }
  std::map<std::int64_t, std::string> found(const std::string& name) {
    std::map<std::int64_t, std::string> names;
    for (const auto& [number, file] : numbered_files(folder_.path() / name))
      names[number] = file.filename().string();
    return names;
  }

  cli::WorkFolder folder_;
};

TEST_F(NumberedFilesTest, FindsNumbersOfAnyWidthWhereverTheyBegin) {
  for (const char* name :
       {"f_0998.vdb", "f_1001.vdb", "f_12.vdb", "f_-3.vdb", "f_.vdb", "f_7x.vdb", "f_8.nvdb", "g_5.vdb"})
    add(name);
  const std::map<std::int64_t, std::string> expected{
      {-3, "f_-3.vdb"}, {12, "f_12.vdb"}, {998, "f_0998.vdb"}, {1001, "f_1001.vdb"}};
  for (const char* form : {"f_%04d.vdb", "f_####.vdb", "f_$F4.vdb", "f_<frame>.vdb"})
    EXPECT_EQ(found(form), expected);
}

TEST_F(NumberedFilesTest, OfTwoFilesOfOneNumberTheOneWithMoreDigitsCounts) {
  add("f_2.vdb");
  add("f_0002.vdb");
  EXPECT_EQ(found("f_%d.vdb"), (std::map<std::int64_t, std::string>{{2, "f_0002.vdb"}}));
}

TEST_F(NumberedFilesTest, AFileOfTheVeryNameIsNoSequence) {
  add("take#2.vdb");
  add("take12.vdb");
  EXPECT_EQ(found("take#2.vdb"), (std::map<std::int64_t, std::string>{{0, "take#2.vdb"}}));
  EXPECT_EQ(found("none.vdb"), (std::map<std::int64_t, std::string>{{0, "none.vdb"}}));
  EXPECT_TRUE(found("none_%d.vdb").empty());
}

}  // namespace
}  // namespace brume
