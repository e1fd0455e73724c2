#include <cstdint>
#include <limits>
#include <mutex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include <OpenMesh/Core/IO/MeshIO.hh>

#include "toolkit/io/mesh_content.h"
#include "toolkit/mesh/openmesh.h"

namespace mimetra {
namespace {

void check_name(const std::string& name) {
  constexpr std::size_t kLongest = 255;
  if (name.size() > kLongest) {
    throw MismatchError("the field's name '" + name + "' is longer than " +
                        std::to_string(kLongest) + " letters, which OpenMesh's files hold");
  }
  if (name.empty() || (name.size() > 1 && name[1] == ':')) {
    throw MismatchError(
        "OpenMesh writes no property without a name or with ':' as its second letter; rename the "
        "field '" +
        name + "'");
  }
}

template <typename Value, typename Handle, typename Mesh>
void add_property(Mesh& mesh, const std::string& name, const Eigen::MatrixXd& values) {
  if (sizeof(Value) * static_cast<std::size_t>(values.rows()) >
      std::numeric_limits<std::uint32_t>::max()) {
    throw MismatchError("the field '" + name + "' has more values than OpenMesh's files hold");
  }
  typename OpenMesh::PropHandle<Handle>::template type<Value> property;
  mesh.add_property(property, name);
  mesh.property(property).set_persistent(true);
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    Value& value = mesh.property(property, Handle(static_cast<int>(row)));
    if constexpr (std::is_arithmetic_v<Value>) {
      value = static_cast<Value>(values(row, 0));
    } else {
      for (Eigen::Index column = 0; column < values.cols(); ++column) {
        value[static_cast<std::size_t>(column)] =
            static_cast<typename Value::value_type>(values(row, column));
      }
    }
  }
}

/// Adds a property of numbers, or of vectors of two to four.
template <typename Number, typename Handle, typename Mesh>
void add_numbers(Mesh& mesh, const std::string& name, const Eigen::MatrixXd& values) {
  check_name(name);
  switch (values.cols()) {
    case 1:
      return add_property<Number, Handle>(mesh, name, values);
    case 2:
      return add_property<OpenMesh::VectorT<Number, 2>, Handle>(mesh, name, values);
    case 3:
      return add_property<OpenMesh::VectorT<Number, 3>, Handle>(mesh, name, values);
    case 4:
      return add_property<OpenMesh::VectorT<Number, 4>, Handle>(mesh, name, values);
    default:
      throw MismatchError("the field '" + name + "' has " + std::to_string(values.cols()) +
                          " columns; properties of OpenMesh's files have 1 to 4");
  }
}

template <typename Handle, typename Mesh>
void keep_field(Mesh& mesh, const Field& field, const Eigen::MatrixXd& values) {
  if (field.integer && all_are_held_by<std::int32_t>(values)) {
    add_numbers<std::int32_t, Handle>(mesh, field.name, values);
  } else {
    add_numbers<double, Handle>(mesh, field.name, values);
  }
}

template <typename Mesh>
Mesh half_edges_of(const Connectivity& connectivity) {
  try {
    return to_openmesh<Mesh>({Positions::Zero(connectivity.vertices, 3), connectivity});
  } catch (const MismatchError& error) {
    throw MismatchError(std::string(error.what()) + ", or write another format");
  }
}

/// Keeps OpenMesh's writer from logging how much it wrote. All threads share the log, and the
/// writer leaves it enabled.
class SilentLog {
 public:
  SilentLog() : lock_(mutex()), was_enabled_(omlog().is_enabled()) { omlog().disable(); }
  ~SilentLog() { was_enabled_ ? omlog().enable() : omlog().disable(); }

 private:
  static std::mutex& mutex() {
    static std::mutex mutex;
    return mutex;
  }

  std::lock_guard<std::mutex> lock_;
  bool was_enabled_;
};

/// Throws MismatchError for vertices that OpenMesh's writer would truncate. It stores all numbers
/// of the connectivity in as many bytes as four times the number of edges needs.
void check_vertices_of_faces(const Connectivity& connectivity, std::size_t edges) {
  const std::size_t largest = 4 * edges;
  const int limit = largest <= 0x100     ? 0x80
                    : largest <= 0x10000 ? 0x8000
                                         : std::numeric_limits<int>::max();
  for (const VertexIndex v : connectivity.polygons.corners) {
    if (v < limit) continue;
    throw MismatchError("a face uses vertex " + std::to_string(v) + ", and OpenMesh's files of " +
                        std::to_string(edges) + " edges hold vertices below " +
                        std::to_string(limit) +
                        "; remove vertices without faces, or write another format");
  }
}

/// Bytes of a file with all vertices at the origin.
template <typename Traits>
std::string om_bytes(const Connectivity& connectivity, const std::vector<Field>& fields,
                     const Context& context) {
  context.report(0);
  auto mesh = half_edges_of<OpenMesh::PolyMesh_ArrayKernelT<Traits>>(connectivity);
  check_vertices_of_faces(connectivity, mesh.n_edges());
  for (const Field& field : fields) {
    const bool on_vertices = field.location == Field::Location::vertices;
    const Eigen::Index expected =
        on_vertices ? connectivity.vertices : connectivity.triangles.rows();
    if (field.values.rows() != expected) {
      throw MismatchError("the field '" + field.name + "' has " +
                          std::to_string(field.values.rows()) + " values, expected " +
                          std::to_string(expected));
    }
    if (on_vertices) {
      keep_field<OpenMesh::VertexHandle>(mesh, field, field.values);
    } else {
      keep_field<OpenMesh::FaceHandle>(mesh, field, on_polygons(field.values, connectivity));
    }
  }
  constexpr double kBuilding = 0.5;
  context.report(kBuilding);
  OpenMesh::IO::Options options = OpenMesh::IO::Options::Custom;
  if (mesh.has_vertex_texcoords2D()) options += OpenMesh::IO::Options::VertexTexCoord;
  if (mesh.has_halfedge_texcoords2D()) options += OpenMesh::IO::Options::FaceTexCoord;
  std::ostringstream bytes;
  bytes.exceptions(std::ios::badbit | std::ios::failbit);  // lets std::bad_alloc through
  const SilentLog silent;
  if (!OpenMesh::IO::write_mesh(mesh, bytes, ".om", options)) {
    throw std::runtime_error("OpenMesh could not write the mesh");
  }
  return std::move(bytes).str();
}

}  // namespace

MeshFrame om_frame(const Connectivity& connectivity, const std::vector<Field>& fields,
                   bool double_precision, const Context& context) {
  const std::string bytes =
      double_precision ? om_bytes<OpenMesh::DefaultTraitsDouble>(connectivity, fields, context)
                       : om_bytes<OpenMesh::DefaultTraits>(connectivity, fields, context);
  // The first chunk holds the positions; its header follows the file's.
  constexpr std::size_t kBefore = 16 + 2;
  const std::size_t positions = 3 * static_cast<std::size_t>(connectivity.vertices) *
                                (double_precision ? sizeof(double) : sizeof(float));
  return {bytes.substr(0, kBefore), bytes.substr(kBefore + positions),
          double_precision ? position_bytes<double> : position_bytes<float>};
}

}  // namespace mimetra
