#include "toolkit/correspondence/markers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <Eigen/QR>

#include "tests/shapes.h"
#include "toolkit/correspondence/correspondence.h"
#include "toolkit/mesh/errors.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::ThrowsMessage;

const std::vector<Marker> kOctahedron = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}};

auto refused(const std::vector<Marker>& markers, const std::string& why) {
  const Positions sphere = test::sphere(1).positions;
  EXPECT_THAT([&] { check_markers(markers, sphere, sphere); },
              ThrowsMessage<MismatchError>(HasSubstr(why)));
}

TEST(Markers, NeedTheirVertices) {
  refused({{0, 0}, {18, 1}, {2, 2}, {4, 4}},
          "marker 2: vertex 18 of the source, which has vertices 0 to 17");
  refused({{0, 0}, {1, -1}, {2, 2}, {4, 4}}, "marker 2: vertex -1 of the target");
}

TEST(Markers, HaveEachVertexOnce) {
  refused({{0, 0}, {1, 1}, {2, 2}, {0, 4}}, "marker 4: vertex 0 of the source is in marker 1 too");
  refused({{0, 0}, {1, 1}, {2, 2}, {4, 1}}, "marker 4: vertex 1 of the target is in marker 2 too");
}

TEST(Markers, AreAtLeastFourAndNotInOnePlane) {
  refused({{0, 0}, {2, 2}, {4, 4}}, "3 markers, expected at least 4");
  refused({{0, 0}, {1, 1}, {2, 2}, {3, 3}}, "the markers lie in one plane of the source");
}

TEST(Markers, ThatAnAffineMapExplainsAreFineAndLeaveNothing) {
  const Positions source = test::sphere(1).positions;
  Eigen::Matrix3d shear;
  shear << 2, 1, 0, 0, 1, 0.5, 0, 0, 3;
  const Positions target = source * shear;
  EXPECT_NO_THROW(check_markers(kOctahedron, source, target));
  EXPECT_LT(affine_residual(kOctahedron, source, target), 1e-14);
}

/// Every third vertex of a sphere of 66.
std::vector<Marker> every_third() {
  std::vector<Marker> markers;
  for (VertexIndex v = 0; v < 66; v += 3) markers.push_back({v, v});
  return markers;
}

/// The sphere bent smoothly, symmetric about x = 0 only: it has a nose and leans forward.
Positions bent(const Positions& sphere) {
  Positions result = sphere;
  for (auto place : result.rowwise()) {
    const double x = place[0], y = place[1], z = place[2];
    place << x * (1 + 0.2 * y), y + 0.3 * z * z, z * (z > 0 ? 1.4 : 0.8) + 0.2 * y;
  }
  return result;
}

TriMesh bent_sphere() {
  test::Shape shape = test::sphere(2);
  shape.positions = bent(shape.positions);
  return test::mesh_of(shape);
}

/// With triangles that lead the other way round.
TriMesh inside_out(TriMesh mesh) {
  Triangles triangles = mesh.connectivity.triangles;
  triangles.col(1).swap(triangles.col(2));
  mesh.connectivity = Connectivity::from_triangles(mesh.connectivity.vertices, triangles);
  return mesh;
}

/// Left is right, and the faces stay as they are written: they lead the other way round.
TriMesh reflected(TriMesh mesh) {
  mesh.positions.col(0) *= -1;
  return mesh;
}

void exchange(std::vector<Marker>& markers, std::size_t i, std::size_t j) {
  std::swap(markers[i].target, markers[j].target);
}

