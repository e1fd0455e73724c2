#include "toolkit/operations/parameter_files.h"

#include <array>

#include <Eigen/LU>
#include <nlohmann/json.hpp>

#include "toolkit/io/mesh_file.h"
#include "toolkit/mesh/face_order.h"
#include "toolkit/operations/json.h"

namespace mimetra {

namespace {

/// Manifests keep all digits; a rotation that was typed or rounded by another tool passes too.
constexpr double kRotationTolerance = 1e-4;

RigidTransform transform_of(const Json& json) {
  RigidTransform transform;
  const auto rotation = json.at("rotation").get<std::vector<double>>();
  const auto translation = json.at("translation").get<std::vector<double>>();
  if (rotation.size() != 9 || translation.size() != 3) {
    throw std::invalid_argument("expected 9 numbers of rotation and 3 of translation a frame");
  }
  transform.rotation =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rotation.data());
  transform.translation = Eigen::Map<const Eigen::Vector3d>(translation.data());
  const Eigen::Matrix3d& R = transform.rotation;
  if (!(R * R.transpose()).isIdentity(kRotationTolerance) || R.determinant() < 0) {
    throw std::invalid_argument("its rotation is no rotation matrix (row by row)");
  }
  return transform;
}

}  // namespace

Positions read_rest(const std::string& path, const FrameSource& sequence) {
  TriMesh rest = read_mesh(path);
  if (rest.positions.rows() != sequence.vertices()) {
    throw MismatchError(path + ": " + std::to_string(rest.positions.rows()) +
                        " vertices, expected " + std::to_string(sequence.vertices()) +
                        " as in the sequence");
  }
  const Connectivity& faces = sequence.connectivity();
  if (rest.connectivity.triangles.rows() > 0 && !same_faces(faces, rest.connectivity) &&
      !in_order_of(faces, rest.connectivity)) {
    throw MismatchError(
        path + ": face " + std::to_string(first_different_face(faces, rest.connectivity)) +
        " has other vertices than in the sequence; check --match compares the numbering, "
        "convert --match renumbers");
  }
  return std::move(rest.positions);
}

std::vector<VertexIndex> spread_vertices(int vertices) {
  std::vector<VertexIndex> spread(8);
  for (std::size_t i = 0; i < spread.size(); ++i) {
    spread[i] = static_cast<VertexIndex>(static_cast<long long>(i) * (vertices - 1) / 7);
  }
  return spread;
}

KeptMotion read_motion(const std::string& path, int frames) {
  KeptMotion kept;
  try {
    const Json json = read_json(path, "the manifest of an align run with result.motion");
    const Json& result = json.at("result");
    for (const Json& entry : result.at("motion")) kept.transforms.push_back(transform_of(entry));
    if (result.contains("extent")) {
      const auto extent = result["extent"].get<std::array<double, 3>>();
      kept.extent = Eigen::Vector3d(extent.data());
    }
    if (result.contains("places")) {
      kept.vertices = result.at("vertices").get<int>();
      const auto places = result["places"].get<std::array<std::array<double, 3>, 8>>();
      kept.places = Eigen::Map<const Positions>(places.front().data(), 8, 3);
    }
  } catch (const Json::exception&) {
    throw IoError(path,
                  "expected the manifest of an align run with result.motion and result.extent");
  } catch (const std::invalid_argument& error) {
    throw IoError(
        path, "motion of frame " + std::to_string(kept.transforms.size()) + ": " + error.what());
  }
  if (std::ssize(kept.transforms) != frames) {
    throw MismatchError(path + ": " + std::to_string(kept.transforms.size()) +
                        " rigid transforms, expected " + std::to_string(frames) +
                        ", one per frame of the sequence");
  }
  return kept;
}

}  // namespace mimetra
