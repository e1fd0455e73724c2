#include <gmock/gmock.h>

#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Utils/PropertyManager.hh>

#include "tests/io/changed_bytes.h"
#include "tests/io/mesh_text.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/mesh_content.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/openmesh.h"

namespace mimetra {
namespace {

using testing::HasSubstr;

struct DoublePoints : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
};
using DoubleMesh = OpenMesh::PolyMesh_ArrayKernelT<DoublePoints>;
using FloatMesh = OpenMesh::PolyMesh_ArrayKernelT<>;
using OpenMesh::FaceHandle;
using OpenMesh::VertexHandle;

template <typename Handle, typename Value, typename Mesh>
void keep(Mesh& mesh, const char* name, const std::function<Value(int)>& value_of) {
  auto property = OpenMesh::getOrMakeProperty<Handle, Value>(mesh, name);
  property.set_persistent(true);
  const int count = static_cast<int>(mesh.template n_elements<Handle>());
  for (int i = 0; i < count; ++i) property[Handle(i)] = value_of(i);
}

/// A strip of two quads and a triangle, with a vertex of no face; OpenMesh's own files hold all
/// that is on it.
template <typename Mesh>
Mesh strip() {
  using Point = typename Mesh::Point;
  Mesh mesh;
  for (int x = 0; x < 3; ++x) {
    mesh.add_vertex(Point(x, 0, 0.1 * x * x));
    mesh.add_vertex(Point(x, 1, 1.0 / 3));
  }
  mesh.add_vertex(Point(3, 0.5, 0));
  mesh.add_vertex(Point(9, 9, 9));
  const auto face = [&mesh](const std::vector<int>& corners) {
    std::vector<VertexHandle> handles;
    handles.reserve(corners.size());
    for (const int corner : corners) handles.push_back(mesh.vertex_handle(corner));
    mesh.add_face(handles);
  };
  face({0, 2, 3, 1});
  face({2, 4, 5, 3});
  face({4, 6, 5});
  return mesh;
}

/// What of a file is read, and the fields on it.
struct Read {
  TriMesh mesh;
  FieldsRead on_it;

  explicit Read(const std::filesystem::path& path)
      : mesh(read_mesh(path)), on_it(read_om_fields(path, mesh.connectivity)) {}

  const Field& field(const std::string& name) const {
    return *std::ranges::find(on_it.fields, name, &Field::name);
  }
};

class OmFile : public testing::Test {
 protected:
  template <typename Mesh>
  void write(const Mesh& mesh, OpenMesh::IO::Options options = {}) const {
    options += OpenMesh::IO::Options::Custom;
    ASSERT_TRUE(OpenMesh::IO::write_mesh(mesh, path_.string(), options));
  }

  template <typename Mesh>
  void expect_same(const Mesh& mesh) const {
    const Read read(path_);
    const TriMesh expected = from_openmesh(mesh);
    EXPECT_EQ(read.mesh.positions, expected.positions);
    EXPECT_EQ(read.mesh.connectivity.polygons, expected.connectivity.polygons);
    EXPECT_EQ(read.mesh.connectivity.texture.corners.size(),
              expected.connectivity.texture.corners.size());
    for (std::size_t corner = 0; corner < read.mesh.connectivity.texture.corners.size(); ++corner) {
      const auto uv_of = [corner](const TextureCoordinates& texture) {
        return texture.coordinates[static_cast<std::size_t>(texture.corners[corner])];
      };
      EXPECT_EQ(uv_of(read.mesh.connectivity.texture), uv_of(expected.connectivity.texture));
    }
  }

  std::string error() const {
    return test::message_of<IoError>([&] { read_mesh(path_); });
  }

