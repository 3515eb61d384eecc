#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace tartan_calib::ros {

/// Where every message of a bag is: what rosbag knows as well, but does not tell. Its own reader fetches a whole chunk, with
/// all images in it, to look at the header of one. Format: wiki.ros.org/Bags/Format/2.0.
class BagIndex {
 public:
  struct Message {
    std::uint32_t connection = 0;
    std::int64_t received_ns = 0;
    std::uint64_t position = 0;  ///< of its record in the file; where the chunk is compressed, in the chunk
    bool is_compressed = false;
  };

  /// Throws InputError where the file has another structure.
  explicit BagIndex(const std::string& path);

  const std::map<std::uint32_t, std::string>& topics() const { return topics_; }  ///< by connection
  const std::vector<Message>& messages() const { return messages_; }              ///< as stored

  /// At most `max_bytes` from the beginning of a message that is not compressed.
  std::vector<std::uint8_t> beginning(const Message& message, std::size_t max_bytes);

 private:
  using Fields = std::map<std::string, std::string>;

  Fields readFields();  ///< header of the record at the reading position; then that is at its data
  std::uint32_t readNumber();
  std::string readText(std::size_t size);
  void readConnection();
  std::uint64_t readChunkPosition();
  void readChunk(std::uint64_t position);
  void readChunkIndex(std::uint64_t data_position, bool is_compressed);
  [[noreturn]] void fail() const;

  std::string path_;
  std::ifstream file_;
  std::map<std::uint32_t, std::string> topics_;
  std::vector<Message> messages_;
};

}  // namespace tartan_calib::ros
