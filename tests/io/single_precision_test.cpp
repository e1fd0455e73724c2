// Numbers that are finite in double and infinite in single precision.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/formats/sequence_file.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/mesh/mesh_sequence.h"

namespace mimetra {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Two frames of a grid, in the second of which vertex 7 is far beyond single precision.
MeshSequence leaping_grid() {
  const test::Shape shape = test::grid(4, 4);
  Frames frames(2, shape.positions.size());
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(shape.positions.data(), frames.cols());
  frames(1, 3 * 7 + 2) = -1e39;
  return {Connectivity::from_triangles(16, shape.triangles), frames};
}

TEST(SinglePrecision, IsLeftForDoubleInMeshFilesThatHaveIt) {
  const test::TemporaryFolder folder;
  for (const std::string format : {"ply", "obj", "off"}) {
    const auto place = folder / format;
    write_sequence(leaping_grid(), place, {.frame_format = format});
    EXPECT_EQ(read_sequence(place).sequence.positions(), leaping_grid().positions());
    const auto one = folder / ("one." + format);
    write_sequence(leaping_grid().slice(1, 2), one);
    EXPECT_EQ(read_mesh(one).positions, leaping_grid().frame(1));
  }
}

TEST(SinglePrecision, RefusesWhatItCannotHoldAndNamesFrameAndVertex) {
  const auto refusal = [](const std::string& name, const WriteOptions& options = {}) {
    const test::TemporaryFolder folder;
    std::string message = test::message_of<MismatchError>(
        [&] { write_sequence(leaping_grid(), folder / name, options); });
    EXPECT_TRUE(folder.names().empty());
    return message;
  };
  const auto names_it =
      AllOf(HasSubstr("frame 1: vertex 7 is at 1e+39"), HasSubstr("write double"));
  EXPECT_THAT(refusal("take.pc2"), names_it);
  EXPECT_THAT(refusal("take.mdd"), names_it);
  EXPECT_THAT(refusal("take.glb"), names_it);
  EXPECT_THAT(refusal("take.npy", {.single_precision = true}), names_it);
  EXPECT_THAT(refusal("take.npz", {.single_precision = true}), names_it);
  EXPECT_THAT(refusal("take", {.frame_format = "stl"}),
              HasSubstr("take/frame_0001.stl: vertex 7 is at 1e+39"));
}

TEST(SinglePrecision, ThatIsAskedForIsRefusedWhereItWouldRoundMotion) {
  const test::Shape shape = test::grid(4, 4);
  const Positions far_away = shape.positions.rowwise() + Eigen::RowVector3d(4.5e6, 5e5, 100);
  const MeshSequence take(Connectivity::from_triangles(16, shape.triangles),
                          Frames(far_away.reshaped<Eigen::RowMajor>().transpose()));
  for (const char* name : {"take.npy", "take.npz", "take.h5"}) {
    const test::TemporaryFolder folder;
    EXPECT_THAT(test::message_of<MismatchError>(
                    [&] { write_sequence(take, folder / name, {.single_precision = true}); }),
                AllOf(HasSubstr("option 'single' would round motion that one sees"),
                      HasSubstr("1.5e+06 times its size from the origin; leave the option out")))
        << name;
    EXPECT_TRUE(folder.names().empty()) << name;
    write_sequence(take, folder / name);
    EXPECT_EQ(read_sequence(folder / name).sequence.positions(), take.positions()) << name;
  }
}

TEST(SinglePrecision, OfOneMeshIsRefusedWhereNobodyAskedForMore) {
  const test::TemporaryFolder folder;
  const MeshSequence sequence = leaping_grid();
  for (const char* name : {"a.ply", "a.obj", "a.off", "a.stl"}) {
    EXPECT_THROW(write_mesh(folder / name, sequence.frame(1), sequence.connectivity()),
                 MismatchError)
        << name;
  }
}

}  // namespace
}  // namespace mimetra