/// What the spline of all markers but one, solved for by itself, leaves of that one: its square.
double left_out_by_itself(const std::vector<Marker>& markers, std::size_t left_out,
                          const Positions& source, const Positions& target) {
  const auto all = static_cast<Eigen::Index>(markers.size());
  double mean = 0;
  for (const Marker& a : markers) {
    for (const Marker& b : markers) mean += (source.row(a.source) - source.row(b.source)).norm();
  }
  mean /= static_cast<double>(all * all);
  std::vector<Marker> others = markers;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(left_out));
  const auto n = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n + 4, n + 4), values = Eigen::MatrixXd::Zero(n + 4, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::RowVector3d a = source.row(others[i].source);
    for (Eigen::Index j = 0; j < n; ++j) K(i, j) = -(a - source.row(others[j].source)).norm();
    K(i, i) += kMarkerLooseness * mean;
    K.row(i).tail(4) << 1, a;
    K.col(i).tail(4) << 1, a.transpose();
    values.row(i) = target.row(others[i].target);
  }
  const Eigen::MatrixXd coefficients = K.fullPivHouseholderQr().solve(values);
  const Eigen::RowVector3d at = source.row(markers[left_out].source);
  Eigen::RowVectorXd basis(n + 4);
  for (Eigen::Index j = 0; j < n; ++j) basis[j] = -(at - source.row(others[j].source)).norm();
  basis.tail(4) << 1, at;
  return (basis * coefficients - target.row(markers[left_out].target)).squaredNorm();
}

TEST(MarkerCheck, LeavesOneOutAsASolveWithoutItDoes) {
  const Positions source = test::sphere(2).positions, target = bent(source);
  const std::vector<Marker> markers = every_third();
  double sum = 0, size = 0;
  Eigen::RowVector3d centre = Eigen::RowVector3d::Zero();
  for (const Marker& marker : markers) centre += target.row(marker.target) / double(markers.size());
  for (std::size_t i = 0; i < markers.size(); ++i) {
    sum += left_out_by_itself(markers, i, source, target);
    size += (target.row(markers[i].target) - centre).squaredNorm();
  }
  const double expected = std::sqrt(sum / size);
  EXPECT_NEAR(left_out_residual(markers, source, target), expected, 1e-9 * expected);
}

TEST(MarkerCheck, FindsNothingWhereAFaceIsBent) {
  const Positions source = test::sphere(2).positions;
  EXPECT_THAT(doubtful_markers(every_third(), source, bent(source)), IsEmpty());
  EXPECT_THAT(doubtful_markers(every_third(), source, source), IsEmpty());
}

TEST(MarkerCheck, NamesTwoThatAreExchanged) {
  const Positions source = test::sphere(2).positions, target = bent(source);
  for (std::size_t i = 0; i < 22; ++i) {
    std::vector<Marker> markers = every_third();
    const std::size_t j = (i + 7) % 22;
    exchange(markers, i, j);
    const auto doubtful = doubtful_markers(markers, source, target);
    ASSERT_EQ(doubtful.size(), 2u) << i;
    EXPECT_EQ(doubtful[0].marker, std::min(i, j));
    EXPECT_EQ(doubtful[0].exchanged_with, std::max(i, j));
    EXPECT_EQ(doubtful[1].exchanged_with, std::min(i, j));
  }
}

TEST(MarkerCheck, NamesTwoPairsThatAreExchanged) {
  const Positions source = test::sphere(2).positions;
  std::vector<Marker> markers = every_third();
  exchange(markers, 2, 9);
  exchange(markers, 5, 17);
  const auto doubtful = doubtful_markers(markers, source, bent(source));
  EXPECT_THAT(described(doubtful, markers),
              testing::UnorderedElementsAre(
                  HasSubstr("marker 3 (vertices 6 and 27) and marker 10 (vertices 27 and 6) are"),
                  HasSubstr("marker 6 (vertices 15 and 51) and marker 18")));
}

TEST(MarkerCheck, NamesOneAtAWrongPlace) {
  const Positions source = test::sphere(2).positions, target = bent(source);
  std::vector<Marker> markers = every_third();
  markers[4].target = 1;  // the vertex opposite of 0
  const auto doubtful = doubtful_markers(markers, source, target);
  ASSERT_EQ(doubtful.size(), 1u);
  EXPECT_EQ(doubtful[0].marker, 4u);
  EXPECT_FALSE(doubtful[0].exchanged_with);
  const auto names = std::vector<std::string>(22, "m.txt, line 9");
  EXPECT_THAT(described(doubtful, markers, names),
              ElementsAre(testing::StartsWith("m.txt, line 9 (vertices 12 and 1) is ")));
}

