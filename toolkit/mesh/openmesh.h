#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/surface.h"
#include "toolkit/mesh/tri_mesh.h"

namespace mimetra {

/// TriMesh_ArrayKernelT, PolyMesh_ArrayKernelT, or a class derived from one.
template <typename Mesh>
concept OpenMeshClass = std::derived_from<Mesh, OpenMesh::BaseKernel> &&
    requires(const Mesh& mesh, OpenMesh::VertexHandle vertex) {
  typename Mesh::Point;
  mesh.point(vertex);
};

/// Positions, faces and texture coordinates of a mesh. Texture coordinates come from halfedges, or
/// from vertices if halfedges have none. Vertices and faces keep their order. Throws
/// std::invalid_argument if the mesh has deleted elements; call garbage_collection() first.
template <OpenMeshClass Mesh>
TriMesh from_openmesh(const Mesh& mesh);

/// Mesh of the user's class with the positions, polygons and texture coordinates of `mesh`. It has
/// the triangles if the class cannot hold polygons. Vertices and faces keep their order, and faces
/// their first corner.
///
/// Texture coordinates go to vertices if is_textured_by_vertex(). Otherwise they go to halfedges,
/// with 0 at corners without coordinates.
///
/// Throws MismatchError if halfedges cannot represent the mesh. The message names a face that
/// repeats a vertex or is wound against its neighbors, or a vertex where several sheets of faces
/// meet. Throws std::invalid_argument unless there is one position per vertex.
template <OpenMeshClass Mesh>
Mesh to_openmesh(const TriMesh& mesh);

/// Sequence with one frame per mesh. All meshes must have the faces of the first. `times` are as in
/// MeshSequence; the rest pose is unknown. Throws std::invalid_argument if there is no mesh, or if
/// faces differ (the message names the first such mesh), and as from_openmesh().
template <OpenMeshClass Mesh>
MeshSequence sequence_from_openmesh(const std::vector<Mesh>& meshes, Eigen::VectorXd times = {});

/// Sequence with one frame per named vertex property. Each property holds points of the mesh's
/// class or OpenMesh::Vec3f or Vec3d. The rest pose is the mesh itself. Throws
/// std::invalid_argument if a property is missing or has several types (the message names it), if
/// there are no names, and as from_openmesh().
template <OpenMeshClass Mesh>
MeshSequence sequence_from_openmesh(const Mesh& mesh, const std::vector<std::string>& poses,
                                    Eigen::VectorXd times = {});

/// Moves the vertices to `positions` (N x 3, in their order). Everything else is unchanged,
/// including normals. Throws std::invalid_argument if the number of vertices differs.
template <OpenMeshClass Mesh>
void set_positions(Mesh& mesh, const Eigen::Ref<const Positions>& positions);

/// Copy of a mesh, with all its properties, at new positions. Throws as set_positions().
template <OpenMeshClass Mesh>
Mesh with_positions(Mesh mesh, const Eigen::Ref<const Positions>& positions);

/// Stores each field in the property `v:NAME` on vertices or `f:NAME` on faces, such as `v:region`,
/// `v:roi`, `v:distance` and `f:in_L`. It replaces properties with the same name.
///
/// The type is OpenMesh::Vec3d for three columns (`v:component_3`), int for integer fields whose
/// values fit, and double otherwise. A face has the largest value of its triangles.
///
/// Throws std::invalid_argument, with the field's name, unless it has one or three columns (one for
/// integers) and one row per vertex or triangle. The names of OpenMesh's own attributes (`points`,
/// `normals`) are also refused. On errors the mesh is unchanged.
template <OpenMeshClass Mesh>
void set_fields(Mesh& mesh, const std::vector<Field>& fields);

/// Field from the property `name` on vertices or faces: masks, regions, weights, displacements. Its
/// type is bool, int, unsigned, float, double, Vec3f or Vec3d.
///
/// Triangles have the values of their faces. The field's name omits a prefix `v:` or `f:`. Throws
/// std::invalid_argument unless there is exactly one such property.
template <OpenMeshClass Mesh>
Field field_from_openmesh(const Mesh& mesh, const std::string& name);

// ---- implementation ----

namespace openmesh_bridge {

template <typename Handle, OpenMeshClass Mesh>
void check_kept(const Mesh& mesh, Handle handle, bool has_status, const char* element) {
  if (!has_status || !mesh.status(handle).deleted()) return;
  throw std::invalid_argument(std::string(element) + " " + std::to_string(handle.idx()) +
                              " is deleted; call garbage_collection() first");
}

template <OpenMeshClass Mesh>
Positions positions_of(const Mesh& mesh) {
  Positions positions(static_cast<Eigen::Index>(mesh.n_vertices()), 3);
  for (const auto vertex : mesh.all_vertices()) {
    check_kept(mesh, OpenMesh::VertexHandle(vertex), mesh.has_vertex_status(), "vertex");
    const auto& point = mesh.point(vertex);
    for (int axis = 0; axis < 3; ++axis) positions(vertex.idx(), axis) = point[axis];
  }
  return positions;
}

template <OpenMeshClass Mesh>
Polygons polygons_of(const Mesh& mesh) {
  Polygons polygons;
  for (const auto face : mesh.all_faces()) {
    check_kept(mesh, OpenMesh::FaceHandle(face), mesh.has_face_status(), "face");
    for (const auto halfedge : mesh.fh_range(face)) polygons.corners.push_back(halfedge.to().idx());
    polygons.offsets.push_back(static_cast<int>(polygons.corners.size()));
  }
  return polygons;
}

template <OpenMeshClass Mesh>
TextureCoordinates texture_of(const Mesh& mesh) {
  TextureCoordinates texture;
  const bool of_corners = mesh.has_halfedge_texcoords2D();
  if (!of_corners && !mesh.has_vertex_texcoords2D()) return texture;
  const auto add = [&texture](const auto& uv) { texture.coordinates.emplace_back(uv[0], uv[1]); };
  if (!of_corners) {
    for (const auto vertex : mesh.all_vertices()) add(mesh.texcoord2D(vertex));
  }
  for (const auto face : mesh.all_faces()) {
    for (const auto halfedge : mesh.fh_range(face)) {
      texture.corners.push_back(of_corners ? static_cast<int>(texture.coordinates.size())
                                           : halfedge.to().idx());
      if (of_corners) add(mesh.texcoord2D(halfedge));
    }
  }
  return texture;
}

/// Throws MismatchError if the halfedges differ from the mesh they were made from.
inline void check_held_by_halfedges(const Surface& surface) {
  const auto refuse = [](const std::string& what, const std::string& remedy) {
    throw MismatchError(what + ", which OpenMesh's halfedges cannot hold; " + remedy);
  };
  if (!surface.left_out().empty()) {
    refuse("face " + std::to_string(surface.left_out().front()) + " has a vertex twice",
           "remove the face");
  }
  if (!surface.turned().empty()) {
    refuse("face " + std::to_string(surface.turned().front()) + " is wound against its neighbors",
           "wind all faces the same way");
  }
  if (surface.copies() > 0) {
    const VertexIndex vertex = surface.vertex_of(OpenMesh::VertexHandle(surface.vertices()));
    refuse(std::to_string(surface.copies_of(vertex).size()) + " sheets of faces meet at vertex " +
               std::to_string(vertex),
           "give each sheet a vertex of its own");
  }
}

/// Index of a polygon's texture coordinates at a vertex; -1 if it has none.
inline int texture_at(const Connectivity& connectivity, int polygon, VertexIndex vertex) {
  const Polygons& polygons = connectivity.polygons;
  if (connectivity.texture.corners.empty()) return -1;
  const auto face = static_cast<std::size_t>(polygon);
  const auto first = polygons.corners.begin() + polygons.offsets[face];
  const auto corner =
      std::find(first, polygons.corners.begin() + polygons.offsets[face + 1], vertex);
  return connectivity.texture.corners[static_cast<std::size_t>(corner - polygons.corners.begin())];
}

/// Writes the texture coordinates. If the mesh has none but the class does, they are set to 0,
/// because OpenMesh leaves them undefined.
template <OpenMeshClass Mesh>
void write_texture(Mesh& mesh, const Connectivity& connectivity) {
  const std::vector<Eigen::Vector2d>& coordinates = connectivity.texture.coordinates;
  const bool on_vertices = is_textured_by_vertex(connectivity);
  if (on_vertices) mesh.request_vertex_texcoords2D();
  if (!on_vertices && !coordinates.empty()) mesh.request_halfedge_texcoords2D();
  const auto at = [&coordinates](int index) {
    using Scalar = typename Mesh::TexCoord2D::value_type;
    const Eigen::Vector2d uv = index < 0 ? Eigen::Vector2d(0, 0) : coordinates[std::size_t(index)];
    return typename Mesh::TexCoord2D(static_cast<Scalar>(uv[0]), static_cast<Scalar>(uv[1]));
  };
  if (mesh.has_vertex_texcoords2D()) {
    for (const auto vertex : mesh.vertices()) {
      mesh.set_texcoord2D(vertex, at(on_vertices ? vertex.idx() : -1));
    }
  }
  if (!mesh.has_halfedge_texcoords2D()) return;
  for (const auto halfedge : mesh.halfedges()) {
    const int face = halfedge.face().idx();
    const int polygon = face < 0 || !Mesh::is_triangles()
                            ? face
                            : connectivity.polygon_of_triangle[static_cast<std::size_t>(face)];
    mesh.set_texcoord2D(halfedge,
                        at(face < 0 ? -1 : texture_at(connectivity, polygon, halfedge.to().idx())));
  }
}

/// Reads a property of this type, one row per element. Returns false if there is none.
template <typename Type, typename Handle, OpenMeshClass Mesh>
bool read_property(const Mesh& mesh, const std::string& name, Eigen::MatrixXd& values) {
  typename OpenMesh::PropHandle<Handle>::template type<Type> property;
  if (!mesh.get_property_handle(property, name)) return false;
  const auto count = static_cast<Eigen::Index>(mesh.template n_elements<Handle>());
  constexpr bool kIsVector = requires(const Type& value) {
    value[0];
  };
  values.resize(count, kIsVector ? 3 : 1);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& value = mesh.property(property, Handle(static_cast<int>(i)));
    if constexpr (kIsVector) {
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        values(i, axis) = static_cast<double>(value[static_cast<std::size_t>(axis)]);
      }
    } else {
      values(i, 0) = static_cast<double>(value);
    }
  }
  return true;
}

