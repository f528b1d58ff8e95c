// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <string>

#include "osteon/base/error.h"
#include "osteon/base/types.h"

namespace osteon::test {

inline testing::AssertionResult near(const Vec3f& a, const Vec3f& b, float tolerance) {
  const float distance = (a - b).norm();
  if (distance <= tolerance) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "(" << a.transpose() << ") and (" << b.transpose() << ") are " << distance << " apart, more than "
                                     << tolerance;
}

// The text of the Error that `action` throws; "" with a test failure if it throws none.
template <class Action>
std::string error_of(Action&& action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  ADD_FAILURE() << "expected an Error";
  return "";
}

// A folder of the running test alone, removed afterwards.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::temp_directory_path() / fmt::format("osteon.{}.{}.{}", info->test_suite_name(), info->name(), ::getpid());
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace osteon::test

#define EXPECT_VEC3_NEAR(a, b, tolerance) EXPECT_TRUE(::osteon::test::near(a, b, tolerance))
