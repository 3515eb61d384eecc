#include "bag_index.h"

#include <algorithm>
#include <cstring>

#include "shared_bag.h"

namespace tartan_calib::ros {
namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kMaxHeaderBytes = 1 << 20;  ///< far beyond what recorders write; more is a damaged file

/// Operations, the kinds of records.
constexpr char kMessage = 0x02;
constexpr char kBagHeader = 0x03;
constexpr char kIndexData = 0x04;
constexpr char kChunk = 0x05;
constexpr char kChunkInfo = 0x06;
constexpr char kConnection = 0x07;

/// A little-endian number, as ROS writes them on every machine.
template <typename Number>
Number numberIn(const std::string& bytes) {
  Number number = 0;
  for (std::size_t i = 0; i < std::min(bytes.size(), sizeof(Number)); ++i) {
    number |= static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(bytes[i])) << (8U * i));
  }
  return number;
}

bool isOperation(const std::map<std::string, std::string>& fields, char operation) {
  const auto found = fields.find("op");
  return found != fields.end() && found->second == std::string(1, operation);
}

template <typename Number>
Number numberOf(const std::map<std::string, std::string>& fields, const std::string& name) {
  const auto found = fields.find(name);
  return found == fields.end() ? 0 : numberIn<Number>(found->second);
}

}  // namespace

BagIndex::BagIndex(const std::string& path) : path_(path), file_(path, std::ios::binary) {
  std::string version;
  std::getline(file_, version);
  const Fields header = readFields();
  if (!isOperation(header, kBagHeader)) {
    fail();
  }
  file_.seekg(static_cast<std::streamoff>(numberOf<std::uint64_t>(header, "index_pos")));
  for (std::uint32_t i = numberOf<std::uint32_t>(header, "conn_count"); i > 0; --i) {
    readConnection();
  }
  std::vector<std::uint64_t> chunks;
  for (std::uint32_t i = numberOf<std::uint32_t>(header, "chunk_count"); i > 0; --i) {
    chunks.push_back(readChunkPosition());
  }
  for (const std::uint64_t position : chunks) {
    readChunk(position);
  }
}

std::vector<std::uint8_t> BagIndex::beginning(const Message& message, std::size_t max_bytes) {
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(message.position));
  if (!isOperation(readFields(), kMessage)) {
    fail();
  }
  const std::string bytes = readText(std::min<std::size_t>(readNumber(), max_bytes));
  return {bytes.begin(), bytes.end()};
}

BagIndex::Fields BagIndex::readFields() {
  const std::size_t size = readNumber();
  if (size > kMaxHeaderBytes) {
    fail();
  }
  const std::string header = readText(size);
  Fields fields;
  for (std::size_t at = 0; at + sizeof(std::uint32_t) <= header.size();) {
    const std::size_t length = numberIn<std::uint32_t>(header.substr(at, sizeof(std::uint32_t)));
    const std::string field = header.substr(at + sizeof(std::uint32_t), length);
    const std::size_t equals = std::min(field.find('='), field.size());
    fields[field.substr(0, equals)] = equals < field.size() ? field.substr(equals + 1) : "";
    at += sizeof(std::uint32_t) + length;
  }
  return fields;
}

std::uint32_t BagIndex::readNumber() { return numberIn<std::uint32_t>(readText(sizeof(std::uint32_t))); }

std::string BagIndex::readText(std::size_t size) {
  std::string text(size, '\0');
  if (!file_.read(text.data(), static_cast<std::streamsize>(size))) {
    fail();
  }
  return text;
}

void BagIndex::readConnection() {
  Fields fields = readFields();
  if (!isOperation(fields, kConnection)) {
    fail();
  }
  topics_[numberOf<std::uint32_t>(fields, "conn")] = fields["topic"];
  file_.seekg(readNumber(), std::ios::cur);
}

std::uint64_t BagIndex::readChunkPosition() {
  const Fields fields = readFields();
  if (!isOperation(fields, kChunkInfo)) {
    fail();
  }
  file_.seekg(readNumber(), std::ios::cur);
  return numberOf<std::uint64_t>(fields, "chunk_pos");
}

void BagIndex::readChunk(std::uint64_t position) {
  file_.seekg(static_cast<std::streamoff>(position));
  Fields fields = readFields();
  if (!isOperation(fields, kChunk)) {
    fail();
  }
  const bool is_compressed = fields["compression"] != "none";
  const std::uint32_t size = readNumber();
  const auto data_position = static_cast<std::uint64_t>(file_.tellg());
  file_.seekg(size, std::ios::cur);
  readChunkIndex(data_position, is_compressed);
}

/// One record of positions for each connection follows a chunk, until another kind of record or the end of the file.
void BagIndex::readChunkIndex(std::uint64_t data_position, bool is_compressed) {
  while (file_.peek() != std::ifstream::traits_type::eof()) {
    const Fields fields = readFields();
    if (!isOperation(fields, kIndexData)) {
      return;
    }
    Message message;
    message.connection = numberOf<std::uint32_t>(fields, "conn");
    message.is_compressed = is_compressed;
    readNumber();  // the size of the data, which the count says too
    for (std::uint32_t i = numberOf<std::uint32_t>(fields, "count"); i > 0; --i) {
      const std::int64_t seconds = readNumber();
      message.received_ns = seconds * kNsPerSecond + readNumber();
      message.position = readNumber() + (is_compressed ? 0 : data_position);
      if (topics_.count(message.connection) > 0) {  // else of a damaged record: nothing says what its messages are
        messages_.push_back(message);
      }
    }
  }
  file_.clear();
}

void BagIndex::fail() const { throw damagedBag(path_, "a record is not where it should be"); }

}  // namespace tartan_calib::ros
