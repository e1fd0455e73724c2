#include "toolkit/formats/sequence_file.h"

#include <gmock/gmock.h>

#include "tests/shapes.h"
#include "tests/temporary_folder.h"
#include "toolkit/io/array_file.h"
#include "toolkit/io/frame_files.h"
#include "toolkit/io/mesh_file.h"
#include "toolkit/io/whole_file.h"
#include "toolkit/mesh/errors.h"
#include "toolkit/model/animation.h"

namespace mimetra {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Positions pose(int frame) {
  return test::octahedron().positions.array() / 3 + 0.1 * frame;
}

void write_frame(const fs::path& path, int frame) {
  write_mesh(path, {pose(frame), test::mesh_of(test::octahedron()).connectivity},
             {.double_precision = true});
}

MeshSequence octahedra(int frames, std::optional<Positions> rest = {}) {
  Frames positions(frames, 18);
  for (int frame = 0; frame < frames; ++frame) {
    const Positions one = pose(frame);
    positions.row(frame) = Eigen::Map<const Eigen::RowVectorXd>(one.data(), 18);
  }
  return {test::mesh_of(test::octahedron()).connectivity, positions, {}, std::move(rest)};
}

/// frame_1.obj to frame_12.obj.
class TwelveFiles : public testing::Test {
 protected:
  TwelveFiles() {
    for (int frame = 1; frame <= 12; ++frame) {
      write_frame(folder_ / ("frame_" + std::to_string(frame) + ".obj"), frame);
    }
  }
  std::string text() const { return folder_.path().string(); }

  TemporaryFolder folder_;
};

TEST_F(TwelveFiles, AreReadFromTheirFolderInNaturalOrder) {
  const SequenceRead read = read_sequence(text());
  ASSERT_EQ(read.sequence.frames(), 12);
  EXPECT_EQ(read.sequence.frame(1), pose(2));
  EXPECT_EQ(read.sequence.frame(11), pose(12));
  EXPECT_FALSE(read.sequence.rest_is_known());
  EXPECT_FALSE(read.model_driven);
}

TEST_F(TwelveFiles, AreReadFromAGlobOrAPrintfPattern) {
  EXPECT_EQ(read_sequence((folder_ / "frame_*.obj").string()).sequence.frame(11), pose(12));
  EXPECT_EQ(read_sequence((folder_ / "frame_?.obj").string()).sequence.frames(), 9);
  EXPECT_EQ(read_sequence((folder_ / "frame_%d.obj").string()).sequence.frame(1), pose(2));
  EXPECT_EQ(read_sequence((folder_ / "frame_%02d.obj").string()).sequence.frame(0), pose(10));
}

TEST_F(TwelveFiles, AreOneFrameEachByName) {
  const SequenceRead read = read_sequence((folder_ / "frame_3.obj").string());
  ASSERT_EQ(read.sequence.frames(), 1);
  EXPECT_EQ(read.sequence.frame(0), pose(3));
}

TEST_F(TwelveFiles, WhatBelongsToOtherSequencesOrIsNoMeshIsNoFrame) {
  write_bytes(folder_ / "mimetra-run.json", "{}");
  write_bytes(folder_ / ".hidden.obj", "");
  EXPECT_EQ(read_sequence(text()).sequence.frames(), 12);
  for (const char* name : {"other.rest.ply", "other.topology.ply"}) write_frame(folder_ / name, 0);
  EXPECT_EQ(read_sequence(text()).sequence.frames(), 12);
  EXPECT_EQ(read_sequence((folder_ / "*").string()).sequence.frames(), 12);
  EXPECT_EQ(read_sequence((folder_ / "*.rest.ply").string()).sequence.frames(), 1);
}

TEST_F(TwelveFiles, LinksThatLeadNowhereAreNoFramesAmongNumberedOnes) {
  fs::create_symlink("loop.obj", folder_ / "loop.obj");
  fs::create_symlink("gone", folder_ / "dangling.obj");
  EXPECT_EQ(read_sequence(text()).sequence.frames(), 12);
  EXPECT_THROW(read_sequence((folder_ / "*.obj").string()), IoError);
  EXPECT_THROW(read_sequence((folder_ / "loop.obj").string()), IoError);
}

TEST_F(TwelveFiles, FrameWithOtherFacesIsNamedWithTheFirst) {
  TriMesh flipped = test::mesh_of(test::octahedron());
  std::swap(flipped.connectivity.polygons.corners[0], flipped.connectivity.polygons.corners[1]);
  write_mesh(folder_ / "frame_7.obj", flipped);
  const std::string message = message_of<MismatchError>([&] { read_sequence(text()); });
  EXPECT_THAT(message, testing::StartsWith((folder_ / "frame_7.obj").string() + ": face 1"));
  EXPECT_THAT(message, testing::EndsWith("as in " + (folder_ / "frame_1.obj").string()));
}

TEST_F(TwelveFiles, FrameWithItsFacesInAnotherOrderIsOne) {
  TriMesh other = test::mesh_of(test::octahedron());
  other.connectivity =
      Connectivity::from_triangles(6, Triangles(other.connectivity.triangles.colwise().reverse()));
  other.positions(2, 1) = 7;
  write_mesh(folder_ / "frame_7.obj", other);
  EXPECT_EQ(read_sequence(text()).sequence.frame(6)(2, 1), 7);
}

TEST_F(TwelveFiles, FrameWhoseQuadsAreTrianglesIsOne) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 ";
  std::filesystem::create_directory(folder_ / "quads");
  write_bytes(folder_ / "quads/a_1.obj", corners + "0\nf 1 2 3 4\n");
  write_bytes(folder_ / "quads/a_2.obj", corners + "5\nf 2 3 4\nf 1 2 4\n");
  const SequenceRead read = read_sequence((folder_ / "quads").string());
  EXPECT_EQ(read.sequence.frame(1)(3, 2), 5);
  EXPECT_EQ(read.sequence.connectivity().polygons.size(), 1);
}

