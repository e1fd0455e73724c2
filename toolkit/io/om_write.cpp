#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "toolkit/io/bytes.h"
#include "toolkit/io/mesh_codecs.h"
#include "toolkit/io/om_layout.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/fields.h"
#include "toolkit/mesh/whole_numbers.h"

namespace mimetra {
namespace {

constexpr unsigned kFourBytes = 2;  // of integers
constexpr unsigned kDouble = 1;     // of floats

/// The half-edges of a mesh as OpenMesh has them: 2 e and 2 e + 1 run along edge e, one each way,
/// and those of no face along the border of the hole that they are on.
class HalfEdges {
 public:
  /// Throws MismatchError where a face meets what no half-edges hold.
  HalfEdges(int vertices, const Polygons& polygons, const Context& context)
      : of_vertex_(vertices, -1) {
    for (int face = 0; face < polygons.size(); ++face) {
      report_element(context, face, polygons.size() - face, polygons.size());
      add_face(polygons, face);
    }
    close_holes();
    check_fans(vertices);
  }

  int edges() const { return static_cast<int>(next_.size() / 2); }
  int halfedges() const { return static_cast<int>(next_.size()); }
  int next(int halfedge) const { return next_[static_cast<std::size_t>(halfedge)]; }
  int to(int halfedge) const { return to_[static_cast<std::size_t>(halfedge)]; }
  int face(int halfedge) const { return face_[static_cast<std::size_t>(halfedge)]; }
  /// One that leaves the vertex, along the border where it is on one; -1 without faces.
  const std::vector<int>& of_vertices() const { return of_vertex_; }
  /// One around each face, which points to its first corner.
  const std::vector<int>& of_faces() const { return of_face_; }
  /// The half-edge that points to each corner.
  const std::vector<int>& of_corners() const { return of_corner_; }

 private:
  [[noreturn]] static void refuse(const std::string& what) {
    throw MismatchError(what +
                        ", which OpenMesh's half-edges cannot hold; write another format, or mend "
                        "the mesh");
  }

  void add_face(const Polygons& polygons, int face) {
    const int first = polygons.offsets[static_cast<std::size_t>(face)];
    const int last = polygons.offsets[static_cast<std::size_t>(face) + 1];
    std::vector<int> around;
    for (int corner = first; corner < last; ++corner) {
      const int from = polygons.corners[static_cast<std::size_t>(corner)];
      const int to =
          polygons.corners[static_cast<std::size_t>(corner + 1 < last ? corner + 1 : first)];
      around.push_back(halfedge_between(from, to, face));
    }
    for (std::size_t i = 0; i < around.size(); ++i) {
      next_[static_cast<std::size_t>(around[i])] = around[(i + 1) % around.size()];
    }
    of_face_.push_back(around.back());
    of_corner_.push_back(around.back());
    of_corner_.insert(of_corner_.end(), around.begin(), around.end() - 1);
  }

  int halfedge_between(int from, int to, int face) {
    const auto [found, is_new] =
        edges_.try_emplace(std::minmax(from, to), static_cast<int>(next_.size() / 2));
    const int edge = found->second;
    if (is_new) {
      next_.insert(next_.end(), 2, -1);
      face_.insert(face_.end(), 2, -1);
      to_.insert(to_.end(), {to, from});
    }
    const int halfedge = 2 * edge + (this->to(2 * edge) == to ? 0 : 1);
    int& on_left = face_[static_cast<std::size_t>(halfedge)];
    if (from == to) {
      refuse("face " + std::to_string(face) + " has vertex " + std::to_string(from) +
             " twice in a row");
    }
    if (on_left >= 0) {
      refuse("faces " + std::to_string(on_left) + " and " + std::to_string(face) +
             " both run from vertex " + std::to_string(from) + " to " + std::to_string(to));
    }
    on_left = face;
    of_vertex_[static_cast<std::size_t>(from)] = halfedge;
    return halfedge;
  }

  void close_holes() {
    std::map<int, int> leaves;  // of each vertex on a border, the half-edge without a face
    for (int h = 0; h < halfedges(); ++h) {
      if (face(h) >= 0) continue;
      const int from = to(h ^ 1);
      if (!leaves.emplace(from, h).second) {
        refuse("several borders meet at vertex " + std::to_string(from));
      }
      of_vertex_[static_cast<std::size_t>(from)] = h;
    }
    for (const auto& [from, halfedge] : leaves) {
      next_[static_cast<std::size_t>(halfedge)] = leaves.at(to(halfedge));
    }
  }

  /// All half-edges that leave a vertex are one turn around it.
  void check_fans(int vertices) const {
    std::vector<int> leaving(static_cast<std::size_t>(vertices), 0);
    for (int h = 0; h < halfedges(); ++h) ++leaving[static_cast<std::size_t>(to(h))];
    for (int v = 0; v < vertices; ++v) {
      const int first = of_vertex_[static_cast<std::size_t>(v)];
      if (first < 0) continue;
      int count = 0, halfedge = first;
      do {
        ++count;
        halfedge = next(halfedge ^ 1);
      } while (halfedge != first && count <= leaving[static_cast<std::size_t>(v)]);
      if (count != leaving[static_cast<std::size_t>(v)]) {
        refuse("sheets that share no edge meet at vertex " + std::to_string(v));
      }
    }
  }

