#pragma once

#include <cstdint>

#include "toolkit/io/bytes.h"

/// How OpenMesh's own files (.om, version 2.2) are made of chunks. Internal to mesh_codecs.h.
namespace mimetra {

/// What the rows of a chunk belong to, and what they are.
enum class OmOf : unsigned { vertices = 0, mesh = 1, faces = 2, edges = 4, halfedges = 6, end = 7 };
enum class OmWhat : unsigned {
  positions = 0,
  normals = 1,
  texture = 2,
  status = 3,
  colors = 4,
  custom = 6,
  topology = 7
};

/// The 16 bits before a chunk. Of custom properties only the first three count.
struct OmChunk {
  bool is_named = false;
  OmOf of = OmOf::vertices;
  OmWhat what = OmWhat::positions;
  bool is_signed = true, is_float = true;
  unsigned dimension = 1;   ///< 1 to 8 numbers in a row
  unsigned size_class = 0;  ///< of a number: 1, 2, 4, 8 bytes of integers, 4, 8, 16 of floats

  std::size_t integer_bytes() const { return std::size_t{1} << size_class; }
  std::size_t float_bytes() const { return std::size_t{4} << size_class; }
};

inline OmChunk om_chunk(std::uint16_t bits) {
  const auto part = [bits](int first, int count) {
    return (static_cast<unsigned>(bits) >> first) & ((1U << count) - 1);
  };
  return {part(1, 1) == 1,
          static_cast<OmOf>(part(2, 3)),
          static_cast<OmWhat>(part(5, 4)),
          part(9, 1) == 1,
          part(10, 1) == 1,
          part(11, 3) + 1,
          part(14, 2)};
}

inline std::uint16_t om_bits(const OmChunk& chunk) {
  return static_cast<std::uint16_t>(
      (chunk.is_named ? 1U : 0U) << 1 | static_cast<unsigned>(chunk.of) << 2 |
      static_cast<unsigned>(chunk.what) << 5 | (chunk.is_signed ? 1U : 0U) << 9 |
      (chunk.is_float ? 1U : 0U) << 10 | (chunk.dimension - 1) << 11 | chunk.size_class << 14);
}

/// An integer of 1, 2, 4 or 8 bytes. \pre they are there
inline std::int64_t om_integer(const char* at, std::size_t bytes, bool is_signed) {
  const auto as = [at, is_signed](auto number) -> std::int64_t {
    using Unsigned = decltype(number);
    const auto read = number_at<Unsigned>(at, std::endian::little);
    return is_signed ? static_cast<std::make_signed_t<Unsigned>>(read)
                     : static_cast<std::int64_t>(read);
  };
  switch (bytes) {
    case 1:
      return as(std::uint8_t{});
    case 2:
      return as(std::uint16_t{});
    case 4:
      return as(std::uint32_t{});
    default:
      return as(std::uint64_t{});
  }
}

}  // namespace mimetra
