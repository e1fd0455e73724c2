#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace mimetra {

/// How a .vtp file stores the bytes of its arrays.
struct VtpStorage {
  std::size_t word = 4;  ///< bytes of the numbers before values: sizes and counts of blocks
  bool big_endian = false;
  std::string compressor = {};  ///< class of VTK's; empty for none
};

/// What stands before the values of a compressed array: how many blocks, their size, and that of
/// the last where it is another.
struct VtpBlocks {
  std::uint64_t count, size, last;

  std::uint64_t bytes() const {
    return count == 0 ? 0 : count * size - (last > 0 ? size - last : 0);
  }
};

/// The values of one array where they stand in the file. \pre of blocks: their sizes can be true
class StoredValues {
 public:
  enum class Form { text, base64, raw };

  /// `stored` begins with the array and may go on behind it. `type` as in the file, "Int32".
  StoredValues(const VtpStorage& storage, std::string type, std::string_view stored, Form form);

  /// The first `count` of the numbers before the values; fewer where the array ends.
  std::string words(std::size_t count) const;
  /// One of such numbers.
  std::uint64_t word(const std::string& words, std::size_t index) const;
  /// Those of a compressed array; nothing where it ends before.
  std::optional<VtpBlocks> blocks() const;

  /// Whether the file holds as many bytes as stand before the values; of text they are not counted.
  bool are_all_there() const;
  /// There are no more of them.
  std::uint64_t most() const;
  /// Nothing where there are fewer, or the bytes are not what they should be.
  std::optional<double> at(std::uint64_t index) const;

 private:
  std::string bytes(std::uint64_t first, std::size_t count) const;
  std::uint64_t numbers_in_text() const;
  std::optional<double> in_text(std::uint64_t index) const;
  std::string unpacked(std::uint64_t first, std::size_t count) const;
  double number(std::string bytes) const;

  const VtpStorage& storage_;
  std::string type_;
  std::string_view stored_;
  Form form_;
};

}  // namespace mimetra