  const test::TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "mesh.om";
};

TEST_F(OmFile, OfOpenMeshIsReadAsItWasWritten) {
  write(strip<DoubleMesh>());
  expect_same(strip<DoubleMesh>());
  FloatMesh mesh = strip<FloatMesh>();
  write(mesh);
  expect_same(mesh);
  mesh.request_vertex_texcoords2D();
  for (const auto v : mesh.vertices()) mesh.set_texcoord2D(v, {0.1F * v.idx(), 0.5F});
  write(mesh, OpenMesh::IO::Options::VertexTexCoord);
  expect_same(mesh);
  FloatMesh of_corners = strip<FloatMesh>();
  of_corners.request_halfedge_texcoords2D();
  for (const auto h : of_corners.halfedges()) {
    of_corners.set_texcoord2D(h, {0.1F * h.idx(), 0.25F});
  }
  write(of_corners, OpenMesh::IO::Options::FaceTexCoord);
  expect_same(of_corners);
}

TEST_F(OmFile, OfOpenMeshHasPropertiesOfNumbersAsFields) {
  FloatMesh mesh = strip<FloatMesh>();
  keep<VertexHandle, int>(mesh, "region", [](int v) { return v - 3; });
  keep<VertexHandle, float>(mesh, "weight", [](int v) { return 0.25F * v; });
  keep<VertexHandle, double>(mesh, "distance", [](int v) { return 0.1 * v; });
  keep<VertexHandle, bool>(mesh, "inside", [](int v) { return v % 3 == 0; });
  keep<VertexHandle, std::string>(mesh, "name", [](int) { return "corner"; });
  keep<VertexHandle, OpenMesh::Vec3f>(mesh, "open", [](int v) { return OpenMesh::Vec3f(v, 2, 3); });
  keep<FaceHandle, short>(mesh, "group", [](int f) { return short(-f); });
  mesh.request_vertex_colors();
  mesh.request_face_colors();
  mesh.request_vertex_normals();
  mesh.request_vertex_status();
  mesh.request_face_status();
  mesh.request_edge_status();
  write(mesh, OpenMesh::IO::Options::VertexColor | OpenMesh::IO::Options::FaceColor |
                  OpenMesh::IO::Options::VertexNormal | OpenMesh::IO::Options::Status);
  expect_same(mesh);
  const Read read(path_);
  EXPECT_EQ(read.on_it.fields.size(), 6U);
  EXPECT_THAT(read.on_it.left_out, testing::ElementsAre("name"));  // words are no numbers
  const auto expect = [&read](const std::string& name, bool is_integer, auto value_of) {
    const Field& field = read.field(name);
    EXPECT_EQ(field.integer, is_integer) << name;
    ASSERT_EQ(field.values.rows(), 8) << name;
    for (int v = 0; v < 8; ++v) EXPECT_EQ(field.values(v, 0), value_of(v)) << name << ' ' << v;
  };
  expect("region", true, [](int v) { return v - 3; });
  expect("weight", false, [](int v) { return 0.25 * v; });
  expect("distance", false, [](int v) { return 0.1 * v; });
  expect("inside", true, [](int v) { return v % 3 == 0; });
  expect("open", false, [](int v) { return v; });
  EXPECT_EQ(read.field("open").values.col(2), Eigen::VectorXd::Constant(8, 3));
  const Field& group = read.field("group");
  EXPECT_EQ(group.location, Field::Location::triangles);
  EXPECT_EQ(Eigen::VectorXd(group.values.col(0)),
            (Eigen::VectorXd(5) << 0, 0, -1, -1, -2).finished());
}

/// What is written, as OpenMesh reads it.
TEST_F(OmFile, IsReadByOpenMesh) {
  DoubleMesh given = strip<DoubleMesh>();
  given.request_halfedge_texcoords2D();
  for (const auto h : given.halfedges()) given.set_texcoord2D(h, {0.125F * h.idx(), 0.25F});
  const TriMesh mesh = from_openmesh(given);
  const std::vector<Field> fields = {
      {"region", Field::Location::vertices, Eigen::VectorXd::LinSpaced(8, -1, 6), true},
      {"distance", Field::Location::vertices, Eigen::VectorXd::LinSpaced(8, 0, 1)},
      {"open", Field::Location::vertices, Eigen::MatrixXd::Random(8, 3)},
      {"in_L", Field::Location::triangles, Eigen::VectorXd::LinSpaced(5, 0, 4), true}};
  write_mesh(path_, mesh, {.double_precision = true, .fields = fields});

  DoubleMesh read;
  read.request_halfedge_texcoords2D();
  const auto region = OpenMesh::getOrMakeProperty<VertexHandle, int>(read, "region");
  const auto distance = OpenMesh::getOrMakeProperty<VertexHandle, double>(read, "distance");
  const auto open = OpenMesh::getOrMakeProperty<VertexHandle, OpenMesh::Vec3d>(read, "open");
  const auto in_l = OpenMesh::getOrMakeProperty<FaceHandle, int>(read, "in_L");
  OpenMesh::IO::Options options =
      OpenMesh::IO::Options::Custom | OpenMesh::IO::Options::FaceTexCoord;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(read, path_.string(), options));
  const TriMesh found = from_openmesh(read);
  EXPECT_EQ(found.positions, mesh.positions);
  EXPECT_EQ(found.connectivity.polygons, mesh.connectivity.polygons);
  for (std::size_t corner = 0; corner < mesh.connectivity.texture.corners.size(); ++corner) {
    EXPECT_EQ(found.connectivity.texture.coordinates[corner],
              mesh.connectivity.texture.coordinates[corner]);
  }
  for (const auto v : read.vertices()) {
    EXPECT_EQ(region[v], v.idx() - 1);
    EXPECT_EQ(distance[v], fields[1].values(v.idx(), 0));
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(open[v][axis], fields[2].values(v.idx(), axis));
  }
  EXPECT_EQ(in_l[FaceHandle(0)], 1);
  EXPECT_EQ(in_l[FaceHandle(2)], 4);
  // A border is walked along, and nothing is left over.
  EXPECT_EQ(read.n_edges(), 9U);
  for (const auto v : read.vertices()) {
    EXPECT_EQ(read.is_isolated(v), v.idx() == 7);
    EXPECT_TRUE(read.is_isolated(v) || read.is_boundary(read.halfedge_handle(v)));
  }
}