/// Number of properties of these types; `values` receives the values of one of them.
template <typename Handle, typename... Types, OpenMeshClass Mesh>
int read_properties(const Mesh& mesh, const std::string& name, Eigen::MatrixXd& values) {
  return (int{read_property<Types, Handle>(mesh, name, values)} + ...);
}

/// Number of supported properties with this name; `field` receives one of them.
template <typename Handle, OpenMeshClass Mesh>
int read_field(const Mesh& mesh, const std::string& name, Field& field) {
  using Vec3f = OpenMesh::Vec3f;
  using Vec3d = OpenMesh::Vec3d;
  const int integers = read_properties<Handle, bool, int, unsigned>(mesh, name, field.values);
  const int others = read_properties<Handle, float, double, Vec3f, Vec3d>(mesh, name, field.values);
  if (integers > 0) field.integer = true;
  return integers + others;
}

/// Removes properties with this name and a type other than `Kept`.
template <typename Kept, typename Handle, typename... Types, OpenMeshClass Mesh>
void remove_others(Mesh& mesh, const std::string& name) {
  const auto remove = [&mesh, &name](auto property) {
    while (mesh.get_property_handle(property, name)) mesh.remove_property(property);
  };
  const auto remove_other = [&remove]<typename Type>(std::type_identity<Type>) {
    if constexpr (!std::same_as<Type, Kept>) {
      remove(typename OpenMesh::PropHandle<Handle>::template type<Type>());
    }
  };
  (remove_other(std::type_identity<Types>()), ...);
}

