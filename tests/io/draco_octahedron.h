#pragma once

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>

#include "tests/shapes.h"

namespace mimetra::test {

/// What a builder has made, as Draco's bytes.
inline std::string draco_bytes(draco::TriangleSoupMeshBuilder& builder) {
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) throw std::runtime_error("Draco failed");
  return {buffer.data(), buffer.size()};
}

/// An octahedron as Draco's bytes: no number is rounded, every point stands once. `hanging` adds
/// joints (attribute 1) and their weights (2): what lies at x > 0 hangs on joint 1, the rest on 0.
inline std::string draco_octahedron(bool hanging = false) {
  const Shape shape = octahedron();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(shape.triangles.rows()));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  int joints = 0, weights = 0;
  if (hanging) {
    joints = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_UINT8);
    weights = builder.AddAttribute(draco::GeometryAttribute::GENERIC, 4, draco::DT_FLOAT32);
  }
  for (int t = 0; t < shape.triangles.rows(); ++t) {
    std::array<std::array<float, 3>, 3> corner{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        corner[k][c] = static_cast<float>(
            shape.positions(shape.triangles(t, Eigen::Index(k)), Eigen::Index(c)));
      }
    }
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<std::uint32_t>(t)),
                                      corner[0].data(), corner[1].data(), corner[2].data());
    if (!hanging) continue;
    std::array<std::array<std::uint8_t, 4>, 3> on{};
    for (std::size_t k = 0; k < 3; ++k) on[k][0] = corner[k][0] > 0 ? 1 : 0;
    const std::array<float, 4> all = {1, 0, 0, 0};
    builder.SetAttributeValuesForFace(joints, draco::FaceIndex(static_cast<std::uint32_t>(t)),
                                      on[0].data(), on[1].data(), on[2].data());
    builder.SetAttributeValuesForFace(weights, draco::FaceIndex(static_cast<std::uint32_t>(t)),
                                      all.data(), all.data(), all.data());
  }
  return draco_bytes(builder);
}

/// The octahedron's corners times 32767 in 16 bits, which glTF shows as -1 to 1, and a texture
/// coordinate of each (attribute 1) in 16 bits without a sign: its corner's y from 0 to 65535.
inline std::string quantised_draco_octahedron() {
  const Shape shape = octahedron();
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(shape.triangles.rows()));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_INT16);
  const int uv = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_UINT16);
  for (int t = 0; t < shape.triangles.rows(); ++t) {
    std::array<std::array<std::int16_t, 3>, 3> corner{};
    std::array<std::array<std::uint16_t, 2>, 3> texture{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::RowVector3d point =
          shape.positions.row(shape.triangles(t, static_cast<Eigen::Index>(k)));
      for (std::size_t c = 0; c < 3; ++c) {
        corner[k][c] = static_cast<std::int16_t>(32767 * point[static_cast<Eigen::Index>(c)]);
      }
      texture[k] = {0, static_cast<std::uint16_t>(point.y() > 0 ? 65535 : 0)};
    }
    const draco::FaceIndex face(static_cast<std::uint32_t>(t));
    builder.SetAttributeValuesForFace(id, face, corner[0].data(), corner[1].data(),
                                      corner[2].data());
    builder.SetAttributeValuesForFace(uv, face, texture[0].data(), texture[1].data(),
                                      texture[2].data());
  }
  return draco_bytes(builder);
}

}  // namespace mimetra::test