TEST(MarkerCheck, SaysNothingOfFew) {
  const Positions source = test::sphere(1).positions;
  std::vector<Marker> markers = {{0, 0}, {1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {9, 9}};
  exchange(markers, 0, 1);
  EXPECT_THAT(doubtful_markers(markers, source, source), IsEmpty());
}

TEST(MarkerCheck, KnowsAnotherBaseFitBetterShifted) {
  const Positions sphere = test::sphere(2).positions;
  // The numbers of neighbours tell nothing about places: shifted markers are scattered.
  const std::vector<Marker> right = {{0, 0},   {7, 7},   {12, 12}, {25, 25},
                                     {33, 33}, {47, 47}, {60, 60}};
  std::vector<Marker> wrong;
  wrong.reserve(right.size());
  for (const Marker& marker : right) wrong.push_back({marker.source + 1, marker.target + 1});
  Positions target = sphere;
  // The same sphere with its vertices in an order of its own.
  std::vector<Marker> right_there = right, wrong_there;
  for (Marker& marker : right_there) marker.target = 65 - marker.target;
  for (int v = 0; v < 66; ++v) target.row(65 - v) = sphere.row(v);
  for (const Marker& m : right_there) wrong_there.push_back({m.source + 1, m.target + 1});
  EXPECT_TRUE(fit_better_shifted(wrong_there, 1, sphere, target));
  EXPECT_FALSE(fit_better_shifted(right_there, 1, sphere, target));
  EXPECT_FALSE(fit_better_shifted(right_there, -1, sphere, target));
}

TEST(MarkerCheck, KnowsAnotherBaseByMarkersBeyondTheMesh) {
  const Positions sphere = test::sphere(1).positions;
  const std::vector<Marker> from_one = {{1, 1}, {2, 2}, {3, 3}, {4, 4}, {5, 5}, {18, 18}};
  EXPECT_TRUE(fit_better_shifted(from_one, 1, sphere, sphere));
}

TEST(MarkerSides, AreTurnedWhereATargetIsInsideOut) {
  const TriMesh source = test::mesh_of(test::sphere(2)), target = bent_sphere();
  EXPECT_FALSE(is_inside_out(source, target, every_third()));
  EXPECT_TRUE(is_inside_out(source, inside_out(target), every_third()));
  EXPECT_TRUE(is_inside_out(inside_out(source), target, every_third()));
  EXPECT_FALSE(is_inside_out(inside_out(source), inside_out(target), every_third()));
  EXPECT_FALSE(is_inside_out(target, reflected(target), every_third())) << "a mirror image";
}

TEST(MarkerSides, RefuseAMirroredMesh) {
  const TriMesh source = test::mesh_of(test::sphere(2)), target = bent_sphere();
  for (const TriMesh& wrong : {reflected(target), inside_out(reflected(target))}) {
    EXPECT_THAT([&] { is_inside_out(source, wrong, every_third()); },
                ThrowsMessage<MismatchError>(HasSubstr("left and right are exchanged in them, or "
                                                       "one of the meshes is mirrored")));
  }
}

TEST(MarkerSides, RefuseMarkersWithLeftAndRightExchanged) {
  const TriMesh target = bent_sphere();
  std::vector<Marker> markers;
  for (const Marker& marker : every_third()) {
    Eigen::RowVector3d there = target.positions.row(marker.target);
    there[0] *= -1;
    VertexIndex nearest = 0;
    (target.positions.rowwise() - there).rowwise().norm().minCoeff(&nearest);
    markers.push_back({marker.source, nearest});
  }
  EXPECT_THROW(is_inside_out(bent_sphere(), target, markers), MismatchError);
  EXPECT_THROW(find_correspondence(bent_sphere(), target, markers), MismatchError);
}

TEST(MarkerSides, ChangeNoPairOfTriangles) {
  const TriMesh source = test::mesh_of(test::sphere(2)), target = bent_sphere();
  const FoundCorrespondence upright = find_correspondence(source, target, every_third()),
                            turned = find_correspondence(source, inside_out(target), every_third());
  EXPECT_FALSE(upright.inside_out);
  EXPECT_TRUE(turned.inside_out);
  EXPECT_EQ(turned.correspondence.parts, upright.correspondence.parts);
  EXPECT_EQ(turned.correspondence.offsets, upright.correspondence.offsets);
}

}  // namespace
}  // namespace mimetra
