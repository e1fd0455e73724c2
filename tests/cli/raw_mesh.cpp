#include <cstdint>
#include <sstream>
#include <stdexcept>

#include "tests/cli/bad_input.h"

namespace mimetra::test {

namespace {

std::string point_text(const std::array<double, 3>& point) {
  std::ostringstream text;
  text.precision(17);
  text << point[0] << ' ' << point[1] << ' ' << point[2];
  return text.str();
}

std::string obj(const RawMesh& mesh) {
  std::ostringstream text;
  for (const auto& point : mesh.vertices) text << "v " << point_text(point) << '\n';
  for (const auto& face : mesh.faces) {
    text << 'f';
    for (const int vertex : face) text << ' ' << (vertex < 0 ? vertex : vertex + 1);
    text << '\n';
  }
  return text.str();
}

std::string face_lines(const RawMesh& mesh) {
  std::ostringstream text;
  for (const auto& face : mesh.faces) {
    text << face.size();
    for (const int vertex : face) text << ' ' << vertex;
    text << '\n';
  }
  return text.str();
}

std::string off(const RawMesh& mesh) {
  std::ostringstream text;
  text << "OFF\n"
       << mesh.vertices.size() + mesh.more_vertices << ' ' << mesh.faces.size() + mesh.more_faces
       << " 0\n";
  for (const auto& point : mesh.vertices) text << point_text(point) << '\n';
  return text.str() + face_lines(mesh);
}

std::string ply(const RawMesh& mesh, bool binary) {
  std::ostringstream text;
  text << "ply\nformat " << (binary ? "binary_little_endian" : "ascii") << " 1.0\nelement vertex "
       << mesh.vertices.size() + mesh.more_vertices
       << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
       << mesh.faces.size() + mesh.more_faces
       << "\nproperty list uchar int vertex_indices\nend_header\n";
  if (!binary) {
    for (const auto& point : mesh.vertices) text << point_text(point) << '\n';
    return text.str() + face_lines(mesh);
  }
  std::string bytes = text.str();
  for (const auto& point : mesh.vertices) {
    for (const double coordinate : point) append_raw(bytes, coordinate);
  }
  for (const auto& face : mesh.faces) {
    append_raw(bytes, static_cast<std::uint8_t>(face.size()));
    for (const int vertex : face) append_raw(bytes, std::int32_t{vertex});
  }
  return bytes;
}

std::string stl(const RawMesh& mesh) {
  std::string text = "solid square\n";
  for (const auto& face : mesh.faces) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const int vertex : face) text += "vertex " + point_text(mesh.vertices.at(vertex)) + '\n';
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid square\n";
}

std::string stl_binary(const RawMesh& mesh) {
  std::string bytes(80, ' ');
  append_raw(bytes, static_cast<std::uint32_t>(mesh.faces.size() + mesh.more_faces));
  for (const auto& face : mesh.faces) {
    for (const float normal : {0.F, 0.F, 1.F}) append_raw(bytes, normal);
    for (const int vertex : face) {
      for (const double coordinate : mesh.vertices.at(vertex)) {
        append_raw(bytes, static_cast<float>(coordinate));
      }
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

}  // namespace

std::string bytes_of(const RawMesh& mesh, const std::string& format) {
  if (format == "obj") return obj(mesh);
  if (format == "off") return off(mesh);
  if (format == "ply") return ply(mesh, false);
  if (format == "ply_binary") return ply(mesh, true);
  if (format == "stl") return stl(mesh);
  if (format == "stl_binary") return stl_binary(mesh);
  throw std::invalid_argument("no format '" + format + "'");
}

}  // namespace mimetra::test