template <typename Type, typename Handle, OpenMeshClass Mesh>
void write_property(Mesh& mesh, const std::string& name, const Eigen::MatrixXd& values) {
  remove_others<Type, Handle, bool, int, unsigned, float, double, OpenMesh::Vec3f, OpenMesh::Vec3d>(
      mesh, name);
  auto property = OpenMesh::getOrMakeProperty<Handle, Type>(mesh, name.c_str());
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const Handle handle(static_cast<int>(i));
    if constexpr (std::same_as<Type, OpenMesh::Vec3d>) {
      property[handle] = Type(values(i, 0), values(i, 1), values(i, 2));
    } else {
      property[handle] = static_cast<Type>(values(i, 0));
    }
  }
}

inline void check_field(const Field& field, const Connectivity& connectivity) {
  const bool on_vertices = field.location == Field::Location::vertices;
  constexpr std::array kOfMesh = {"points",      "normals",     "colors",      "status",
                                  "texcoords1D", "texcoords2D", "texcoords3D", "textureindex"};
  if (std::ranges::find(kOfMesh, field.name) != kOfMesh.end()) {
    throw std::invalid_argument("field '" + field.name +
                                "' would take the place of an attribute that OpenMesh keeps by "
                                "that name; give it another");
  }
  const Eigen::Index expected = on_vertices ? connectivity.vertices : connectivity.triangles.rows();
  if (field.values.rows() != expected) {
    throw std::invalid_argument("field '" + field.name + "' has " +
                                std::to_string(field.values.rows()) + " values, expected " +
                                std::to_string(expected) +
                                (on_vertices ? ", one a vertex" : ", one a triangle"));
  }
  if (field.values.cols() != 1 && (field.values.cols() != 3 || field.integer)) {
    throw std::invalid_argument("field '" + field.name + "' has " +
                                std::to_string(field.values.cols()) +
                                " columns; expected one number, or a vector of three");
  }
}

