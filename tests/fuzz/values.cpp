#include "tests/fuzz/values.h"

#include <limits>

#include "tests/shapes.h"

namespace mimetra::fuzz {

namespace {

constexpr int kVertices = 9;

MeshSequence take(int count) {
  Frames frames(count, 3 * kVertices);
  for (int f = 0; f < count; ++f) {
    Positions moved = grid().positions;
    moved(4, 2) += f;
    frames.row(f) = Eigen::Map<const Eigen::RowVectorXd>(moved.data(), moved.size());
  }
  return {grid().connectivity, std::move(frames), Eigen::VectorXd::LinSpaced(count, 0, 0.08),
          grid().positions};
}

FieldSequence take_with_field(int count) {
  return {take(count), {{"heat", Field::Location::vertices, Eigen::VectorXd::Ones(kVertices)}}};
}

ShapeBasis basis(const std::vector<std::string>& names) {
  return {names, Eigen::MatrixXd::Identity(3 * kVertices, Eigen::Index(names.size()))};
}

ModelData model() {
  return {{std::make_shared<Connectivity>(grid().connectivity),
           grid().positions,
           {{}, {}},
           basis({"smile", "jawOpen"})},
          {{"smile", "jawOpen"}, Eigen::MatrixXd::Constant(3, 2, 0.5), Eigen::Vector3d(0, 0.5, 1)}};
}

Components components() {
  Components two;
  two.rest = grid().positions;
  two.triangles = grid().connectivity.triangles;
  two.displacements = Frames::Constant(2, 3 * kVertices, 0.5);
  two.weights = Eigen::MatrixXd::Constant(3, 2, 1);
  two.centers = {4, 0};
  two.support = Eigen::MatrixXd::Constant(2, kVertices, 0.5);
  two.energies = {2, 1};
  return two;
}

RegionData regions() {
  return {regions_from_vertices(kVertices, grid().connectivity.triangles, {{0, 1}, {4, 5}}),
          {take(3), {{"roi", Field::Location::vertices, Eigen::VectorXd::Ones(kVertices), true}}}};
}

LandmarkTrack landmarks() {
  LandmarkTrack track;
  track.names = {"1", "2", "3", "4", "5"};
  track.points = Frames::Random(2, 10);
  track.times = Eigen::Vector2d(0, 0.04);
  return track;
}

FittedCoefficients fit() {
  FittedCoefficients fit;
  fit.identities = {"wide"};
  fit.expressions = {"smile", "brow"};
  fit.times = Eigen::Vector2d(0, 0.04);
  fit.alpha = Eigen::MatrixXd::Constant(2, 1, 0.5);
  fit.beta = Eigen::MatrixXd::Constant(2, 2, 0.25);
  fit.cameras.assign(2, Eigen::Matrix<double, 2, 4>::Constant(2));
  fit.rms = Eigen::Vector2d(1.5, std::numeric_limits<double>::quiet_NaN());
  fit.landmarks = Eigen::Vector2i(68, 0);
  fit.iterations = Eigen::Vector2i(3, 0);
  return fit;
}

}  // namespace

const TriMesh& grid() {
  static const TriMesh mesh = [] {
    const test::Shape shape = test::grid(3, 3);
    TriMesh made{shape.positions, Connectivity::from_triangles(kVertices, shape.triangles)};
    TextureCoordinates& texture = made.connectivity.texture;
    for (int v = 0; v < kVertices; ++v) {
      texture.coordinates.emplace_back(shape.positions(v, 0) / 2, shape.positions(v, 1) / 2);
    }
    texture.corners = made.connectivity.polygons.corners;
    made.connectivity.groups = {{2, "g lips"}};
    return made;
  }();
  return mesh;
}

Data one_frame() {
  return take_with_field(1);
}

Data value_of(DataKind kind) {
  switch (kind) {
    case DataKind::sequence:
      return take_with_field(3);
    case DataKind::model:
      return model();
    case DataKind::components:
      return components();
    case DataKind::regions:
      return regions();
    case DataKind::table:
      return Table{{"time", "smile"}, {{0.0, 0.5}, {0.04, 1.0}}};  // read as weights
    case DataKind::landmarks:
      return landmarks();
    case DataKind::fit:
      return fit();
    case DataKind::pictures:
      return Pictures::of(Image(4, 3, {255, 128, 0}));
    case DataKind::document:
      return Document{"a text"};
  }
  return {};
}

}  // namespace mimetra::fuzz