TEST_F(OmFile, ComesBackWithItsFields) {
  const TriMesh mesh = test::mesh_of(test::sphere(2));
  const Eigen::Index vertices = mesh.positions.rows();
  const std::vector<Field> fields = {
      {"a", Field::Location::vertices, Eigen::MatrixXd::Random(vertices, 4)},
      {"b", Field::Location::triangles,
       Eigen::VectorXd::LinSpaced(mesh.connectivity.triangles.rows(), 0, 1)}};
  write_mesh(path_, mesh, {.double_precision = true, .fields = fields});
  const Read read(path_);
  EXPECT_EQ(read.mesh.positions, mesh.positions);
  EXPECT_EQ(read.mesh.connectivity.polygons, mesh.connectivity.polygons);
  ASSERT_EQ(read.on_it.fields.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(read.on_it.fields[i].name, fields[i].name);
    EXPECT_EQ(read.on_it.fields[i].location, fields[i].location);
    EXPECT_EQ(read.on_it.fields[i].values, fields[i].values);
  }
}

TEST_F(OmFile, OfTheFirstVersionListsCorners) {
  write(strip<FloatMesh>());
  const std::string positions = read_file(path_).substr(16, 2 + 8 * 12);
  const std::string header{'O', 'M', 'P', 1 << 5 | 2, 8, 0, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0};
  const std::string corners{char(0xe8), 0x08, 4, 0, 0, 2, 3, 1, 4, 0, 2, 4, 5, 3, 3, 0, 4, 6, 5};
  write_bytes(path_, header + positions + corners);
  const Polygons expected = from_openmesh(strip<FloatMesh>()).connectivity.polygons;
  EXPECT_EQ(read_mesh(path_).connectivity.polygons, expected);
  FloatMesh by_openmesh;
  ASSERT_TRUE(OpenMesh::IO::read_mesh(by_openmesh, path_.string()));
  EXPECT_TRUE(same_faces(from_openmesh(by_openmesh).connectivity,
                         from_openmesh(strip<FloatMesh>()).connectivity));
}

TEST_F(OmFile, ThatIsBrokenIsRefusedOrRead) {
  FloatMesh mesh = strip<FloatMesh>();
  keep<VertexHandle, int>(mesh, "region", [](int v) { return v; });
  write(mesh);
  const std::string whole = read_file(path_);
  for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
    write_bytes(path_, whole.substr(0, size));
    try {
      EXPECT_EQ(read_mesh(path_).connectivity.polygons.size(), 3) << size;
    } catch (const IoError& failed) {
      EXPECT_THAT(failed.what(), HasSubstr("mesh.om: "));
    }
  }
  test::expect_harmless_changes(whole, path_);
}

