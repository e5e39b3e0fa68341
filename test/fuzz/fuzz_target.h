#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <unistd.h>

/// Feeds arbitrary bytes to one reader. Errors that the reader promises are swallowed; anything else that
/// leaves this function, and every report of a sanitizer, is a finding. libFuzzer calls it by this name too.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace tet_line_tracker {

/// Takes values from the front of the input; zero when it is used up.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  template <typename Value>
  Value take() {
    Value value{};
    const std::size_t count = size_ < sizeof(Value) ? size_ : sizeof(Value);
    if (count > 0) std::memcpy(&value, data_, count);
    data_ += count;
    size_ -= count;
    return value;
  }

  const std::uint8_t* begin() const { return data_; }
  const std::uint8_t* end() const { return data_ + size_; }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// A plausible number of up to `scale`, and one time of `rarity` a double of any bits.
inline double takeNumber(Bytes& bytes, double scale, unsigned rarity) {
  if (bytes.take<std::uint8_t>() % rarity == 0) return bytes.take<double>();
  return scale * bytes.take<std::int16_t>() / 32768.0;
}

/// A promise of what is tried; breaking it is a finding.
inline void need(bool holds, const char* broken) {
  if (!holds) throw std::logic_error(broken);
}

/// The input as a file of this process, for readers that take a path. It goes when the process ends.
class InputFile {
 public:
  explicit InputFile(const std::string& ending)
      : path_(std::filesystem::temp_directory_path() / ("tet_fuzz_" + std::to_string(getpid()) + ending)) {}
  ~InputFile() { std::filesystem::remove(path_); }
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  const std::string& write(const std::uint8_t* data, std::size_t size) {
    std::ofstream file(path_, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
    if (!file.flush()) std::abort();
    return path_;
  }

 private:
  std::string path_;
};

}  // namespace tet_line_tracker