TEST_F(TwelveFiles, AnotherFormatAmongThemIsAnErrorThatNamesBoth) {
  write_frame(folder_ / "other.ply", 0);
  const std::string message = message_of<IoError>([&] { read_sequence(text()); });
  EXPECT_THAT(message, HasSubstr("several formats, frame_1.obj"));
  EXPECT_THAT(message, HasSubstr("other.ply"));
}

TEST_F(TwelveFiles, FramesTakeAPartAndKeepItsTimes) {
  const SequenceRead read = read_sequence(text(), {.frames = "2:9:3", .fps = 10});
  ASSERT_EQ(read.sequence.frames(), 3);
  EXPECT_EQ(read.sequence.frame(1), pose(6));
  EXPECT_EQ(read.sequence.times(), Eigen::Vector3d(0.2, 0.5, 0.8));
  EXPECT_EQ(read.files.size(), 3);
  EXPECT_EQ(read_sequence(text(), {.frames = "10:"}).sequence.frames(), 2);
  EXPECT_EQ(read_sequence(text(), {.frames = ":5"}).sequence.frames(), 5);
  EXPECT_EQ(read_sequence(text(), {.frames = "::5"}).sequence.frames(), 3);
}

TEST_F(TwelveFiles, OnlyTheFramesAskedForAreRead) {
  write_bytes(folder_ / "frame_12.obj", "broken");
  EXPECT_EQ(read_sequence(text(), {.frames = "0:11"}).sequence.frames(), 11);
  EXPECT_THROW(read_sequence(text()), IoError);
}

TEST_F(TwelveFiles, WhatIsNoRangeIsQuoted) {
  for (const std::string range :
       {"", "3", "a:b", "5:5", "6:2", "-1:3", "0:4:0", "0:4:1:1", "1.5:3"}) {
    EXPECT_THAT(
        message_of<std::invalid_argument>([&] { read_sequence(text(), {.frames = range}); }),
        HasSubstr("frames '" + range + "': expected A:B:STEP"));
  }
}

