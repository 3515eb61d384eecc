#include "tartan_calib/io/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "support/expect_message.h"
#include "support/temporary_folder.h"
#include "tartan_calib/error.h"

namespace tartan_calib::io {
namespace {

namespace fs = std::filesystem;
using test_support::expectMessage;
using test_support::TemporaryFolder;

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::ptrdiff_t numFiles(const TemporaryFolder& folder) {
  return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
}

TEST(AtomicFile, AppearsOnlyWithItsWholeContent) {
  const TemporaryFolder folder;
  const std::string path = folder.file("result.txt");
  AtomicFile file(path);
  file.write(std::string(300000, 'a'));
  EXPECT_FALSE(fs::exists(path));
  file.write("end");
  file.commit();
  EXPECT_EQ(contentOf(path), std::string(300000, 'a') + "end");
  EXPECT_EQ(numFiles(folder), 1);
}

TEST(AtomicFile, WithoutCommitLeavesTheOldFileAndNothingElse) {
  const TemporaryFolder folder;
  const std::string path = folder.file("result.txt");
  writeFile(path, "old");
  {
    AtomicFile file(path);
    file.write(std::string(300000, 'a'));
  }
  EXPECT_EQ(contentOf(path), "old");
  EXPECT_EQ(numFiles(folder), 1);
}

TEST(AtomicFile, ReplacesAnOlderFile) {
  const TemporaryFolder folder;
  const std::string path = folder.file("result.txt");
  writeFile(path, "a long old text");
  writeFile(path, "new");
  EXPECT_EQ(contentOf(path), "new");
}

TEST(AtomicFile, FollowsALinkToTheFileItNames) {
  const TemporaryFolder folder;
  writeFile(folder.file("real.txt"), "old");
  fs::create_symlink(folder.file("real.txt"), folder.file("link.txt"));
  writeFile(folder.file("link.txt"), "new");
  EXPECT_TRUE(fs::is_symlink(folder.file("link.txt")));
  EXPECT_EQ(contentOf(folder.file("real.txt")), "new");
}

TEST(AtomicFile, HasTheUsersUsualRights) {
  const TemporaryFolder folder;
  const mode_t old_mask = umask(027);
  writeFile(folder.file("result.txt"), "x");
  umask(old_mask);
  EXPECT_EQ(static_cast<int>(fs::status(folder.file("result.txt")).permissions()), 0640);
}

TEST(AtomicFileSet, LeavesAllFilesAsTheyWereWhereOneCannotBeCompleted) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full on this system";
  }
  const TemporaryFolder folder;
  writeFile(folder.file("a.txt"), "old");
  {
    AtomicFileSet files;
    files.add(folder.file("a.txt")).write("new");
    files.add("/dev/full").write("text");
    files.add(folder.file("b.txt")).write("new");
    expectMessage<InputError>([&] { files.commit(); }, {"/dev/full", "No space left on device"});
  }
  EXPECT_EQ(contentOf(folder.file("a.txt")), "old");
  EXPECT_EQ(numFiles(folder), 1);
}

TEST(AtomicFileSet, WritesAllFiles) {
  const TemporaryFolder folder;
  AtomicFileSet files;
  files.add(folder.file("a.txt")).write("a");
  files.add(folder.file("b.txt")).write("b");
  files.commit();
  EXPECT_EQ(contentOf(folder.file("a.txt")), "a");
  EXPECT_EQ(contentOf(folder.file("b.txt")), "b");
  EXPECT_EQ(numFiles(folder), 2);
}

TEST(AtomicFile, AFullDiskIsAnErrorThatSaysSo) {
  if (!fs::exists("/dev/full")) {
    GTEST_SKIP() << "no /dev/full on this system";
  }
  expectMessage<InputError>([] { writeFile("/dev/full", "text"); }, {"/dev/full", "No space left on device"});
}

TEST(AtomicFile, AMissingFolderIsAnErrorThatNamesThePath) {
  const TemporaryFolder folder;
  const std::string path = folder.file("missing/result.txt");
  expectMessage<InputError>([&] { writeFile(path, "text"); }, {path, "No such file or directory"});
}

TEST(AtomicFile, AFolderInPlaceOfTheFileIsAnError) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  expectMessage<InputError>([&] { writeFile(path, "text"); }, {path, "Is a directory"});
}

TEST(AtomicFile, AFolderWithoutWriteAccessIsAnErrorAndKeepsTheOldFile) {
  if (geteuid() == 0) {
    GTEST_SKIP() << "root may write everywhere";
  }
  const TemporaryFolder folder;
  const std::string path = folder.file("result.txt");
  writeFile(path, "old");
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  expectMessage<InputError>([&] { writeFile(path, "new"); }, {path, "Permission denied"});
  fs::permissions(folder.path(), fs::perms::owner_all);
  EXPECT_EQ(contentOf(path), "old");
}

}  // namespace
}  // namespace tartan_calib::io
