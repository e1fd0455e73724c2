#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "tests/temporary_folder.h"
#include "toolkit/vtk/vtp_series.h"

namespace mimetra::test {

/// A folder of its own for each test.
class VtpTest : public ::testing::Test {
 protected:
  std::filesystem::path in_folder(const std::string& name) const { return folder_ / name; }
  bool folder_is_empty() const { return folder_.names().empty(); }

 private:
  const TemporaryFolder folder_;
};

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A quad and a triangle that share an edge, three frames, fields of every kind.
inline FieldSequence quad_and_triangle() {
  const Connectivity connectivity =
      Connectivity::from_polygons(5, {{0, 1, 2, 3, 1, 4, 2}, {0, 4, 7}});
  Frames frames(3, 15);
  frames.row(0) << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0.5, 0;
  frames.row(1) = frames.row(0).array() + 0.1;
  frames.row(2) = frames.row(0) * 3;
  const Positions rest = PositionsView(frames.data(), 5, 3);
  FieldSequence result{
      MeshSequence(connectivity, frames, Eigen::Vector3d(0, 1e-7, 1.0 / 3), rest), {}, true};

  Field region{"region", Field::Location::vertices, Eigen::VectorXd(5), true};
  region.values << -1, 0, 1, 16777217, 2;  // 2^24 + 1: a float cannot hold it
  Field direction{"direction", Field::Location::vertices, Eigen::MatrixXd(5, 3)};
  direction.values = Eigen::MatrixXd::NullaryExpr(5, 3, [](auto i, auto j) { return i - 0.5 * j; });
  Field in_l{"in_L", Field::Location::triangles, Eigen::Vector3d(0, 1, 0), true};
  result.fields = {region, direction, in_l};
  return result;
}

}  // namespace mimetra::test