TEST_F(TwelveFiles, RangeBeyondTheEndNamesTheCount) {
  EXPECT_THAT(message_of<MismatchError>([&] { read_sequence(text(), {.frames = "0:13"}); }),
              HasSubstr("frames '0:13': the sequence has 12 frames"));
  EXPECT_THROW(read_sequence(text(), {.frames = "12:"}), MismatchError);
}

TEST_F(TwelveFiles, WeightsCannotDriveThem) {
  EXPECT_THAT(message_of<MismatchError>([&] { read_sequence(text(), {.weights = "w.csv"}); }),
              HasSubstr("is no model that the weights of w.csv could drive"));
}

TEST_F(TwelveFiles, ReadingStopsWhenProgressSaysSo) {
  int calls = 0;
  EXPECT_THROW(read_sequence(text(), {}, Context().with_threads(1).with_progress([&](double) {
                 return ++calls < 3;
               })),
               Cancelled);
  EXPECT_EQ(calls, 3);
}

TEST_F(TwelveFiles, TimesAreThirtyPerSecondWithoutInformation) {
  EXPECT_EQ(read_sequence(text()).sequence.times()[3], 3 / 30.0);
  EXPECT_EQ(message_of<std::invalid_argument>([&] { read_sequence(text(), {.fps = 0}); }),
            "fps is 0; it must be from 0.001 to 1e+06");
}

TEST(ReadSequence, SaysWhatIsMissing) {
  const TemporaryFolder folder;
  EXPECT_EQ(message_of<IoError>([&] { read_sequence((folder / "none").string()); }),
            (folder / "none").string() + ": no such file or folder");
  EXPECT_THAT(message_of<IoError>([&] { read_sequence(folder.path().string()); }),
              HasSubstr("holds no PLY, OBJ, OFF, STL or OM file"));
  EXPECT_THAT(message_of<IoError>([&] { read_sequence((folder / "*.obj").string()); }),
              HasSubstr("matches no PLY, OBJ, OFF, STL or OM file"));
  EXPECT_THAT(message_of<IoError>([&] { read_sequence((folder / "f_%04d.obj").string()); }),
              HasSubstr("matches no PLY, OBJ, OFF, STL or OM file"));
  const std::string too_long(5000, 'a');
  EXPECT_THROW(read_sequence((folder / too_long).string()), IoError);
  EXPECT_THROW(read_sequence((folder / too_long).string() + "@a=1"), IoError);
  EXPECT_THROW(read_sequence((folder / too_long).string() + "/f_%04d.obj"), IoError);
  write_bytes(folder / "a.txt", "");
  EXPECT_THAT(message_of<IoError>([&] { read_sequence((folder / "a.txt").string()); }),
              HasSubstr("a.txt: is no sequence; expected a folder"));
}

TEST(WriteSequence, ArrayComesBackBitByBitWithItsRestPose) {
  const TemporaryFolder folder;
  const MeshSequence sequence = octahedra(5, pose(-3));
  const auto files = write_sequence(sequence, folder / "s.npy");
  EXPECT_THAT(files,
              ElementsAre(folder / "s.npy", folder / "s.topology.ply", folder / "s.rest.ply"));
  const SequenceRead read = read_sequence((folder / "s.npy").string());
  EXPECT_EQ(read.sequence.positions(), sequence.positions());
  EXPECT_TRUE(read.sequence.rest_is_known());
  EXPECT_EQ(read.sequence.rest(), pose(-3));
  EXPECT_TRUE(same_faces(read.sequence.connectivity(), sequence.connectivity()));
}

TEST(WriteSequence, ArrayMayHaveItsExtensionInCapitals) {
  const TemporaryFolder folder;
  write_sequence(octahedra(2, pose(-3)), folder / "s.NPY");
  EXPECT_THAT(folder.names(), ElementsAre("s.NPY", "s.rest.ply", "s.topology.ply"));
  EXPECT_EQ(read_sequence((folder / "s.NPY").string()).sequence.rest(), pose(-3));
}

