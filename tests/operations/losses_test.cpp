// What a format has no place for is said where something is written in it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/shapes.h"
#include "toolkit/io/file_parameters.h"
#include "toolkit/operations/operation.h"

namespace mimetra {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Two quads of two groups and materials, numbered backwards, and a frame in which they have moved.
/// The texture has a seam where it is asked for.
FieldSequence quads(bool seam) {
  Connectivity faces =
      Connectivity::from_polygons(6, Polygons{{5, 4, 1, 2, 4, 3, 0, 1}, {0, 4, 8}});
  faces.texture.coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5, 0}};
  faces.texture.corners = {0, 1, 2, 3, 1, 0, 0, 2};
  if (seam) faces.texture.corners[4] = 4;
  faces.groups = {{0, "g lips"}, {1, "usemtl skin"}};
  Positions rest(6, 3);
  rest << 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 1, 1, 0, 2, 1, 0;
  Frames frames(2, 18);
  frames.rowwise() = Eigen::Map<const Eigen::RowVectorXd>(rest.data(), 18);
  frames.array() += 1;
  return FieldSequence(MeshSequence(std::move(faces), std::move(frames), {}, rest));
}

std::vector<std::string> notes_on(const FieldSequence& sequence, const std::string& target,
                                  const std::string& folder_format = "") {
  OperationTable table;
  add_toolkit(table);
  const Format& format = table.writer({"out", DataKind::sequence, ""}, target);
  Parameters parameters(format.writing);
  if (!folder_format.empty()) parameters.set("format", folder_format);
  return notes_on_losses(format, sequence, target, write_options(format.writing, parameters));
}

TEST(Losses, AreNamedInOneLine) {
  EXPECT_THAT(
      notes_on(quads(false), "take.stl"),
      ElementsAre("take.stl: this format holds no faces of more than three corners, texture "
                  "coordinates, groups, materials, rest pose or order of vertices; written "
                  "without"));
  EXPECT_THAT(notes_on(quads(false), "take.off"),
              ElementsAre(HasSubstr("holds no texture coordinates, groups, materials or rest")));
}

TEST(Losses, OfAFolderAreThoseOfItsFiles) {
  EXPECT_THAT(notes_on(quads(true), "take/", "obj"), IsEmpty());
  EXPECT_THAT(notes_on(quads(true), "take/", "off"), ElementsAre(HasSubstr("texture")));
  EXPECT_THAT(notes_on(quads(true), "take/"), ElementsAre(HasSubstr("no groups or materials;")));
}

TEST(Losses, OfTimesAreNamedWhereSinglePrecisionMovesFrames) {
  const FieldSequence given = quads(false);
  const MeshSequence& frames = given.sequence();
  const auto at = [&](double start) {
    return FieldSequence(MeshSequence(frames.shared_connectivity(), frames.positions(),
                                      Eigen::Vector2d(start, start + 0.02), frames.rest()));
  };
  for (const char* target : {"take.mdd", "take.glb", "take.gltf"}) {
    EXPECT_THAT(notes_on(at(40000.1), target), Contains(HasSubstr("exact times (rounded by")));
    EXPECT_THAT(notes_on(at(0.1), target), Not(Contains(HasSubstr("exact times"))));
  }
  EXPECT_THAT(notes_on(at(40000.1), "take.npz"), Not(Contains(HasSubstr("exact times"))));
}

TEST(Losses, OfOneFrameAreItsTime) {
  const FieldSequence given = quads(false);
  const MeshSequence& frames = given.sequence();
  const auto at = [&](double time) {
    return FieldSequence(MeshSequence(frames.shared_connectivity(), frames.positions().topRows(1),
                                      Eigen::VectorXd::Constant(1, time), frames.rest()));
  };
  EXPECT_THAT(notes_on(at(0.2), "pose.ply"), Contains(HasSubstr("time (its frame is at 0.2 s)")));
  EXPECT_THAT(notes_on(at(0), "pose.ply"), Not(Contains(HasSubstr("time ("))));
  EXPECT_THAT(notes_on(at(0.2), "pose/"), Not(Contains(HasSubstr("time ("))));
}

TEST(Losses, OfACacheWithOneStepAreUnevenTimes) {
  const auto at = [](const Eigen::VectorXd& times) {
    return FieldSequence(
        MeshSequence(Connectivity::from_triangles(3, (Triangles(1, 3) << 0, 1, 2).finished()),
                     Frames::Random(3, 9), times));
  };
  EXPECT_THAT(notes_on(at(Eigen::Vector3d(0, 0.1, 0.4)), "a.pc2"),
              Contains(HasSubstr("show frames 0.1 s off")));
  EXPECT_THAT(notes_on(at(Eigen::Vector3d(0, 0.1, 0.4)), "a.mdd"),
              Not(Contains(HasSubstr("uneven"))));
  EXPECT_THAT(notes_on(at(Eigen::Vector3d(0.1, 0.2, 0.3)), "a.pc2"),
              Not(Contains(HasSubstr("uneven"))));
}

TEST(Losses, AreNoneWhereTheOnlyFrameIsTheRestPoseAndNumbersAreKept) {
  Connectivity faces = Connectivity::from_triangles(3, (Triangles(1, 3) << 0, 1, 2).finished());
  const Positions triangle = test::grid(3, 3).positions.bottomRows(3);
  const Frames frames = Eigen::Map<const Eigen::RowVectorXd>(triangle.data(), 9);
  const FieldSequence sequence(MeshSequence(std::move(faces), frames, {}, triangle));
  EXPECT_THAT(notes_on(sequence, "neutral.stl"), IsEmpty());
}

TEST(Losses, OfTextureCoordinatesAreNoneWhereOneForEachVertexDoes) {
  const HeldParts held{.polygons = true, .texture = HeldParts::Texture::vertices, .groups = true};
  EXPECT_THAT(parts_left_out(held, *quads(false).frames), IsEmpty());
  EXPECT_THAT(parts_left_out(held, *quads(true).frames),
              ElementsAre("texture coordinates of a mesh with several at a vertex"));
}

}  // namespace
}  // namespace mimetra