template <typename Handle, OpenMeshClass Mesh>
void write_field(Mesh& mesh, const std::string& name, const Field& field,
                 const Eigen::MatrixXd& values) {
  if (values.cols() == 3 && !field.integer) {
    write_property<OpenMesh::Vec3d, Handle>(mesh, name, values);
  } else if (field.integer && all_are_held_by<int>(values)) {
    write_property<int, Handle>(mesh, name, values);
  } else {
    write_property<double, Handle>(mesh, name, values);
  }
}

}  // namespace openmesh_bridge

template <OpenMeshClass Mesh>
TriMesh from_openmesh(const Mesh& mesh) {
  TriMesh result;
  result.positions = openmesh_bridge::positions_of(mesh);
  result.connectivity = Connectivity::from_polygons(static_cast<int>(mesh.n_vertices()),
                                                    openmesh_bridge::polygons_of(mesh));
  result.connectivity.texture = openmesh_bridge::texture_of(mesh);
  return result;
}

template <OpenMeshClass Mesh>
Mesh to_openmesh(const TriMesh& mesh) {
  const Connectivity& connectivity = mesh.connectivity;
  const Surface surface = Mesh::is_triangles()
                              ? Surface(connectivity.vertices, connectivity.triangles)
                              : Surface(connectivity.vertices, connectivity.polygons);
  openmesh_bridge::check_held_by_halfedges(surface);
  Mesh result;
  result.assign_connectivity(surface.half_edges());
  for (const auto face : result.faces()) {
    // As after add_face(), which makes the halfedge point to the first corner.
    result.set_halfedge_handle(face, result.prev_halfedge_handle(face.halfedge()));
  }
  set_positions(result, mesh.positions);
  openmesh_bridge::write_texture(result, connectivity);
  return result;
}

template <OpenMeshClass Mesh>
MeshSequence sequence_from_openmesh(const std::vector<Mesh>& meshes, Eigen::VectorXd times) {
  if (meshes.empty()) throw std::invalid_argument("a sequence needs a mesh");
  TriMesh first = from_openmesh(meshes.front());
  Frames frames(static_cast<Eigen::Index>(meshes.size()), first.positions.size());
  for (std::size_t f = 0; f < meshes.size(); ++f) {
    const TriMesh mesh = from_openmesh(meshes[f]);
    if (!same_faces(mesh.connectivity, first.connectivity)) {
      throw std::invalid_argument("mesh " + std::to_string(f) + " has other faces than mesh 0");
    }
    frames.row(static_cast<Eigen::Index>(f)) = mesh.positions.reshaped<Eigen::RowMajor>();
  }
  return {std::move(first.connectivity), std::move(frames), std::move(times)};
}