TEST(WriteSequence, FolderComesBackBitByBitInDoublePrecisionWithTheRestPoseBesideIt) {
  for (const std::string format : {"ply", "obj", "off"}) {
    const TemporaryFolder folder;
    const MeshSequence sequence = octahedra(3, pose(-3));
    write_sequence(sequence, folder / "s", {.frame_format = format, .double_precision = true});
    EXPECT_THAT(folder.names(), ElementsAre("s", "s.rest.ply"));
    const SequenceRead read = read_sequence((folder / "s").string() + "/");
    EXPECT_EQ(read.sequence.positions(), sequence.positions());
    EXPECT_EQ(read.sequence.rest(), pose(-3));
  }
}

TEST(WriteSequence, FolderHoldsNumberedFramesAndNothingElse) {
  const TemporaryFolder folder;
  write_sequence(octahedra(2), folder / "s", {.extra = {{"mimetra-run.json", "{}"}}});
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "s")) {
    names.push_back(entry.path().filename().string());
  }
  EXPECT_THAT(
      names, testing::UnorderedElementsAre("frame_0000.ply", "frame_0001.ply", "mimetra-run.json"));
  EXPECT_THAT(folder.names(), ElementsAre("s"));
}

TEST(WriteSequence, PosesFarFromTheOriginAreInDoublePrecision) {
  const TemporaryFolder folder;
  MeshSequence sequence = octahedra(2);
  Frames frames = sequence.positions();
  frames.row(1).array() += 1e6 + 1 / 3.0;
  sequence = sequence.with_frames(frames);
  write_sequence(sequence, folder / "s");
  const MeshSequence back = read_sequence((folder / "s").string()).sequence;
  EXPECT_EQ(back.frame(0), sequence.frame(0).cast<float>().cast<double>());
  EXPECT_EQ(back.frame(1), sequence.frame(1));
}

TEST(FrameName, HasFourDigitsAndMoreWhereTheLastFrameNeedsThem) {
  EXPECT_EQ(frame_name(7, 10000, ".ply"), "frame_0007.ply");
  EXPECT_EQ(frame_name(0, 10001, ".ply"), "frame_00000.ply");
  EXPECT_EQ(frame_name(10000, 10001, ".ply"), "frame_10000.ply");
}

TEST(WriteSequence, StlFolderComesBackWithTheVerticesOfItsFirstFrame) {
  const TemporaryFolder folder;
  write_sequence(octahedra(3, pose(1)), folder / "s", {.frame_format = "stl"});
  EXPECT_EQ(read_sequence((folder / "s").string(), {.frames = "1:3"}).sequence.vertices(), 6);
}

TEST(WriteSequence, OverwritingRemovesAStaleRestPose) {
  for (const std::string name : {"s", "s.npy"}) {
    const TemporaryFolder folder;
    write_sequence(octahedra(2, pose(4)), folder / name);
    write_sequence(octahedra(2), folder / name, {.overwrite = true});
    EXPECT_FALSE(fs::exists(folder / "s.rest.ply"));
    EXPECT_FALSE(read_sequence((folder / name).string()).sequence.rest_is_known());
  }
}

TEST(WriteSequence, RefusesAnExistingTargetAndAForeignRestPose) {
  for (const bool overwrite : {false, true}) {
    const TemporaryFolder folder;
    write_bytes(folder / "s.rest.ply", "somebody else's");
    for (const MeshSequence& take : {octahedra(2), octahedra(2, pose(4))}) {
      EXPECT_THAT(message_of<OutputError>(
                      [&] { write_sequence(take, folder / "s.npy", {.overwrite = overwrite}); }),
                  HasSubstr("s.rest.ply: stands without 's.npy'"));
      EXPECT_THAT(folder.names(), ElementsAre("s.rest.ply"));
    }
    fs::create_directory(folder / "t");
    EXPECT_THROW(write_sequence(octahedra(2), folder / "t"), OutputError);
  }
}

