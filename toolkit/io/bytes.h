#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

/// Binary numbers in files, in either byte order. Internal to the readers and writers.
namespace mimetra {

/// Most bytes that one byte of a deflate stream can expand to.
inline constexpr std::uint64_t kMostInflated = 1032;

template <std::size_t Bytes>
using UnsignedOf = std::conditional_t<
    Bytes == 1, std::uint8_t,
    std::conditional_t<Bytes == 2, std::uint16_t,
                       std::conditional_t<Bytes == 4, std::uint32_t, std::uint64_t>>>;

template <typename Unsigned>
Unsigned byte_swapped(Unsigned value) {
  Unsigned swapped = 0;
  for (std::size_t byte = 0; byte < sizeof(Unsigned); ++byte) {
    swapped = static_cast<Unsigned>((static_cast<std::uint64_t>(swapped) << 8) |
                                    ((value >> (8 * byte)) & 0xff));
  }
  return swapped;
}

/// Returns the number stored at `at`. \pre sizeof(Number) bytes are readable
template <typename Number>
Number number_at(const char* at, std::endian order) {
  UnsignedOf<sizeof(Number)> bits;
  std::memcpy(&bits, at, sizeof bits);
  if (order != std::endian::native) bits = byte_swapped(bits);
  return std::bit_cast<Number>(bits);
}

/// Decodes consecutive numbers to doubles. \pre values.size() numbers are readable
template <typename Stored>
void decode_numbers(const char* stored, std::endian order, std::span<double> values) {
  const auto decode_in = [stored, values](auto given) {
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = static_cast<double>(number_at<Stored>(stored + i * sizeof(Stored), given()));
    }
  };
  // The loop runs at the speed of memory only if the compiler knows the order.
  if (order == std::endian::native) {
    decode_in([] { return std::endian::native; });
  } else {
    decode_in([order] { return order; });
  }
}

/// Writes a number to `at` in a byte order. \pre sizeof(Number) bytes are writable
template <typename Number>
void put_number_at(char* at, Number value, std::endian order) {
  auto bits = std::bit_cast<UnsignedOf<sizeof(Number)>>(value);
  if (order != std::endian::native) bits = byte_swapped(bits);
  std::memcpy(at, &bits, sizeof bits);
}

template <typename Number>
void append_bytes_of(std::string& bytes, Number value, std::endian order) {
  char raw[sizeof value];
  put_number_at(raw, value, order);
  bytes.append(raw, sizeof raw);
}

/// Write and append a number, least significant byte first.
template <typename Number>
void put_little_endian(char* at, Number value) {
  put_number_at(at, value, std::endian::little);
}
template <typename Number>
void append_little_endian(std::string& bytes, Number value) {
  append_bytes_of(bytes, value, std::endian::little);
}

}  // namespace mimetra
