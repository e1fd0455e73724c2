#include "toolkit/vtk/poly_data.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>

#include <vtkDataArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include "tests/temporary_folder.h"
#include "tests/vtk/vtp_fixture.h"
#include "toolkit/mesh/errors.h"

namespace mimetra::test {
namespace {

using ::testing::ElementsAre;
using ::testing::Eq;
using ::testing::HasSubstr;

class DisplacedRestOf : public ::testing::Test {
 protected:
  /// Written in single precision.
  static constexpr double kOfSingle = 1e-6;

  int frames() const { return static_cast<int>(sequence_.frames()); }
  Positions way(int frame) const { return sequence_.frame(frame) - sequence_.rest(); }

  /// What is found where each frame has the displacement that `displacement(frame)` gives.
  template <typename Displacement>
  std::optional<Positions> found(Displacement displacement) const {
    DisplacedRest rest(frames());
    for (int frame = 0; frame < frames(); ++frame) {
      vtkNew<vtkPolyData> data;
      set_positions(*data, sequence_.frame(frame), Precision::single_precision);
      add_displacement(*data, displacement(frame));
      if (rest.looks_at(frame)) rest.look_at(*data, positions_of(*data, "mesh"));
    }
    return rest.found("mesh");
  }

  /// Of the second frame alone.
  std::optional<Positions> found_alone(const Positions& displacement, double longer = 1) const {
    vtkNew<vtkPolyData> data;
    set_positions(*data, sequence_.frame(1), Precision::single_precision);
    add_displacement(*data, displacement);
    vtkDataArray* length = data->GetPointData()->GetArray(kDisplacementLength);
    for (vtkIdType v = 0; v < length->GetNumberOfTuples(); ++v) {
      length->SetTuple1(v, longer * length->GetTuple1(v));
    }
    DisplacedRest rest(1);
    rest.look_at(*data, positions_of(*data, "mesh"));
    return rest.found("mesh");
  }

  MeshSequence sequence_ = quad_and_triangle().sequence();
};

TEST_F(DisplacedRestOf, DisplacementsFromOnePoseIsThatPose) {
  const auto rest = found([this](int frame) { return way(frame); });
  ASSERT_TRUE(rest);
  EXPECT_TRUE(rest->isApprox(sequence_.rest(), kOfSingle));
}

TEST_F(DisplacedRestOf, MotionToTheNextFrameIsNone) {
  EXPECT_FALSE(found([this](int frame) {
    return Positions(sequence_.frame(std::min(frame + 1, frames() - 1)) - sequence_.frame(frame));
  }));
}

TEST_F(DisplacedRestOf, DisplacementsThatDoNotFollowTheFramesIsNone) {
  EXPECT_FALSE(found([this](int) { return way(1); }));
  EXPECT_FALSE(found([this](int frame) { return Positions(2 * way(frame)); }));
}

TEST_F(DisplacedRestOf, NumbersThatAreNotKnownIsNone) {
  const Positions unknown = Positions::Constant(5, 3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(found([&](int) { return unknown; }));
}

/// A motion of tenths far from the origin, whose steps to the next frame are called displacements,
/// or which has displacements from its rest pose.
std::optional<Positions> found_far_away(int precision, bool from_rest) {
  constexpr int kFrames = 3;
  const Eigen::RowVector3d far(5e5, 5e6, 0);
  const Positions rest = quad_and_triangle().sequence().rest().rowwise() + far;
  const Positions way = Positions::Constant(5, 3, 0.1);
  DisplacedRest displaced(kFrames);
  for (int frame = 0; frame < kFrames; ++frame) {
    const Positions positions = rest + frame * way;
    const auto array_of = [&](const Positions& rows) {
      const auto array =
          vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(precision));
      array->SetNumberOfComponents(3);
      for (const auto& row : rows.rowwise()) array->InsertNextTuple3(row[0], row[1], row[2]);
      return array;
    };
    vtkNew<vtkPoints> points;
    points->SetData(array_of(positions));
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    const auto array = array_of(from_rest ? Positions(frame * way) : way);
    array->SetName(kDisplacement);
    data->GetPointData()->AddArray(array);
    displaced.look_at(*data, positions_of(*data, "mesh"));
  }
  return displaced.found("mesh");
}

TEST_F(DisplacedRestOf, PointsFarFromTheOriginNeedDoublePrecision) {
  EXPECT_TRUE(found_far_away(VTK_DOUBLE, true));
  EXPECT_FALSE(found_far_away(VTK_DOUBLE, false));
  EXPECT_FALSE(found_far_away(VTK_FLOAT, false));
}

TEST_F(DisplacedRestOf, OneFrameIsKnownByTheLengthBesideIt) {
  const auto rest = found_alone(way(1));
  ASSERT_TRUE(rest);
  EXPECT_TRUE(rest->isApprox(sequence_.rest(), kOfSingle));
  EXPECT_FALSE(found_alone(way(1), 1.001));
}

TEST_F(DisplacedRestOf, AVertexThatIsNotFiniteIsRefused) {
  Positions broken = way(1);
  broken(2, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(message_of<IoError>([&] { found_alone(broken); }),
              Eq("mesh: rest pose: vertex 2 has no usable position"));
}

TEST(DisplacedRest, LooksAtTheFirstAndTheLastFrameAndSomeBetween) {
  const auto looked_at = [](int count) {
    const DisplacedRest rest(count);
    std::vector<int> frames;
    for (int frame = 0; frame < count; ++frame) {
      if (rest.looks_at(frame)) frames.push_back(frame);
    }
    return frames;
  };
  EXPECT_THAT(looked_at(1), ElementsAre(0));
  EXPECT_THAT(looked_at(3), ElementsAre(0, 1, 2));
  EXPECT_THAT(looked_at(120), ElementsAre(0, 15, 30, 45, 60, 75, 90, 105, 119));
}

using DisplacedSeries = VtpTest;

TEST_F(DisplacedSeries, OfOthersIsAFieldAndNoRestPose) {
  FieldSequence written = quad_and_triangle();
  written.displacement = false;
  const Eigen::MatrixXd velocity = Eigen::MatrixXd::Constant(5, 3, 0.25);
  written.fields.push_back({kDisplacement, Field::Location::vertices, velocity});
  write_vtp_series(written, in_folder("face.pvd"));
  const FieldSequence read = read_vtp_series(in_folder("face.pvd"));
  EXPECT_FALSE(read.sequence().rest_is_known());
  EXPECT_TRUE(read.sequence().rest() == read.sequence().frame(0));
  const auto found = std::ranges::find(read.fields, kDisplacement, &Field::name);
  ASSERT_NE(found, read.fields.end());
  EXPECT_TRUE(found->values == velocity);
}

}  // namespace
}  // namespace mimetra::test
