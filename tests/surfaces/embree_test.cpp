#include "trace/embree.hpp"

#include <gtest/gtest.h>

namespace brume::trace {
namespace {

TEST(Embree, AMissingLibraryIsNamed) {
  const Result<Embree> missing = load_embree("libno-such-library.so.3");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.failure().code, ErrorCode::no_device);
  EXPECT_NE(missing.failure().message.find("libno-such-library.so.3"), std::string::npos);
  EXPECT_NE(missing.failure().message.find("install libembree3-3"), std::string::npos);
}

TEST(Embree, ALibraryWithoutItsFunctionsIsRefused) {
  const Result<Embree> other = load_embree("libm.so.6");
  ASSERT_FALSE(other);
  EXPECT_EQ(other.failure().code, ErrorCode::no_device);
  EXPECT_NE(other.failure().message.find("libm.so.6 has no rtc"), std::string::npos);
}

TEST(Embree, IsFoundOnce) {
  ASSERT_TRUE(find_embree());
  EXPECT_EQ(&embree(), &embree());
}

}  // namespace
}  // namespace brume::trace