template <OpenMeshClass Mesh>
MeshSequence sequence_from_openmesh(const Mesh& mesh, const std::vector<std::string>& poses,
                                    Eigen::VectorXd times) {
  if (poses.empty()) throw std::invalid_argument("a sequence needs the name of a property");
  TriMesh rest = from_openmesh(mesh);
  Frames frames(static_cast<Eigen::Index>(poses.size()), rest.positions.size());
  for (std::size_t f = 0; f < poses.size(); ++f) {
    Eigen::MatrixXd pose;
    using OpenMesh::Vec3f, OpenMesh::Vec3d;
    using openmesh_bridge::read_properties, OpenMesh::VertexHandle;
    using Point = typename Mesh::Point;
    int found = read_properties<VertexHandle, Vec3f, Vec3d>(mesh, poses[f], pose);
    if constexpr (!std::is_same_v<Point, Vec3f> && !std::is_same_v<Point, Vec3d>) {
      found += read_properties<VertexHandle, Point>(mesh, poses[f], pose);
    }
    if (found != 1) {
      throw std::invalid_argument(found == 0
                                      ? "the mesh has no points of vertices '" + poses[f] + "'"
                                      : "the mesh has points of vertices '" + poses[f] +
                                            "' of several types; remove all but the one that "
                                            "is meant");
    }
    frames.row(static_cast<Eigen::Index>(f)) = pose.reshaped<Eigen::RowMajor>();
  }
  return {std::move(rest.connectivity), std::move(frames), std::move(times),
          std::move(rest.positions)};
}

template <OpenMeshClass Mesh>
void set_positions(Mesh& mesh, const Eigen::Ref<const Positions>& positions) {
  if (positions.rows() != static_cast<Eigen::Index>(mesh.n_vertices())) {
    throw std::invalid_argument(std::to_string(positions.rows()) + " positions for a mesh of " +
                                std::to_string(mesh.n_vertices()) + " vertices");
  }
  using Point = typename Mesh::Point;
  using Scalar = typename OpenMesh::vector_traits<Point>::value_type;
  for (const auto vertex : mesh.all_vertices()) {
    const auto row = positions.row(vertex.idx());
    mesh.set_point(vertex, Point(static_cast<Scalar>(row[0]), static_cast<Scalar>(row[1]),
                                 static_cast<Scalar>(row[2])));
  }
}

template <OpenMeshClass Mesh>
Mesh with_positions(Mesh mesh, const Eigen::Ref<const Positions>& positions) {
  set_positions(mesh, positions);
  return mesh;
}

template <OpenMeshClass Mesh>
void set_fields(Mesh& mesh, const std::vector<Field>& fields) {
  const Connectivity connectivity = Connectivity::from_polygons(static_cast<int>(mesh.n_vertices()),
                                                                openmesh_bridge::polygons_of(mesh));
  for (const Field& field : fields) openmesh_bridge::check_field(field, connectivity);
  for (const Field& field : fields) {
    if (field.location == Field::Location::vertices) {
      openmesh_bridge::write_field<OpenMesh::VertexHandle>(mesh, "v:" + field.name, field,
                                                           field.values);
    } else {
      openmesh_bridge::write_field<OpenMesh::FaceHandle>(mesh, "f:" + field.name, field,
                                                         on_polygons(field.values, connectivity));
    }
  }
}

template <OpenMeshClass Mesh>
Field field_from_openmesh(const Mesh& mesh, const std::string& name) {
  Field of_vertices, of_faces;
  const int on_vertices =
      openmesh_bridge::read_field<OpenMesh::VertexHandle>(mesh, name, of_vertices);
  const int on_faces = openmesh_bridge::read_field<OpenMesh::FaceHandle>(mesh, name, of_faces);
  if (on_vertices + on_faces == 0) {
    throw std::invalid_argument("the mesh has no property '" + name +
                                "' of bool, int, unsigned, float, double, Vec3f or Vec3d");
  }
  if (on_vertices + on_faces > 1) {
    throw std::invalid_argument("the mesh has properties '" + name +
                                "' of several types, or on vertices and faces; remove all but the "
                                "one that is meant");
  }
  Field field = std::move(on_vertices == 1 ? of_vertices : of_faces);
  field.name = name.starts_with("v:") || name.starts_with("f:") ? name.substr(2) : name;
  if (on_vertices == 1) return field;
  field.location = Field::Location::triangles;
  const Connectivity connectivity = Connectivity::from_polygons(static_cast<int>(mesh.n_vertices()),
                                                                openmesh_bridge::polygons_of(mesh));
  field.values = Eigen::MatrixXd(field.values(connectivity.polygon_of_triangle, Eigen::all));
  return field;
}

}  // namespace mimetra
