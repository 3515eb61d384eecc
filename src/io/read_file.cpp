#include "read_file.h"

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "tartan_calib/error.h"

namespace tartan_calib::io {

std::string readFile(const std::string& path) {
  constexpr std::size_t kChunkBytes = 1 << 16;
  const auto fail = [&path]() { throw InputError("cannot read " + path + ": " + std::generic_category().message(errno)); };
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (file == nullptr) {
    fail();
  }
  std::string text;
  std::array<char, kChunkBytes> chunk{};
  std::size_t got = 0;
  while ((got = std::fread(chunk.data(), 1, chunk.size(), file.get())) > 0) {
    text.append(chunk.data(), got);
  }
  if (std::ferror(file.get()) != 0) {
    fail();
  }
  return text;
}

}  // namespace tartan_calib::io