TEST_F(OmFile, SaysWhatIsWrongWithIt) {
  write_bytes(path_, "ply\n");
  EXPECT_THAT(error(), HasSubstr("mesh.om: is no mesh of OpenMesh, which begins with 'OM'"));
  write(strip<FloatMesh>());
  std::string bytes = read_file(path_);
  write_bytes(path_, bytes + "17");
  EXPECT_THAT(error(), HasSubstr("2 bytes follow the last element"));
  write_bytes(path_, bytes.substr(0, 60));
  EXPECT_THAT(error(), HasSubstr("ends within the positions of vertices: 42 bytes, expected 96"));
  bytes[3] = 3 << 5;
  write_bytes(path_, bytes);
  EXPECT_THAT(error(), HasSubstr("is of version 3.0, expected 1 or 2"));

  FloatMesh mesh = strip<FloatMesh>();
  mesh.request_face_status();
  mesh.request_edge_status();
  mesh.request_vertex_status();
  mesh.delete_face(FaceHandle(1), false);
  write(mesh, OpenMesh::IO::Options::Status);
  EXPECT_THAT(error(), HasSubstr("face 1 is marked deleted; call garbage_collection()"));
}

TEST_F(OmFile, IsWhatOpenMeshWrites) {
  const TriMesh mesh = from_openmesh(strip<DoubleMesh>());
  write(to_openmesh<DoubleMesh>(mesh));
  const std::string with_doubles = read_file(path_);
  write_mesh(path_, mesh, {.double_precision = true});
  EXPECT_EQ(read_file(path_), with_doubles);
  write(to_openmesh<FloatMesh>(mesh));
  const std::string with_floats = read_file(path_);
  write_mesh(path_, mesh);
  EXPECT_EQ(read_file(path_), with_floats);
}

