#include "toolkit/model/expression_notes.h"

#include <cmath>

#include <gmock/gmock.h>
#include <Eigen/Geometry>

#include "tests/shapes.h"

namespace mimetra {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::shared_ptr<const BlendshapeModel> two_waves() {
  const test::Shape shape = test::grid(4, 4);
  ShapeBasis basis{{"wave0", "wave1"}, Eigen::MatrixXd(shape.positions.size(), 2)};
  for (int j = 0; j < basis.size(); ++j) {
    for (Eigen::Index i = 0; i < basis.displacements.rows(); ++i) {
      basis.displacements(i, j) = std::sin(0.3 * static_cast<double>(i) + j);
    }
  }
  return std::make_shared<const BlendshapeModel>(
      std::make_shared<const Connectivity>(Connectivity::from_triangles(16, shape.triangles)),
      shape.positions, basis);
}

TEST(DisplacedExpressions, AreThoseThatMoveEveryVertex) {
  const auto model = two_waves();
  ShapeBasis shapes = model->expressions();
  shapes.displacements.col(0).setConstant(0.5);  // elsewhere
  shapes.displacements.col(1).setConstant(0.5);
  shapes.displacements.col(1).head<3>().setZero();  // one vertex stays
  EXPECT_THAT(displaced_expressions(model->neutral(), model->triangles(), shapes),
              testing::ElementsAre("wave0"));
  EXPECT_THAT(notes_on_expressions("m", model->neutral(), model->triangles(), shapes),
              testing::ElementsAre(HasSubstr("m: expressions of another place, turn or size")));
  // As a statistical model's: every vertex, each its own way.
  for (Eigen::Index i = 0; i < shapes.displacements.rows(); ++i) {
    shapes.displacements(i, 0) = i % 2 ? 0.5 : -0.5;
  }
  EXPECT_THAT(displaced_expressions(model->neutral(), model->triangles(), shapes),
              testing::IsEmpty());
  shapes.displacements.setZero();
  EXPECT_THAT(notes_on_expressions("m", model->neutral(), model->triangles(), shapes),
              testing::IsEmpty());
}

TEST(DisplacedExpressions, AreThoseThatAreTurnedOrHaveAnotherSize) {
  const auto plane = two_waves();
  const BlendshapeModel& model = *plane;
  ShapeBasis shapes = model.expressions();
  const Positions& neutral = model.neutral();
  const auto column = [&](const Positions& pose) {
    return Eigen::VectorXd((pose - neutral).reshaped<Eigen::RowMajor>());
  };
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(EIGEN_PI / 2, Eigen::Vector3d::UnitX()).toRotationMatrix();
  shapes.displacements.col(0) = column(neutral * turn.transpose());
  shapes.displacements.col(1) = column(10 * neutral);
  EXPECT_THAT(displaced_expressions(neutral, model.triangles(), shapes),
              testing::ElementsAre("wave0", "wave1"));
}

/// A face that looks along z, with its left along x and its mouth at the bottom.
struct Face {
  Face() : Face(test::grid(9, 9)) {}
  explicit Face(const test::Shape& grid) : neutral(grid.positions), triangles(grid.triangles) {
    neutral.rowwise() -= Eigen::RowVector3d(4, 4, 0);
    for (int v = 0; v < neutral.rows(); ++v) neutral(v, 2) = -0.1 * neutral.row(v).squaredNorm();
  }

  /// Moves the surface around (x, y) outwards.
  void add(const std::string& name, double x, double y) {
    Eigen::VectorXd field = Eigen::VectorXd::Zero(neutral.size());
    for (int v = 0; v < neutral.rows(); ++v) {
      const double away2 = std::pow(neutral(v, 0) - x, 2) + std::pow(neutral(v, 1) - y, 2);
      field(3 * v + 2) = std::exp(-away2);
    }
    shapes.names.push_back(name);
    shapes.displacements.conservativeResize(neutral.size(), shapes.size());
    shapes.displacements.rightCols(1) = field;
  }

  /// All of it under a linear map.
  void map(const Eigen::Matrix3d& by) {
    neutral = (neutral * by.transpose()).eval();
    for (int j = 0; j < shapes.size(); ++j) {
      auto field = shapes.displacements.col(j).reshaped(3, neutral.rows());
      field = (by * field).eval();
    }
  }

  void wind_the_other_way() { triangles.col(1).swap(triangles.col(2)); }

  ExchangedSides sides() const { return exchanged_sides(neutral, triangles, shapes); }
  std::vector<std::string> notes() const {
    return notes_on_expressions("f", neutral, triangles, shapes);
  }

