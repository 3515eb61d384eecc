#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace tartan_calib::test_support {

/// Folder of recorded data that is not part of the repository: $TARTAN_CALIB_TEST_DATA, else ../shared/data beside the
/// checkout. Tests that need a set skip, naming it, where it is absent.
inline std::filesystem::path testData(const std::string& set) {
  const char* folder = std::getenv("TARTAN_CALIB_TEST_DATA");
  const std::filesystem::path root = folder != nullptr
                                         ? std::filesystem::path(folder)
                                         : std::filesystem::path(TARTAN_CALIB_SOURCE_DIR) / ".." / "shared" / "data";
  return root / set;
}

}  // namespace tartan_calib::test_support

/// First statement of a test that reads the recorded data set `set`.
#define TARTAN_CALIB_REQUIRE_TEST_DATA(set)                                              \
  if (!std::filesystem::exists(tartan_calib::test_support::testData(set))) {             \
    GTEST_SKIP() << "no recorded data at " << tartan_calib::test_support::testData(set); \
  }