  std::map<std::pair<int, int>, int> edges_;
  std::vector<int> next_, to_, face_, of_vertex_, of_face_, of_corner_;
};

void append_chunk(std::string& bytes, const OmChunk& chunk) {
  append_little_endian(bytes, om_bits(chunk));
}

void append_indices(std::string& bytes, OmOf of, const std::vector<int>& indices) {
  append_chunk(bytes, {.of = of, .what = OmWhat::topology, .size_class = kFourBytes});
  for (const int index : indices) append_little_endian(bytes, static_cast<std::int32_t>(index));
}

void append_texture(std::string& bytes, const Connectivity& connectivity, const HalfEdges& edges) {
  const TextureCoordinates& texture = connectivity.texture;
  if (texture.coordinates.empty()) return;
  const auto append = [&bytes](const Eigen::Vector2d& uv) {
    for (const double value : uv) append_little_endian(bytes, static_cast<float>(value));
  };
  if (is_textured_by_vertex(connectivity)) {
    append_chunk(bytes, {.of = OmOf::vertices, .what = OmWhat::texture, .dimension = 2});
    for (const Eigen::Vector2d& uv : texture.coordinates) append(uv);
    return;
  }
  std::vector<Eigen::Vector2d> of_halfedges(static_cast<std::size_t>(edges.halfedges()),
                                            Eigen::Vector2d::Zero());
  for (std::size_t corner = 0; corner < texture.corners.size(); ++corner) {
    if (texture.corners[corner] < 0) continue;
    of_halfedges[static_cast<std::size_t>(edges.of_corners()[corner])] =
        texture.coordinates[static_cast<std::size_t>(texture.corners[corner])];
  }
  append_chunk(bytes, {.of = OmOf::halfedges, .what = OmWhat::texture, .dimension = 2});
  for (const Eigen::Vector2d& uv : of_halfedges) append(uv);
}

void append_word(std::string& bytes, const std::string& word) {
  constexpr std::size_t kLongest = 255;
  if (word.size() > kLongest) {
    throw MismatchError("the field's name '" + word + "' is longer than " +
                        std::to_string(kLongest) + " letters, which OpenMesh's files hold");
  }
  append_little_endian(bytes, static_cast<std::uint8_t>(word.size()));
  bytes += word;
}

/// A property of numbers of one type, `columns` a row.
template <typename Number>
void append_property(std::string& bytes, OmOf of, const std::string& name, const std::string& type,
                     const Eigen::MatrixXd& values) {
  append_chunk(
      bytes,
      {.is_named = true, .of = of, .what = OmWhat::custom, .is_signed = false, .is_float = false});
  append_word(bytes, name);
  append_word(bytes, type);
  const std::size_t size = sizeof(Number) * static_cast<std::size_t>(values.size());
  if (size > std::numeric_limits<std::uint32_t>::max()) {
    throw MismatchError("the field '" + name + "' has more values than OpenMesh's files hold");
  }
  append_little_endian(bytes, static_cast<std::uint32_t>(size));
  for (Eigen::Index row = 0; row < values.rows(); ++row) {
    for (Eigen::Index column = 0; column < values.cols(); ++column) {
      append_little_endian(bytes, static_cast<Number>(values(row, column)));
    }
  }
}

}  // namespace

MeshFrame om_frame(const Connectivity& connectivity, bool double_precision,
                   const Context& context) {
  const HalfEdges edges(connectivity.vertices, connectivity.polygons, context);
  MeshFrame result;
  constexpr char kVersion = 2 << 5 | 2;
  result.before = {'O', 'M', 'P', kVersion};
  for (const int count : {connectivity.vertices, connectivity.polygons.size(), edges.edges()}) {
    append_little_endian(result.before, static_cast<std::uint32_t>(count));
  }
  append_chunk(result.before, {.dimension = 3, .size_class = double_precision ? kDouble : 0});
  result.positions = double_precision ? position_bytes<double> : position_bytes<float>;
  append_chunk(
      result.after,
      {.of = OmOf::halfedges, .what = OmWhat::topology, .dimension = 3, .size_class = kFourBytes});
  for (int h = 0; h < edges.halfedges(); ++h) {
    for (const int index : {edges.next(h), edges.to(h), edges.face(h)}) {
      append_little_endian(result.after, static_cast<std::int32_t>(index));
    }
  }
  append_indices(result.after, OmOf::vertices, edges.of_vertices());
  append_indices(result.after, OmOf::faces, edges.of_faces());
  append_texture(result.after, connectivity, edges);
  return result;
}

std::string om_properties(const std::vector<Field>& fields, const Connectivity& connectivity,
                          const Context& context) {
  std::string bytes;
  for (const Field& field : fields) {
    context.report(static_cast<double>(&field - fields.data()) /
                   static_cast<double>(fields.size()));
    const bool on_vertices = field.location == Field::Location::vertices;
    const OmOf of = on_vertices ? OmOf::vertices : OmOf::faces;
    const Eigen::MatrixXd values =
        on_vertices ? field.values : on_polygons(field.values, connectivity);
    constexpr Eigen::Index kMostColumns = 4;
    if (values.cols() > kMostColumns) {
      throw MismatchError("the field '" + field.name + "' has " + std::to_string(values.cols()) +
                          " columns; properties of OpenMesh's files have at most 4");
    }
    const bool whole = field.integer && all_are_held_by<std::int32_t>(values);
    const std::string vector = "Vec" + std::to_string(values.cols());
    if (whole) {
      append_property<std::int32_t>(bytes, of, field.name,
                                    values.cols() == 1 ? "int32_t" : vector + 'i', values);
    } else {
      append_property<double>(bytes, of, field.name, values.cols() == 1 ? "double" : vector + 'd',
                              values);
    }
  }
  append_chunk(bytes, {.of = OmOf::end});
  return bytes;
}

}  // namespace mimetra