  Positions neutral;
  Triangles triangles;
  ShapeBasis shapes;
};

Face face_with_names() {
  Face face;
  face.add("eyeBlink_L", 2, 2);
  face.add("eyeBlink_R", -2, 2);
  face.add("mouthSmileLeft", 1, -2);
  face.add("mouthSmileRight", -1, -2);
  face.add("cheekPuff.l", 2, -1);
  face.add("cheekPuff.r", -2, -1);
  face.add("jawOpen", 0, -3);
  return face;
}

const Eigen::Matrix3d kSomeTurn =
    Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, -2).normalized()).toRotationMatrix();

TEST(ExpressionNotes, NameExpressionsThatAreWrittenInTwoWays) {
  Face face = face_with_names();
  face.add("eye_blink_left", 2, 2);
  EXPECT_THAT(
      face.notes(),
      ElementsAre(HasSubstr(
          "'eyeBlink_L' and 'eye_blink_left'; weights with a column for one of them drive both")));
}

TEST(ExchangedSides, AreNoneInAFaceHoweverItIsTurned) {
  Face face = face_with_names();
  EXPECT_THAT(face.notes(), IsEmpty());
  face.map(kSomeTurn);
  EXPECT_THAT(face.notes(), IsEmpty());
  face.wind_the_other_way();
  EXPECT_THAT(face.sides().left_halves, IsEmpty());
}

TEST(ExchangedSides, AreAllInAMirrorImage) {
  for (const bool wound : {false, true}) {
    Face face = face_with_names();
    face.map(kSomeTurn * Eigen::Vector3d(-1, 1, 1).asDiagonal());
    if (wound) face.wind_the_other_way();
    EXPECT_TRUE(face.sides().everywhere);
    EXPECT_THAT(face.sides().left_halves,
                ElementsAre("eyeBlink_L", "mouthSmileLeft", "cheekPuff.l"));
    EXPECT_THAT(face.notes(), ElementsAre(HasSubstr("f: expressions of the left move the face's "
                                                    "right: eyeBlink_L, mouthSmileLeft")));
  }
}

TEST(ExchangedSides, AreThoseOfOnePair) {
  Face face = face_with_names();
  face.shapes.displacements.col(2).swap(face.shapes.displacements.col(3));
  EXPECT_FALSE(face.sides().everywhere);
  EXPECT_THAT(face.notes(), ElementsAre(HasSubstr("others call right: mouthSmileLeft; exchange")));
}

TEST(ExchangedSides, NeedNamesToTellUpForAWholeFace) {
  Face face = face_with_names();
  face.map(Eigen::Vector3d(-1, 1, 1).asDiagonal());
  face.shapes.names = {"a_L", "a_R", "b_L", "b_R", "c_L", "c_R", "d"};
  EXPECT_THAT(face.notes(), IsEmpty());
  face.shapes.displacements.col(2).swap(face.shapes.displacements.col(3));
  EXPECT_THAT(face.sides().left_halves, ElementsAre("b_L"));
}

TEST(TornExpressions, AreThoseWithVerticesInAnotherOrder) {
  Face face = face_with_names();
  EXPECT_THAT(torn_expressions(face.neutral, face.triangles, face.shapes), IsEmpty());
  const auto set_pose = [&face](int j, const Positions& pose) {
    face.shapes.displacements.col(j) = (pose - face.neutral).reshaped<Eigen::RowMajor>();
  };
  Positions shuffled(81, 3);
  for (int v = 0; v < 81; ++v) shuffled.row(v) = face.neutral.row(37 * v % 81);
  set_pose(1, shuffled);
  // Two that lie far apart in each other's place.
  Positions exchanged = face.neutral;
  exchanged.row(20).swap(exchanged.row(60));
  set_pose(6, exchanged);
  EXPECT_THAT(torn_expressions(face.neutral, face.triangles, face.shapes),
              ElementsAre("eyeBlink_R", "jawOpen"));
  EXPECT_THAT(face.notes(), testing::Contains(HasSubstr("tear the neutral's surface")));
}

TEST(ExchangedSides, TellNothingWhereHalvesMoveTheSameOrNothing) {
  Face face;
  for (const char* name : {"eyeBlink_L", "eyeBlink_R"}) face.add(name, 0, 2);
  for (const char* name : {"mouthSmile_L", "mouthSmile_R"}) face.add(name, 0, -2);
  EXPECT_THAT(face.notes(), IsEmpty());
  face.shapes.displacements.setZero();
  EXPECT_THAT(face.notes(), IsEmpty());
}

}  // namespace
}  // namespace mimetra