/// They would have its rest pose and times.
TEST(WriteSequence, KeepsWhatIsAPartOfAnotherOfItsName) {
  for (const auto& names :
       {std::pair("s.npy", "s.pc2"), std::pair("s", "s.npy"), std::pair("s.npy", "s")}) {
    const std::string first = names.first, second = names.second;
    const TemporaryFolder folder;
    const MeshSequence take = octahedra(3, pose(1));
    write_sequence(take, folder / first);
    const std::string rest = read_file(folder / "s.rest.ply");
    write_sequence(take, folder / second);  // the same parts
    for (const MeshSequence& other : {octahedra(2), octahedra(2, pose(4))}) {
      EXPECT_THAT(message_of<OutputError>(
                      [&] { write_sequence(other, folder / second, {.overwrite = true}); }),
                  HasSubstr("belongs to '" + first + "', which stays"));
    }
    EXPECT_EQ(read_file(folder / "s.rest.ply"), rest);
    for (const std::string& name : {first, second}) {
      EXPECT_EQ(read_sequence((folder / name).string()).sequence.frames(), 3);
    }
  }
}

TEST(WriteSequence, LeavesNothingWhenCancelled) {
  const TemporaryFolder folder;
  for (const char* name : {"a/b/s", "a/b/s.npy", "a/b/s.npz"}) {
    EXPECT_THROW(write_sequence(octahedra(5, pose(1)), folder / name, {},
                                Context().with_progress([](double share) { return share < 0.5; })),
                 Cancelled)
        << name;
    EXPECT_THAT(folder.names(), IsEmpty()) << name;
  }
}

TEST(WriteSequence, OneFrameGoesIntoOneFileWithItsExtrasBeside) {
  const TemporaryFolder folder;
  write_sequence(octahedra(1), folder / "a.obj",
                 {.double_precision = true, .extra = {{"a.run.json", "{}"}}});
  EXPECT_THAT(folder.names(), ElementsAre("a.obj", "a.run.json"));
  EXPECT_EQ(read_mesh(folder / "a.obj").positions, pose(0));
}

TEST(WriteSequence, SeveralFramesDoNotFitIntoOneMeshFile) {
  const TemporaryFolder folder;
  EXPECT_THAT(message_of<MismatchError>([&] { write_sequence(octahedra(2), folder / "a.obj"); }),
              HasSubstr("a.obj: one mesh file cannot hold 2 frames"));
}

TEST(ReadArraySequence, WithoutFacesSaysHowToNameThem) {
  const TemporaryFolder folder;
  write_npy_frames(folder / "s.npy", octahedra(2).positions());
  const std::string message =
      message_of<IoError>([&] { read_sequence((folder / "s.npy").string()); });
  EXPECT_THAT(message, HasSubstr("s.topology.ply"));
  EXPECT_THAT(message, HasSubstr("option 'topology'"));
}

TEST(ReadArraySequence, TakesFacesFromTheTopologyAndAPartOfTheFrames) {
  const TemporaryFolder folder;
  write_npy_frames(folder / "s.npy", octahedra(5).positions());
  write_frame(folder / "faces.off", 0);
  const SequenceRead read = read_sequence((folder / "s.npy").string(),
                                          {.topology = folder / "faces.off", .frames = "1:4:2"});
  ASSERT_EQ(read.sequence.frames(), 2);
  EXPECT_EQ(read.sequence.frame(1), pose(3));
  EXPECT_EQ(read.sequence.triangles().rows(), 8);
}

TEST(ReadArraySequence, OtherVertexCountOfTheTopologyIsNamed) {
  const TemporaryFolder folder;
  write_npy_frames(folder / "s.npy", octahedra(2).positions());
  write_mesh(folder / "faces.off", test::mesh_of(test::sphere(1)));
  EXPECT_EQ(message_of<MismatchError>([&] {
              read_sequence((folder / "s.npy").string(), {.topology = folder / "faces.off"});
            }),
            (folder / "s.npy").string() + ": 6 vertices, expected 18 as in " +
                (folder / "faces.off").string());
}