TEST_F(OmFile, IsWrittenWithoutAWord) {
  const TriMesh mesh = from_openmesh(strip<FloatMesh>());
  testing::internal::CaptureStderr();
  write_mesh(path_, mesh);
  EXPECT_TRUE(omlog().is_enabled());
  omlog().disable();
  write_mesh(path_, mesh);
  EXPECT_FALSE(omlog().is_enabled());
  omlog().enable();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(OmFile, HoldsNoSurfaceThatHalfEdgesCannot) {
  const auto refusal = [this](int vertices, const Polygons& polygons) {
    const TriMesh mesh{Positions::Random(vertices, 3),
                       Connectivity::from_polygons(vertices, polygons)};
    return test::message_of<MismatchError>([&] { write_mesh(path_, mesh); });
  };
  EXPECT_THAT(refusal(5, {{0, 1, 2, 1, 0, 3, 0, 1, 4}, {0, 3, 6, 9}}),
              HasSubstr("mesh.om: 3 sheets of faces meet at vertex 0, which OpenMesh's"));
  EXPECT_THAT(refusal(4, {{0, 1, 2, 0, 1, 3}, {0, 3, 6}}),
              HasSubstr("face 1 is wound against its neighbors"));
  // Two tetrahedra that touch at a vertex.
  EXPECT_THAT(refusal(7, {{0, 1, 2, 0, 2, 3, 0, 3, 1, 1, 3, 2, 0, 4, 5, 0, 5, 6, 0, 6, 4, 4, 6, 5},
                          {0, 3, 6, 9, 12, 15, 18, 21, 24}}),
              HasSubstr("2 sheets of faces meet at vertex 0"));
  EXPECT_THAT(refusal(3, {{0, 1, 1}, {0, 3}}),
              HasSubstr("face 0 has a vertex twice, which OpenMesh's halfedges cannot hold; remove "
                        "the face, or write another format"));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

/// Its writer would cut their numbers off.
TEST_F(OmFile, HoldsVerticesAsFarAsItsEdgesHaveBytes) {
  const auto triangle = [](VertexIndex last) {
    return TriMesh{Positions::Random(last + 1, 3),
                   Connectivity::from_polygons(last + 1, {{0, 1, last}, {0, 3}})};
  };
  write_mesh(path_, triangle(127));
  EXPECT_EQ(read_mesh(path_).connectivity.triangles, triangle(127).connectivity.triangles);
  EXPECT_THAT(test::message_of<MismatchError>([&] { write_mesh(path_, triangle(257)); }),
              HasSubstr("a face uses vertex 257, and OpenMesh's files of 3 edges hold vertices "
                        "below 128; remove vertices without faces, or write another format"));
  // 65 edges and more have two bytes.
  const auto strip = [](VertexIndex last) {
    test::Shape shape = test::grid(20, 2);
    shape.triangles = (shape.triangles.array() == 39).select(last, shape.triangles);
    Positions positions = Positions::Random(last + 1, 3);
    positions.topRows(40) = shape.positions;
    return TriMesh{positions, Connectivity::from_triangles(last + 1, shape.triangles)};
  };
  for (const VertexIndex last : {257, 32767}) {
    write_mesh(path_, strip(last));
    EXPECT_EQ(read_mesh(path_).connectivity.triangles, strip(last).connectivity.triangles);
  }
  EXPECT_THAT(test::message_of<MismatchError>([&] { write_mesh(path_, strip(40000)); }),
              HasSubstr("a face uses vertex 40000"));
}

TEST_F(OmFile, HoldsNoFieldThatOpenMeshDropsOrCuts) {
  const TriMesh mesh = from_openmesh(strip<FloatMesh>());
  const auto refusal = [&](const std::string& name, int columns) {
    const Field field{name, Field::Location::vertices, Eigen::MatrixXd::Zero(8, columns)};
    return test::message_of<MismatchError>([&] { write_mesh(path_, mesh, {.fields = {field}}); });
  };
  EXPECT_THAT(refusal("v:region", 1),
              HasSubstr("mesh.om: OpenMesh writes no property without a name or with"));
  EXPECT_THAT(refusal("", 1), HasSubstr("rename the field ''"));
  EXPECT_THAT(refusal(std::string(256, 'x'), 1), HasSubstr("is longer than 255 letters"));
  EXPECT_THAT(refusal("wide", 5), HasSubstr("the field 'wide' has 5 columns"));
  const Field few{"few", Field::Location::triangles, Eigen::VectorXd::Zero(4)};
  EXPECT_EQ(test::message_of<MismatchError>([&] { write_mesh(path_, mesh, {.fields = {few}}); }),
            path_.string() + ": the field 'few' has 4 values, expected 5");
  EXPECT_FALSE(std::filesystem::exists(path_));
  const Field longest{std::string(255, 'x'), Field::Location::vertices, Eigen::VectorXd::Ones(8)};
  write_mesh(path_, mesh, {.fields = {longest, {"y", longest.location, longest.values, true}}});
  EXPECT_EQ(Read(path_).field(longest.name).values, longest.values);
  EXPECT_EQ(Read(path_).field("y").values, longest.values);
}

TEST_F(OmFile, HasItsFieldsInASequence) {
  const TriMesh mesh = test::mesh_of(test::octahedron());
  const Field heat{"heat", Field::Location::vertices, Eigen::VectorXd::LinSpaced(6, 0, 1)};
  write_mesh(path_, mesh, {.double_precision = true, .fields = {heat}});
  const SequenceRead read = read_sequence(path_.string());
  ASSERT_EQ(read.fields.size(), 1u);
  EXPECT_EQ(read.fields[0].values, heat.values);
  EXPECT_TRUE(read_sequence(path_.string(), {.fields = false}).fields.empty());
}

TEST_F(OmFile, OfAWholeSequenceStandInAFolder) {
  const test::Shape shape = test::octahedron();
  Frames frames(3, shape.positions.size());
  for (int f = 0; f < 3; ++f) {
    frames.row(f) = ((1 + f) * shape.positions).reshaped<Eigen::RowMajor>().transpose();
  }
  const MeshSequence sequence(test::mesh_of(shape).connectivity, frames);
  write_sequence(sequence, folder_ / "take", {.frame_format = "om"});
  EXPECT_EQ(read_sequence((folder_ / "take").string()).sequence.positions(), frames);
}

}  // namespace
}  // namespace mimetra
