#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// The least that reads independent results: little-endian NumPy arrays in C order.
namespace mimetra::test {

struct NpyArray {
  std::vector<int> shape;
  std::vector<double> values;

  int rows() const { return shape.at(0); }
  int columns() const { return static_cast<int>(values.size()) / rows(); }
};

template <typename Scalar>
std::vector<double> as_doubles(const std::string& bytes, std::size_t offset) {
  std::vector<Scalar> stored((bytes.size() - offset) / sizeof(Scalar));
  std::memcpy(stored.data(), bytes.data() + offset, stored.size() * sizeof(Scalar));
  return {stored.begin(), stored.end()};
}

inline NpyArray read_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  // {'descr': '<f8', 'fortran_order': False, 'shape': (10, 3448, 3), } after 10 bytes.
  const std::size_t data =
      10 + static_cast<unsigned char>(bytes.at(8)) + 256 * static_cast<unsigned char>(bytes.at(9));
  const std::string header = bytes.substr(10, data - 10);
  if (header.find("False") == std::string::npos) throw std::runtime_error(path.string() + header);
  NpyArray array;
  std::istringstream sizes(header.substr(header.find('(') + 1));
  for (int size = 0; sizes >> size; sizes.ignore(1)) array.shape.push_back(size);
  const std::string type = header.substr(header.find('<') + 1, 2);
  if (type == "f4") array.values = as_doubles<float>(bytes, data);
  if (type == "f8") array.values = as_doubles<double>(bytes, data);
  if (type == "i4") array.values = as_doubles<std::int32_t>(bytes, data);
  if (type == "i8") array.values = as_doubles<std::int64_t>(bytes, data);
  return array;
}

}  // namespace mimetra::test