/// A model of a triangle with two expressions along x and y.
class SmallModel : public testing::Test {
 protected:
  SmallModel() {
    fs::create_directories(folder_ / "m/expressions");
    write_bytes(folder_ / "m/neutral.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write_bytes(folder_ / "m/expressions/jawOpen.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
    write_bytes(folder_ / "m/expressions/pout.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  }
  std::string text() const { return (folder_ / "m").string(); }

  TemporaryFolder folder_;
};

TEST_F(SmallModel, WithoutWeightsIsItsNeutral) {
  const SequenceRead read = read_sequence(text());
  EXPECT_TRUE(read.model_driven);
  EXPECT_TRUE(read.sequence.rest_is_known());
  ASSERT_EQ(read.sequence.frames(), 1);
  EXPECT_EQ(read.sequence.frame(0), read_mesh(folder_ / "m/neutral.obj").positions);
}

TEST_F(SmallModel, KeepsItsExpressionsWhereItIsWrittenAlsoInOtherUnits) {
  write_bytes(folder_ / "w.csv", "time,jawOpen,pout\n0,0,0\n0.5,0.25,0.5\n");
  for (const bool driven : {false, true}) {
    ReadOptions source;
    if (driven) source.weights = folder_ / "w.csv";
    const auto given = open_sequence(text(), source).frames;
    const UnitChange change{.scale = 0.5, .up = UpTurn::y_to_z};
    write_sequence(*in_units(given, change), folder_ / "a.glb", {.overwrite = true});
    const auto found = open_sequence((folder_ / "a.glb").string()).frames;
    EXPECT_THAT(dynamic_cast<const Animation&>(*found).model().expressions().names,
                ElementsAre("jawOpen", "pout"));
    const auto frames = with_units(given, change);
    ASSERT_EQ(found->frames(), given->frames());
    EXPECT_EQ(found->read(0, found->frames()), frames->read(0, frames->frames()));
    EXPECT_EQ(found->rest(), frames->rest());
  }
}

TEST_F(SmallModel, IsDrivenByWeightsWithTheirTimes) {
  write_bytes(folder_ / "w.csv", "time,jawOpen,pout\n0,0,0\n0.5,0.25,0\n1.5,0,1\n");
  const SequenceRead read = read_sequence(text(), {.weights = folder_ / "w.csv", .frames = "1:"});
  ASSERT_EQ(read.sequence.frames(), 2);
  EXPECT_EQ(read.sequence.frame(0)(1, 0), 1.25);
  EXPECT_EQ(read.sequence.frame(1)(2, 1), 2);
  EXPECT_EQ(read.sequence.times(), Eigen::Vector2d(0.5, 1.5));
  EXPECT_TRUE(read.model_driven);
  EXPECT_THAT(read.notes, IsEmpty());
}

TEST_F(SmallModel, TimesComeFromFramesPerSecondWhereTheTrackHasNone) {
  write_bytes(folder_ / "w.csv", "jawOpen,pout\n0,0\n0.25,0\n");
  const SequenceRead read = read_sequence(text(), {.weights = folder_ / "w.csv", .fps = 4});
  EXPECT_EQ(read.sequence.times(), Eigen::Vector2d(0, 0.25));
}

TEST_F(SmallModel, NotesNameWhatWasNotMatched) {
  std::string header = "jawOpen", row = "1";
  for (int column = 1; column <= 10; ++column) {
    header += ",other" + std::to_string(column);
    row += ",0";
  }
  write_bytes(folder_ / "w.csv", header + "\n" + row + "\n");
  const SequenceRead read = read_sequence(text(), {.weights = folder_ / "w.csv"});
  ASSERT_EQ(read.notes.size(), 2);
  EXPECT_THAT(read.notes[0], HasSubstr("columns that drive no expression: other1, other2"));
  EXPECT_THAT(read.notes[0], HasSubstr("other8 and 2 more"));
  EXPECT_THAT(read.notes[1], HasSubstr("expressions that no column drives: pout"));
}

TEST_F(SmallModel, PlainFolderCannotHaveAnIdentity) {
  write_frame(folder_ / "a.obj", 0);
  EXPECT_THROW(read_sequence((folder_ / "a.obj").string() + "@id=1"), IoError);
}

}  // namespace
}  // namespace mimetra
